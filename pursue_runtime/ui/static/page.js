"use strict";
// The page of a mission: it shows what the UI sends on the WebSocket, and asks for what the buttons say.
// Names and words come from a scenario that somebody else wrote: they become text nodes, never markup.

const SVG = "http://www.w3.org/2000/svg";
const MARGIN = 0.05; // time units inside a bound that something must be to count as possible, as in ui/mission_view.py
const MARK = 24; // pixels from one mark to the next above it
const POI = 14; // half the height of a point of interest
const $ = (id) => document.getElementById(id);

let scene = null; // what stays: map, agents, buttons
let view = null; // what changes
let clock = { now: 0, seen: 0, rate: 0 }; // time units since the start, when that was heard (ms), units per second
let socket = null;
let heard = 0; // number of the last entry of the log
let following = true; // whether the end of the log is kept in sight
let patience = 1000; // ms until the next try to connect
const widgets = { buttons: new Map(), rows: new Map(), tasks: new Map(), clocks: new Map(), rest: new Map(), statuses: new Map() };
const map = { points: new Map(), marks: new Map(), moving: false, last: 0 };

function make(tag, kind, text) {
  const made = document.createElement(tag);
  if (kind) made.className = kind;
  if (text !== undefined) made.textContent = text;
  return made;
}

function draw(tag, parent, attributes) {
  const made = document.createElementNS(SVG, tag);
  for (const [name, value] of Object.entries(attributes || {})) made.setAttribute(name, value);
  parent.append(made);
  return made;
}

function say(element, text) { // only what is new: screen readers and layout are left in peace
  if (element.textContent !== text) element.textContent = text;
}

function enable(button, on) {
  const wanted = String(!on);
  if (button.getAttribute("aria-disabled") !== wanted) button.setAttribute("aria-disabled", wanted);
}

function onPress(button, act) { // aria-disabled keeps the focus where it is; so the click is refused here
  button.addEventListener("click", () => { if (button.getAttribute("aria-disabled") !== "true") act(); });
}

const shown = (name) => (Object.prototype.hasOwnProperty.call(scene.labels, name) ? scene.labels[name] : name); // what people read for it
const short = (name) => (name.length > 24 ? name.slice(0, 23) + "…" : name);
const units = (number) => Math.max(0, number).toFixed(1);

// The connection -----------------------------------------------------------------------------------------------------

function connect() {
  const address = (location.protocol === "https:" ? "wss://" : "ws://") + location.host + "/live";
  let opened = false;
  socket = new WebSocket(address);
  socket.onopen = () => { opened = true; patience = 1000; };
  socket.onmessage = (event) => take(JSON.parse(event.data));
  socket.onclose = () => {
    socket = null;
    clock = { now: present(), seen: performance.now(), rate: 0 };
    link("away", view && view.verdict ? "the mission has ended" : "connection lost, trying again");
    if (!opened) explain();
    refresh();
    setTimeout(connect, patience);
    patience = Math.min(2 * patience, 5000);
  };
}

async function explain() { // a WebSocket does not say why it was refused
  try {
    const answer = await fetch("page.css", { cache: "no-store" });
    if (answer.status === 401 || answer.status === 403) link("away", "not allowed: open the link that the UI has printed");
  } catch (problem) { /* there is nobody */ }
}

function link(is, text) {
  $("link").dataset.is = is;
  say($("link"), text);
}

function ask(message) {
  if (socket && socket.readyState === WebSocket.OPEN) socket.send(JSON.stringify(message));
  else remark("There is no connection: nothing was sent.");
}

function remark(text) {
  say($("remark"), text);
  clearTimeout(remark.timer);
  remark.timer = setTimeout(() => say($("remark"), ""), 8000);
}

function take(message) {
  if (message.type === "hello") {
    link("here", "connected");
    setScene(message.scene);
    if (!message.log.some((entry) => entry.n === heard)) forgetLog();
    setView(message.view);
    addLog(message.log);
  } else if (message.type === "view") {
    setView(message.view);
    addLog(message.log);
  } else if (message.type === "tick") {
    heardTime(message.now);
  } else if (message.type === "remark") {
    remark(message.text);
  }
}

// Time ---------------------------------------------------------------------------------------------------------------

function heardTime(now) { // simulated time has a pace of its own: it is measured
  const seen = performance.now(), passed = (seen - clock.seen) / 1000;
  let rate = clock.rate || 1 / view.unit;
  if (passed > 0.3 && now >= clock.now) rate = (rate + (now - clock.now) / passed) / 2;
  else if (passed <= 0.3) { clock.now = now - clock.rate * passed; return; }
  clock = { now, seen, rate };
}

function present() {
  return clock.now + (view && view.live ? clock.rate * Math.min(3, (performance.now() - clock.seen) / 1000) : 0);
}

// What stays ---------------------------------------------------------------------------------------------------------

function setScene(fresh) {
  const same = JSON.stringify(fresh) === JSON.stringify(scene);
  scene = fresh;
  $("main").hidden = false;
  if (same) return;
  say($("scenario"), scene.scenario);
  for (const tag of document.querySelectorAll(".legend .tag")) {
    tag.hidden = !scene.agents.some((agent) => tag.classList.contains(agent.kind));
  }
  setAgents();
  setTasks();
  setButtons();
  setMap();
}

function setAgents() {
  widgets.rows.clear();
  $("agents").replaceChildren(...scene.agents.map((agent) => {
    const row = make("li", "agent-row"), line = make("div"), doing = make("span"), next = make("div", "next");
    const progress = make("progress");
    progress.max = 1;
    progress.setAttribute("aria-label", `progress of ${shown(agent.name)}`);
    line.append(make("span", `tag ${agent.kind}`, shown(agent.name)), " ", doing);
    row.append(line, progress, next);
    widgets.rows.set(agent.name, { row, doing, progress, next });
    return row;
  }));
}

function setTasks() {
  const reporters = scene.agents.filter((agent) => scene.reporters.includes(agent.name));
  widgets.tasks.clear();
  setTaskList("people", "tasks", reporters.filter((agent) => agent.kind === "human"));
  setTaskList("others", "ends", reporters.filter((agent) => agent.kind !== "human"));
}

function setTaskList(section, list, agents) {
  $(section).hidden = agents.length === 0;
  $(list).replaceChildren(...agents.map((agent) => {
    const row = make("li", "idle"), text = make("span", "task"), time = make("span", "task-time"), done = make("button", "done", "Done");
    done.type = "button";
    const idle = agent.kind === "human" ? "nothing to do now" : "not under way";
    const task = { row, text, time, done, idle, word: "", pressed: "" };
    onPress(done, () => {
      ask({ do: "done", word: task.word });
      task.pressed = task.word; // a second press would mean what comes next
      setTimeout(() => { task.pressed = ""; refresh(); }, 2000);
      refresh();
    });
    row.append(text, time, done);
    widgets.tasks.set(agent.name, task);
    return row;
  }));
}

function setButtons() {
  const groups = new Map();
  widgets.buttons.clear();
  for (const { agent, word, label } of scene.buttons) {
    if (!groups.has(agent)) {
      const group = make("div", "group"), inside = make("div");
      group.setAttribute("role", "group");
      group.setAttribute("aria-label", shown(agent));
      group.append(make("span", "tag agent", shown(agent)), inside);
      groups.set(agent, { group, inside });
    }
    const button = make("button"), time = make("small");
    button.type = "button";
    button.dataset.word = word;
    button.setAttribute("aria-disabled", "true");
    button.append(make("span", "", label), time);
    onPress(button, () => ask({ do: "say", word }));
    groups.get(agent).inside.append(button);
    widgets.buttons.set(word, { button, time });
  }
  $("free").hidden = groups.size === 0;
  $("buttons").replaceChildren(...[...groups.values()].map(({ group }) => group));
}

// The map ------------------------------------------------------------------------------------------------------------

function setMap() {
  const names = Object.keys(scene.places), width = $("map").clientWidth;
  map.points.clear();
  map.marks.clear();
  $("where").hidden = names.length === 0;
  if (!names.length || !width) return;
  const longest = Math.max(...[...names, ...scene.agents.map((agent) => agent.name)].map((name) => short(shown(name)).length));
  const above = 2 * POI + MARK * Math.min(3, scene.agents.length), below = 2 * POI, side = Math.min(width / 4, 16 + 4.2 * longest);
  const xs = names.map((name) => scene.places[name][0]), ys = names.map((name) => scene.places[name][1]);
  const across = Math.max(...xs) - Math.min(...xs), up = Math.max(...ys) - Math.min(...ys);
  const scale = Math.min((width - 2 * side) / (across || 1e-6), 420 / (up || 1e-6), across || up ? Infinity : 1);
  const left = (width - scale * across) / 2, high = Math.max(above + below + scale * up, 200);
  const top = above + (high - above - below - scale * up) / 2;
  const picture = document.createElementNS(SVG, "svg");
  picture.setAttribute("viewBox", `0 0 ${width} ${high}`);
  picture.setAttribute("height", high);
  picture.setAttribute("role", "img");
  picture.setAttribute("aria-label", `Map of ${scene.scenario}; the list "Who does what" says the same in words`);
  $("map").replaceChildren(picture);
  names.forEach((name, i) => map.points.set(name, { x: left + scale * (xs[i] - Math.min(...xs)), y: top + scale * (Math.max(...ys) - ys[i]) }));
  for (const [a, b] of scene.ways) {
    const from = map.points.get(a), to = map.points.get(b);
    draw("line", picture, { class: "way", x1: from.x, y1: from.y, x2: to.x, y2: to.y });
  }
  for (const [a, b] of scene.one_ways) {
    draw("polygon", picture, { class: "arrow", points: arrow(map.points.get(a), map.points.get(b)) });
  }
  for (const [a, b, length] of scene.ways) {
    const from = map.points.get(a), to = map.points.get(b);
    const part = scene.one_ways.some(([first, second]) => first === a && second === b) ? 0.42 : 0.5;
    draw("text", picture, { class: "length", x: from.x + part * (to.x - from.x), y: from.y + part * (to.y - from.y) }).textContent = length;
  }
  for (const name of names) {
    const { x, y } = map.points.get(name);
    labelled(picture, "poi", shown(name), 2 * POI, 14).setAttribute("transform", `translate(${x} ${y})`);
  }
  for (const { name, kind } of scene.agents) {
    const group = labelled(picture, `mark ${kind}`, shown(name), 22, 4);
    group.dataset.agent = name;
    map.marks.set(name, { group, half: group.querySelector("rect").width.baseVal.value / 2, x: null, y: null });
  }
  map.width = width;
  animate(performance.now());
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

function share(agent, now) { // of what it does: nine tenths when it may end, all when it must
  if (agent.since === null) return 0;
  const { since, low, high } = agent;
  const part = now < low ? 0.9 * (now - since) / (low - since) : 0.9 + 0.1 * (high > low ? (now - low) / (high - low) : 1);
  return Math.min(1, Math.max(0, part));
}

function animate(moment) {
  map.moving = false;
  if (!view || !map.marks.size) return;
  const now = present(), pace = Math.min(1, (moment - map.last) / 150), standing = new Map();
  map.last = moment;
  let unsettled = false;
  for (const agent of view.agents) {
    const mark = map.marks.get(agent.name), from = map.points.get(agent.place), to = map.points.get(agent.to);
    if (!mark) continue;
    mark.group.style.display = from ? "" : "none";
    mark.group.classList.toggle("lost", agent.lost);
    if (!from) continue;
    const anchor = agent.to ? [agent.place, agent.to].join("\n") : agent.place;
    const row = standing.get(anchor) || 0, part = to ? share(agent, now) : 0;
    standing.set(anchor, row + 1);
    const x = to ? from.x + part * (to.x - from.x) : from.x;
    const y = (to ? from.y + part * (to.y - from.y) : from.y - POI - 13) - MARK * row;
    const inside = Math.min(map.width - mark.half - 2, Math.max(mark.half + 2, x));
    const fast = mark.x === null || calm.matches;
    mark.x = fast ? inside : mark.x + pace * (inside - mark.x);
    mark.y = fast ? y : mark.y + pace * (y - mark.y);
    mark.group.setAttribute("transform", `translate(${mark.x.toFixed(1)} ${mark.y.toFixed(1)})`);
    unsettled = unsettled || Math.abs(mark.x - inside) + Math.abs(mark.y - y) > 0.5 || (to && part < 1 && view.live);
  }
  if (unsettled && !map.moving) {
    map.moving = true;
    requestAnimationFrame(animate);
  }
}

const calm = window.matchMedia("(prefers-reduced-motion: reduce)");

// What changes -------------------------------------------------------------------------------------------------------

function setView(fresh) {
  const restart = !view || fresh.seq < view.seq;
  view = fresh;
  if (!view.live) clock = { now: view.at, seen: performance.now(), rate: 0 };
  else if (restart) clock = { now: view.now, seen: performance.now(), rate: 1 / view.unit };
  else heardTime(view.now);
  const early = { "waiting for the nodes": "waiting", ready: "ready", starting: "starting" };
  const status = view.status === "waiting" ? early[view.phase] || "waiting" : view.status;
  $("status").dataset.is = status;
  say($("status"), status);
  document.title = `${status} · ${scene.scenario}`;
  const lost = view.lost.length ? `Lost: ${view.lost.map(shown).join(", ")}. ` : "";
  const missing = view.missing.length ? `Not ready yet: ${view.missing.join(", ")}` : "";
  say($("why"), lost + (view.verdict || view.reason || missing));
  say($("turn"), view.turn);
  pairs(widgets.rest, $("rest"), Object.keys(view.rest));
  pairs(widgets.clocks, $("clocks"), Object.keys(view.clocks));
  pairs(widgets.statuses, $("statuses"), Object.keys(view.statuses));
  $("stands").hidden = widgets.statuses.size === 0;
  for (const [name, text] of Object.entries(view.statuses)) say(widgets.statuses.get(name), text);
  for (const [name, value] of Object.entries(view.rest)) say(widgets.rest.get(name), String(value));
  refresh();
  if (!map.moving) animate(performance.now());
}

function pairs(known, list, names) {
  if (names.length === known.size && names.every((name) => known.has(name))) return;
  known.clear();
  list.replaceChildren(...names.map((name) => {
    const pair = make("div"), value = make("dd");
    pair.append(make("dt", "", name), value);
    known.set(name, value);
    return pair;
  }));
}

function refresh() { // what changes while nothing happens: times, and what is possible
  if (!view) return;
  const now = present(), here = socket !== null && socket.readyState === WebSocket.OPEN, over = view.verdict !== "";
  say($("now"), units(now));
  enable($("start"), here && !over && view.status === "waiting" && view.phase === "ready");
  enable($("stop"), here && !over);
  for (const [name, value] of Object.entries(view.clocks)) say(widgets.clocks.get(name), units(value + now - view.at));
  for (const [word, { button, time }] of widgets.buttons) {
    const [opens, closes] = view.open[word] || [Infinity, null];
    const possible = opens <= now + MARGIN && (closes === null || now <= closes);
    enable(button, here && possible);
    say(time, possible ? (closes === null ? "now" : `now, for ${units(closes - now)}`) : opens > now && opens < Infinity ? `in ${units(opens - now)}` : "");
  }
  for (const agent of view.agents) showAgent(widgets.rows.get(agent.name), agent, now);
  for (const [name, widget] of widgets.tasks) showTask(widget, name, view.tasks.find((task) => task.agent === name), now, here);
}

function showAgent(widget, agent, now) {
  widget.row.classList.toggle("lost", agent.lost);
  say(widget.doing, agent.doing + (agent.lost ? " (counts as lost)" : ""));
  widget.progress.style.visibility = agent.since === null || !view.live ? "hidden" : "visible";
  widget.progress.value = share(agent, now);
  const parts = agent.next.map(({ label, opens, closes }) => {
    if (closes !== null && now > closes) return agent.since !== null && agent.high !== null && now > agent.high ? `${label}: ${units(now - closes)} late` : "";
    return `${label} ${opens <= now + MARGIN ? "now" : `in ${units(opens - now)}`}`;
  }).filter((part) => part);
  say(widget.next, parts.slice(0, 4).join(", ") + (parts.length > 4 ? " …" : ""));
}

function showTask(widget, name, task, now, here) {
  widget.row.classList.toggle("idle", !task);
  widget.word = task ? task.word : "";
  say(widget.text, task ? `${shown(name)}: ${task.text}` : `${shown(name)}: ${widget.idle}`);
  say(widget.done, task ? task.label : widget.done.textContent);
  say(widget.time, task && task.low !== null ? `for ${units(now - task.since)} now; planned: ${units(task.low - task.since)} to ${units(task.high - task.since)}` : "");
  widget.done.setAttribute("aria-label", task ? `${task.label}: ${shown(name)}, ${task.text}` : widget.done.textContent);
  enable(widget.done, here && Boolean(task) && widget.pressed !== widget.word);
}

function forgetLog() {
  heard = 0;
  $("log").replaceChildren();
}

function addLog(entries) {
  const log = $("log");
  for (const { n, at, text, kind, word } of entries) {
    if (n <= heard) continue;
    heard = n;
    const line = make("li"), told = make("span", kind);
    told.append(text);
    if (word && word !== text) told.append(" ", make("span", "word", word));
    line.append(make("span", "at", units(at)), told);
    log.append(line);
  }
  while (log.children.length > 500) log.firstChild.remove();
  follow();
}

function follow() { // the end of the log stays in sight, unless somebody has scrolled up
  if (following) $("log").scrollTop = $("log").scrollHeight;
}

// Everything starts here ---------------------------------------------------------------------------------------------

onPress($("start"), () => ask({ do: "start" }));
onPress($("stop"), () => {
  if ($("sure").showModal) $("sure").showModal();
  else if (window.confirm($("sure-text").textContent)) ask({ do: "stop" });
});
onPress($("stop-yes"), () => { $("sure").close(); ask({ do: "stop" }); });
onPress($("stop-no"), () => $("sure").close());
$("log").addEventListener("scroll", () => {
  const log = $("log");
  following = log.scrollHeight - log.scrollTop - log.clientHeight < 40;
});
window.addEventListener("resize", () => {
  if (scene && $("map").clientWidth !== map.width) setMap();
  follow();
});
setInterval(refresh, 200);
connect();
