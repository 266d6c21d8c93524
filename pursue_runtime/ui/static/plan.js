"use strict";
// The map: places, ways, and where everybody is. Labels go where they cover no other label (see arranged).

const ROW = 24; // pixels from one label to the next above it
const AROUND = 1.5; // metres of floor plan that are shown around the places
const CROWD = 12; // places from which on a name that has no room right beside its place is left out
const SMALL = 40; // pixels by pixels for each letter of a name: on a map with less room letters are smaller
let POI = 14; // half the height of a point of interest
const map = { points: new Map(), marks: new Map(), places: [], lengths: [], moving: false, last: 0, width: 0, height: 0 };
let positions = new Map(); // robot → where it really is: x, y in metres, yaw in radians
let paths = new Map(); // robot → what its navigation has planned: points in metres, and of which of its movements that is
const calm = window.matchMedia("(prefers-reduced-motion: reduce)");

function setMap() {
  const names = Object.keys(scene.places), width = $("map").clientWidth, high = $("map").clientHeight;
  map.points.clear();
  map.marks.clear();
  $("where").hidden = names.length === 0;
  if (!names.length || !width || !high) return;
  const letters = names.reduce((sum, name) => sum + 4 + short(shown(name)).length, 0), crowded = width * high < SMALL * SMALL * letters;
  POI = crowded ? 10 : 14;
  const longest = Math.max(...[...names, ...scene.agents.map((agent) => agent.name)].map((name) => short(shown(name)).length));
  const above = 2 * POI + ROW, below = POI + ROW, side = Math.min(width / 4, 16 + 4.2 * longest);
  const around = scene.floor ? AROUND : 0;
  const seen = [...Object.values(scene.places), ...known().flatMap(([, , line]) => line)];
  const xs = seen.flatMap(([x]) => [x - around, x + around]), ys = seen.flatMap(([, y]) => [y - around, y + around]);
  const across = Math.max(...xs) - Math.min(...xs), up = Math.max(...ys) - Math.min(...ys);
  const room = Math.max(1, high - above - below);
  const scale = Math.min((width - 2 * side) / (across || 1e-6), room / (up || 1e-6), across || up ? Infinity : 1);
  const left = (width - scale * across) / 2, top = above + (room - scale * up) / 2;
  const picture = document.createElementNS(SVG, "svg");
  picture.setAttribute("viewBox", `0 0 ${width} ${high}`);
  picture.setAttribute("class", crowded ? "small" : "");
  picture.setAttribute("role", "img");
  picture.setAttribute("aria-label", `Map of ${scene.scenario}; the list "Who does what" says the same in words`);
  $("map").replaceChildren(picture);
  const at = (x, y) => ({ x: left + scale * (x - Math.min(...xs)), y: top + scale * (Math.max(...ys) - y) });
  Object.assign(map, { width, height: high, at });
  for (const name of names) map.points.set(name, at(...scene.places[name]));
  drawFloor(picture, scale);
  drawWays(picture);
  const under = draw("g", picture); // lines to labels, and points: no name is under them
  drawPlaces(picture, names, under);
  drawLengths(picture);
  for (const { name, kind } of scene.agents) {
    const path = draw("polyline", under, { class: "path" }), lead = draw("line", under, { class: `lead ${kind}` });
    const dot = draw("path", under, { class: `dot ${kind}` });
    const group = labelled(picture, `mark ${kind}`, shown(name), 22, 4);
    group.dataset.agent = name;
    map.marks.set(name, { group, path, lead, dot, kind, ...size(group), x: null, y: null, choice: 0 });
  }
  showReal();
  animate(performance.now());
}

function drawFloor(picture, scale) { // pale, so that what is drawn on it can be read
  if (!scene.floor) return;
  const { width, height, resolution, x, y, yaw } = scene.floor, corner = map.at(x, y), pixel = scale * resolution;
  const turn = `translate(${corner.x} ${corner.y}) rotate(${-yaw * 180 / Math.PI}) translate(0 ${-height * pixel})`;
  const inside = { href: "floor.png", width: width * pixel, height: height * pixel, preserveAspectRatio: "none" };
  draw("image", draw("g", picture, { class: "floor", transform: turn }), inside);
}

const known = () => (scene.floor ? scene.floor.paths : []); // the paths of ways on the floor plan

function lineOf(a, b) { // the way from one place to another, along its path where that is known
  const path = known().find(([one, two]) => (one === a && two === b) || (one === b && two === a));
  const inner = path ? path[2].slice(1, -1).map(([x, y]) => map.at(x, y)) : [];
  return [map.points.get(a), ...(path && path[0] === b ? inner.reverse() : inner), map.points.get(b)];
}

function along(line, part) { // the point after so much of a line
  const sizes = line.slice(1).map((end, k) => Math.hypot(end.x - line[k].x, end.y - line[k].y));
  let left = part * sizes.reduce((sum, one) => sum + one, 0);
  const k = sizes.findIndex((one) => one >= left || (left -= one, false));
  if (k < 0 || !sizes[k]) return line[line.length - 1];
  const [a, b] = [line[k], line[k + 1]];
  return { x: a.x + (left / sizes[k]) * (b.x - a.x), y: a.y + (left / sizes[k]) * (b.y - a.y) };
}

const inText = (points) => points.map(({ x, y }) => `${x.toFixed(1)},${y.toFixed(1)}`).join(" ");

function drawWays(picture) {
  for (const [a, b] of scene.ways) draw("polyline", picture, { class: "way", points: inText(lineOf(a, b)) });
  for (const [a, b] of scene.one_ways) draw("polygon", picture, { class: "arrow", points: arrow(...lineOf(a, b).slice(-2)) });
}

function drawPlaces(picture, names, under) { // where two would cover each other, one is beside its point, or is a point
  map.places = [];
  const spots = names.map((name) => ({ ...map.points.get(name), half: 5, tall: 5 })), rings = names.length > CROWD ? 1 : 3;
  names.forEach((name, number) => {
    const point = map.points.get(name), lead = draw("line", under, { class: "lead" });
    const spot = draw("circle", under, { class: "spot", cx: point.x, cy: point.y, r: 5 });
    draw("title", spot).textContent = shown(name);
    const group = labelled(picture, "poi", shown(name), 2 * POI, POI), { half, tall } = size(group);
    const offsets = [{ x: 0, y: 0 }, ...around(half, tall, 2 * POI, rings)];
    const others = [...map.places, ...spots.filter((_, other) => other !== number)];
    const { box } = arranged(point, half, tall, offsets, others, 0);
    if (box) {
      map.places.push(box);
      put(group, box);
      join(lead, point, box);
    } else {
      group.remove();
      lead.remove();
    }
  });
  map.places.push(...spots);
}

function drawLengths(picture) { // in the middle of the way, or where there is room; nowhere rather than over a name
  map.lengths = [];
  for (const [a, b, length] of scene.ways) {
    const line = lineOf(a, b);
    const first = scene.one_ways.some(([one, two]) => one === a && two === b) ? 0.42 : 0.5;
    const text = draw("text", picture, { class: "length" });
    text.textContent = length;
    const half = text.getComputedTextLength() / 2 + 2;
    const boxes = [first, 0.6, 0.4, 0.68, 0.32].map((part) => ({ ...along(line, part), half, tall: 9 }));
    const box = boxes.find((one) => !map.places.some((other) => covers(one, other)) && !map.lengths.some((other) => covers(one, other.box)));
    if (!box) {
      text.remove();
      continue;
    }
    text.setAttribute("x", box.x);
    text.setAttribute("y", box.y);
    map.lengths.push({ box, text });
  }
}

function arrow(from, to) { // its head, in front of the place that it leads to
  const length = Math.hypot(to.x - from.x, to.y - from.y) || 1;
  const x = (to.x - from.x) / length, y = (to.y - from.y) / length, before = 2 * POI, head = 12;
  const tip = [to.x - before * x, to.y - before * y], back = [tip[0] - head * x, tip[1] - head * y];
  const points = [tip, [back[0] - head / 2 * y, back[1] + head / 2 * x], [back[0] + head / 2 * y, back[1] - head / 2 * x]];
  return points.map((point) => point.map((value) => value.toFixed(1)).join(",")).join(" ");
}

function labelled(parent, kind, name, height, round) { // a name in a box, around 0, 0
  const group = draw("g", parent, { class: kind }), box = draw("rect", group), text = draw("text", group);
  draw("title", group).textContent = name;
  text.textContent = short(name);
  const width = Math.max(height, text.getComputedTextLength() + 14);
  for (const [key, value] of Object.entries({ x: -width / 2, y: -height / 2, width, height, rx: round })) box.setAttribute(key, value);
  return group;
}

const size = (group) => ({ half: group.querySelector("rect").width.baseVal.value / 2, tall: group.querySelector("rect").height.baseVal.value / 2 });
const put = (group, { x, y }) => group.setAttribute("transform", `translate(${x.toFixed(1)} ${y.toFixed(1)})`);

function join(lead, point, box) { // a line to a label that is not at its point
  const dx = Math.max(0, Math.abs(point.x - box.x) - box.half), dy = Math.max(0, Math.abs(point.y - box.y) - box.tall);
  lead.style.display = dx + dy > POI ? "" : "none";
  for (const [key, value] of Object.entries({ x1: point.x, y1: point.y, x2: box.x, y2: box.y })) lead.setAttribute(key, value.toFixed(1));
}

// Where robots really are ----------------------------------------------------------------------------------------------

function setPositions(fresh, planned) {
  positions = new Map(Object.entries(fresh)); // names may be those of any property
  const before = paths;
  paths = new Map(Object.entries(planned).map(([name, points]) => {
    const last = before.get(name), same = last && JSON.stringify(last.points) === JSON.stringify(points);
    return [name, same ? last : { points, of: view && view.agents.find((agent) => agent.name === name) }];
  }));
  showReal();
  if (!map.moving) animate(performance.now());
}

function showReal() { // of all others only their last place is known
  const real = positions.size > 0;
  $("real").hidden = !real;
  for (const [name, mark] of map.marks) {
    const text = mark.group.querySelector("text"), words = short(shown(name)) + (real && !positions.has(name) ? " ?" : "");
    if (text.textContent === words) continue;
    text.textContent = words;
    const box = mark.group.querySelector("rect"), width = Math.max(22, text.getComputedTextLength() + 14);
    box.setAttribute("x", -width / 2);
    box.setAttribute("width", width);
    mark.half = width / 2;
  }
}

function pointOf(agent, now) { // on the picture: where it is known to be, else where the model has it
  const real = positions.get(agent.name), from = map.points.get(agent.place), to = map.points.get(agent.to);
  if (real) {
    const { x, y } = map.at(real[0], real[1]);
    return { x: Math.min(map.width, Math.max(0, x)), y: Math.min(map.height, Math.max(0, y)), yaw: real[2], away: 2 * POI };
  }
  if (!from) return null;
  if (!to) return { ...from, away: 2 * POI };
  return { ...along(lineOf(agent.place, agent.to), share(agent, now)), away: POI + 4 };
}

function remaining(agent, point) { // of the path planned for this movement, else of its way, from where it is
  const path = paths.get(agent.name), way = lineOf(agent.place, agent.to);
  const planned = path && path.of && path.of.to === agent.to && Math.abs(path.of.since - agent.since) <= 0.5;
  if (!planned && way.length === 2) return [point, way[1]];
  const points = planned ? path.points.map(([x, y]) => map.at(x, y)) : Array.from({ length: 101 }, (_, k) => along(way, k / 100));
  const away = points.map(({ x, y }) => Math.hypot(x - point.x, y - point.y));
  return [point, ...points.slice(away.indexOf(Math.min(...away)) + 1)];
}

function showDot(mark, agent, point, to, named) { // the point itself, with its heading, and what is left of its way
  const round = "M4 0A4 4 0 1 1 -4 0A4 4 0 1 1 4 0Z", arrowed = "M10 0L-6 7L-3 0L-6 -7Z", headed = point.yaw !== undefined;
  mark.dot.style.display = to || headed || !named ? "" : "none";
  mark.dot.setAttribute("d", headed ? arrowed : round);
  const turn = headed ? ` rotate(${(-point.yaw * 180 / Math.PI).toFixed(1)})` : "";
  mark.dot.setAttribute("transform", `translate(${point.x.toFixed(1)} ${point.y.toFixed(1)})${turn}`);
  const ahead = to && headed && mark.kind !== "agent";
  mark.path.style.display = ahead ? "" : "none";
  if (!ahead) return;
  mark.path.setAttribute("points", inText(remaining(agent, point)));
}

// Labels -------------------------------------------------------------------------------------------------------------

const covers = (a, b) => Math.abs(a.x - b.x) < a.half + b.half + 1 && Math.abs(a.y - b.y) < a.tall + b.tall + 1;

function around(half, tall, away, rings = 5) { // where a label may be beside its point: above, below, at the sides, further away
  const found = [];
  for (let ring = 0; ring < rings; ring += 1) {
    const up = away + tall - POI + ROW * ring, side = away - POI + half + 4 + ROW * ring;
    found.push({ x: 0, y: -up }, { x: 0, y: up }, { x: side, y: 0 }, { x: -side, y: 0 });
    found.push({ x: side, y: -up }, { x: -side, y: -up }, { x: side, y: up }, { x: -side, y: up });
  }
  return found;
}

function arranged(point, half, tall, offsets, taken, last) { // the first place that covers nothing; the last one before others
  const boxes = offsets.map(({ x, y }) => ({
    x: Math.min(map.width - half - 2, Math.max(half + 2, point.x + x)),
    y: Math.min(map.height - tall - 2, Math.max(tall + 2, point.y + y)), half, tall,
  }));
  const free = (box) => !taken.some((other) => covers(box, other));
  const choice = free(boxes[last]) ? last : boxes.findIndex(free);
  return choice < 0 ? { box: null, choice: last } : { box: boxes[choice], choice };
}

// What moves ---------------------------------------------------------------------------------------------------------

function share(agent, now) { // of what it does: nine tenths when it may end, all when it must
  if (agent.since === null) return 0;
  const { since, low, high } = agent;
  const part = now < low ? 0.9 * (now - since) / (low - since) : 0.9 + 0.1 * (high > low ? (now - low) / (high - low) : 1);
  return Math.min(1, Math.max(0, part));
}

function animate(moment) {
  map.moving = false;
  if (!view || !map.marks.size) return;
  const now = present(), pace = Math.min(1, (moment - map.last) / 150);
  const points = new Map(view.agents.map((agent) => [agent.name, pointOf(agent, now)]));
  const dots = view.agents.filter(({ name, to }) => points.get(name) && (to || points.get(name).yaw !== undefined)).map(({ name }) => points.get(name));
  const taken = [...map.places, ...dots.map(({ x, y }) => ({ x, y, half: 9, tall: 9 }))];
  map.last = moment;
  let unsettled = false;
  for (const agent of view.agents) {
    const mark = map.marks.get(agent.name), to = map.points.get(agent.to);
    if (!mark) continue;
    const point = points.get(agent.name);
    for (const part of [mark.group, mark.lead, mark.dot, mark.path]) part.style.display = point ? "" : "none";
    mark.group.classList.toggle("lost", agent.lost);
    if (!point) continue;
    const target = settle(mark, point, taken);
    showDot(mark, agent, point, to, target !== null);
    if (target === null) { // there is no room for its name; the list has it
      mark.group.style.display = mark.lead.style.display = "none";
      mark.x = null;
      continue;
    }
    const fast = mark.x === null || calm.matches;
    mark.x = fast ? target.x : mark.x + pace * (target.x - mark.x);
    mark.y = fast ? target.y : mark.y + pace * (target.y - mark.y);
    put(mark.group, mark);
    join(mark.lead, point, mark);
    const glides = to && point.yaw === undefined && share(agent, now) < 1 && view.live;
    unsettled = unsettled || Math.abs(mark.x - target.x) + Math.abs(mark.y - target.y) > 0.5 || glides;
  }
  for (const { box, text } of map.lengths) text.style.visibility = taken.some((other) => covers(box, other)) ? "hidden" : "";
  if (unsettled && !map.moving) {
    map.moving = true;
    requestAnimationFrame(animate);
  }
}

function settle(mark, point, taken) { // where a label comes to rest, null where there is no room; what it takes is free no more
  const { box, choice } = arranged(point, mark.half, mark.tall, around(mark.half, mark.tall, point.away), taken, mark.choice);
  mark.choice = choice;
  if (box) taken.push(box);
  return box;
}
