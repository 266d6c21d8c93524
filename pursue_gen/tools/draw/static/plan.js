// The picture: the floor plan or a grid, ways, places with who starts and what happens there.
import { camera, corners, fit, size, toMap, toScreen } from "./camera.js";
import { byId, shown, svg, whom } from "./elements.js";
import { Taken, width } from "./labels.js";
import { isSelected, state, wayKey } from "./state.js";

const ROW = 17;
const plan = byId("plan");
export const pending = { from: null, to: null }; // a way that is being drawn: from a place to a point of the window
let fitted = false;

export function placeNamed(name) {
  return state.view.places.find((one) => one.name === name) || null;
}

// What can be moved: a place, or a robot's own spot at one.
export function movable({ kind, key }) {
  if (kind === "place") return placeNamed(key);
  if (kind !== "spot") return null;
  const [name, robot] = key.split(" ");
  const place = placeNamed(name);
  return (place && place.spots.find((one) => one.robot === robot)) || null;
}

export function fitAll() {
  const points = state.view.places.map((one) => ({ x: one.x, y: one.y }));
  fit([...points, ...corners(state.opened.floor)]);
  fitted = points.length > 0 || state.opened.floor !== null;
}

export function draw() {
  if (!fitted) fitAll();
  const focused = document.activeElement;
  const key = plan.contains(focused) && focused !== plan ? focused.dataset.key : null;
  const at = new Map(state.view.places.map((one) => [one.name, toScreen(one.x, one.y)]));
  const ways = state.view.ways.filter((way) => at.has(way.a) && at.has(way.b));
  const lines = new Map(ways.map((way) => [way, lineOf(way, at)]));
  const taken = new Taken(ways.flatMap((way) => parts(lines.get(way))), size());
  for (const point of at.values()) taken.add({ x: point.x - 13, y: point.y - 13, w: 26, h: 26 });
  for (const spot of state.view.places.flatMap((one) => one.spots)) {
    const point = toScreen(spot.x, spot.y);
    taken.add({ x: point.x - 7, y: point.y - 7, w: 14, h: 14 });
  }
  const names = state.view.places.map((place) => namesOf(place, at.get(place.name), taken));
  const lengths = ways.map((way) => lengthOf(way, longest(lines.get(way)), taken));
  plan.replaceChildren(
    ...ground(),
    ...ways.map((way) => drawnWay(way, lines.get(way))),
    ...rubber(at),
    ...state.view.places.map((place) => drawnPlace(place, at.get(place.name))),
    ...state.view.places.flatMap((place) => place.spots.map((spot) => drawnSpot(place, spot))),
    ...lengths.filter((one) => one !== null),
    ...names,
    ...travellers(ways, lines),
  );
  const again = key && plan.querySelector(`[data-key="${CSS.escape(key)}"]`);
  if (again) again.focus({ preventScroll: true });
}

// The ground -------------------------------------------------------------------------------------------------------

function ground() {
  const floor = state.opened.floor;
  return floor ? [drawnFloor(floor)] : grid();
}

function drawnFloor(floor) {
  const corner = toScreen(floor.x, floor.y);
  const turn = `rotate(${(-floor.yaw * 180) / Math.PI})`;
  const height = floor.height * camera.scale;
  const image = { href: "floor.png", x: 0, y: -height, width: floor.width * camera.scale, height };
  const transform = `translate(${corner.x} ${corner.y}) ${turn}`;
  return svg("g", { transform }, svg("image", { ...image, preserveAspectRatio: "none" }));
}

function grid() {
  const { width: across, height, left, top } = size();
  const step = [0.5, 1, 2, 5, 10, 20, 50, 100, 200, 500].find((one) => one * camera.scale >= 40) || 1000;
  const [low, high] = [toMap(left, top + height), toMap(left + across, top)];
  const lines = [];
  for (let x = Math.ceil(low.x / step) * step; x <= high.x; x += step) {
    const at = toScreen(x, 0).x;
    lines.push(svg("line", { class: Math.abs(x) < step / 2 ? "axis" : "grid", x1: at, x2: at, y1: 0, y2: height }));
  }
  for (let y = Math.ceil(low.y / step) * step; y <= high.y; y += step) {
    const at = toScreen(0, y).y;
    lines.push(svg("line", { class: Math.abs(y) < step / 2 ? "axis" : "grid", x1: 0, x2: across, y1: at, y2: at }));
  }
  const words = svg("text", { class: "small", x: 8, y: height - 10 }, `${step} m from line to line`);
  return [...lines, words];
}

// Ways -------------------------------------------------------------------------------------------------------------

// How far beside the line between its places a way is, seen from its first one: ways in one direction, and ways between
// the same places for other agents, are beside each other.
function aside(way) {
  const turned = (one) => one.a === way.b && one.b === way.a;
  const same = state.view.ways.filter((one) => one.one_way === way.one_way && ((one.a === way.a && one.b === way.b) || (!way.one_way && turned(one))));
  const place = same.indexOf(way);
  if (way.one_way) return 5 + 12 * place;
  return 12 * (place - (same.length - 1) / 2) * (way.a < way.b ? 1 : -1);
}

// Where a way begins and ends.
function ends(way, at) {
  const [a, b] = [at.get(way.a), at.get(way.b)];
  const apart = Math.hypot(b.x - a.x, b.y - a.y), by = aside(way);
  if (!by || !apart) return [a, b];
  const [dx, dy] = [(by * (b.y - a.y)) / apart, (-by * (b.x - a.x)) / apart];
  return [{ x: a.x - dx, y: a.y - dy }, { x: b.x - dx, y: b.y - dy }];
}

// The points of a way: a straight line, or the path that was measured, as long as its places are where they were then.
function lineOf(way, at) {
  const [a, b] = ends(way, at);
  const path = state.paths.find((one) => one.a === way.a && one.b === way.b);
  const isAt = (place, [x, y]) => Math.hypot(place.x - x, place.y - y) < 0.01;
  const fits = path && isAt(placeNamed(way.a), path.line[0]) && isAt(placeNamed(way.b), path.line[path.line.length - 1]);
  return fits ? [a, ...path.line.slice(1, -1).map(([x, y]) => toScreen(x, y)), b] : [a, b];
}

function parts(line) {
  return line.slice(1).map((b, number) => ({ a: line[number], b }));
}

function longest(line) {
  const far = ({ a, b }) => Math.hypot(b.x - a.x, b.y - a.y);
  const found = parts(line).reduce((one, other) => (far(other) > far(one) ? other : one));
  return [found.a, found.b];
}

function drawnWay(way, line) {
  const key = wayKey(way);
  const points = line.map((one) => `${one.x},${one.y}`).join(" ");
  const words = `way from ${way.a} to ${way.b}, ${way.distance} long${way.one_way ? ", one way" : ""}${whom(way)}`;
  const group = svg(
    "g",
    { class: `way${isSelected("way", key) ? " selected" : ""}`, "data-key": key, tabindex: 0, role: "button", "aria-label": words },
    svg("polyline", { class: "hit", points }),
    svg("polyline", { class: `line${way.only_if ? " conditional" : ""}`, points }),
  );
  if (way.one_way) group.append(arrow(...line.slice(-2)));
  return group;
}

function arrow(a, b) {
  const apart = Math.hypot(b.x - a.x, b.y - a.y) || 1;
  const [dx, dy] = [(b.x - a.x) / apart, (b.y - a.y) / apart];
  const tip = { x: b.x - 15 * dx, y: b.y - 15 * dy };
  const back = { x: tip.x - 15 * dx, y: tip.y - 15 * dy };
  const points = [tip, { x: back.x + 8 * dy, y: back.y - 8 * dx }, { x: back.x - 8 * dy, y: back.y + 8 * dx }];
  return svg("polygon", { class: "head", points: points.map((one) => `${one.x},${one.y}`).join(" ") });
}

function lengthOf(way, [a, b], taken) {
  const words = `${way.distance}${way.only_if ? " ?" : ""}${whom(way)}`;
  const box = taken.on(a, b, width(words, false) + 8, ROW);
  return box && svg("g", { class: "label" }, halo(box), svg("text", { class: "small", x: box.x + 4, y: box.y + 13 }, words));
}

function rubber(at) {
  const from = pending.from && at.get(pending.from);
  if (!from || !pending.to) return [];
  const { left, top } = size();
  const [x2, y2] = [pending.to.x - left, pending.to.y - top];
  return [svg("line", { class: "rubber", x1: from.x, y1: from.y, x2, y2 })];
}

// Who is on a way in a game, in its middle: marks beside each other.
function travellers(ways, lines) {
  const playing = state.playing || {};
  const found = [];
  for (const way of ways) {
    const [a, b] = longest(lines.get(way));
    const on = state.view.agents.filter((one) => {
      const where = playing[one.name] || [];
      return where.length === 2 && where.includes(way.a) && where.includes(way.b);
    });
    on.forEach((one, number) => {
      const to = playing[one.name][1] === way.b ? b : a;
      const from = to === b ? a : b;
      const [x, y] = [from.x + 0.62 * (to.x - from.x) + 16 * number, from.y + 0.62 * (to.y - from.y)];
      const mark = marked(one.mark, x, y);
      mark.append(svg("title", {}, shown(one)));
      found.push(mark);
    });
  }
  return found;
}

// Places -----------------------------------------------------------------------------------------------------------

// In a game: can somebody set off to it whom the person plays?
const isOpen = (place) => state.playing !== null && state.leads.includes(place.name);

function drawnPlace(place, at) {
  const turn = (-place.yaw * Math.PI) / 180;
  const look = { class: "heading", x1: at.x, y1: at.y, x2: at.x + 16 * Math.cos(turn), y2: at.y + 16 * Math.sin(turn) };
  const kinds = ["place", isSelected("place", place.name) && "selected", pending.from === place.name && "begun", isOpen(place) && "begun"];
  const words = `place ${shown(place)} at ${place.x.toFixed(2)}, ${place.y.toFixed(2)}${isOpen(place) ? ", you can go there" : ""}`;
  return svg(
    "g",
    { class: kinds.filter(Boolean).join(" "), "data-key": place.name, tabindex: 0, role: "button", "aria-label": words },
    svg("circle", { class: "reach", cx: at.x, cy: at.y, r: 22 }),
    svg("line", look),
    svg("circle", { class: "dot", cx: at.x, cy: at.y, r: 9 }),
  );
}

function drawnSpot(place, spot) {
  const { x, y } = toScreen(spot.x, spot.y);
  const words = `spot of ${spot.robot} at ${shown(place)}: ${spot.x.toFixed(2)}, ${spot.y.toFixed(2)}`;
  return svg(
    "g",
    { class: "spot", "data-key": `${place.name} ${spot.robot}`, tabindex: 0, role: "button", "aria-label": words },
    svg("title", {}, words),
    svg("circle", { class: "near", cx: x, cy: y, r: 12 }),
    svg("circle", { class: "ring", cx: x, cy: y, r: 5 }),
  );
}

// Does an agent start there, or in a game: is it there?
function isAt(agent, place) {
  const where = state.playing && state.playing[agent.name];
  return where ? where.length === 1 && where[0] === place : agent.location === place;
}

// The name of a place, under it who starts there and what happens there.
function namesOf(place, at, taken) {
  const agents = state.view.agents.filter((one) => isAt(one, place.name));
  const events = state.view.events.filter((one) => one.location === place.name);
  const lasts = (one) => (one.duration ? ` (${one.duration})` : "");
  const rows = [
    { words: shown(place), kind: "place", thing: place, indent: 0 },
    ...agents.map((one) => ({ words: shown(one), kind: "agent", thing: one, indent: 18 })),
    ...events.map((one) => ({ words: `⚙ ${shown(one)}${lasts(one)}`, kind: "event", thing: one, indent: 0 })),
  ];
  const across = Math.max(...rows.map((row) => width(row.words, row.kind === "place") + row.indent)) + 10;
  const box = taken.beside(at.x, at.y, across, rows.length * ROW + 4, 15);
  const group = svg("g", { class: "label" });
  if (box.far) group.append(svg("line", { class: "leader", x1: at.x, y1: at.y, x2: box.x + box.w / 2, y2: box.y + box.h / 2 }));
  group.append(halo(box));
  rows.forEach((row, number) => {
    const y = box.y + 14 + number * ROW;
    const kinds = `row ${row.kind}-row${isSelected(row.kind, row.thing.name) ? " selected" : ""}`;
    const about = { class: kinds, "data-kind": row.kind, "data-name": row.thing.name };
    group.append(svg("text", { ...about, x: box.x + 5 + row.indent, y }, row.words));
    if (row.thing.mark) group.append(marked(row.thing.mark, box.x + 12, y - 4));
  });
  return group;
}

function marked(shape, x, y) {
  const mark = svg("g", { class: "mark", transform: `translate(${x} ${y})` });
  mark.innerHTML = shape; // a shape and a colour, made by the server of nothing that a person wrote
  return mark;
}

function halo(box) {
  return svg("rect", { class: "halo", x: box.x, y: box.y, width: box.w, height: box.h, rx: 4 });
}
