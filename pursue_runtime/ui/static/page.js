"use strict";
// The page of a mission: it shows what the UI sends on the WebSocket, and asks for what the buttons say.
// Names and words come from a scenario that somebody else wrote: they become text nodes, never markup.

const SVG = "http://www.w3.org/2000/svg";
const MARGIN = 0.05; // time units inside a bound that something must be to count as possible, as in ui/mission_view.py
const $ = (id) => document.getElementById(id);

let scene = null; // what stays: map, agents, buttons
let view = null; // what changes
let clock = { now: 0, seen: 0, rate: 0 }; // time units since the start, when that was heard (ms), units per second
let heard = 0; // number of the last entry of the log
let following = true; // whether the end of the log is kept in sight
const widgets = { buttons: new Map(), rows: new Map(), tasks: new Map(), groups: [], clocks: new Map(), rest: new Map(), rules: new Map(), statuses: new Map() };

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

// What is asked and received ---------------------------------------------------------------------------------------------

function ask(message) {
  if (isConnected()) socket.send(JSON.stringify(message));
  else remark("There is no connection: nothing was sent.");
}

function remark(text) {
  say($("remark"), text);
  clearTimeout(remark.timer);
  remark.timer = setTimeout(() => say($("remark"), ""), 8000);
}

function take(message) {
  if (message.type === "hello") {
    setScene(message.scene);
    setMissions(message.missions);
    if (!message.log.some((entry) => entry.n === heard)) forgetLog();
    setView(message.view);
    setPositions(message.positions || {}, message.paths || {});
    addLog(message.log);
  } else if (message.type === "view") {
    setView(message.view);
    addLog(message.log);
  } else if (message.type === "positions") {
    setPositions(message.positions, message.paths || {});
  } else if (message.type === "missions") {
    setMissions(message.missions);
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
  return clock.now + (view && view.live && view.answers ? clock.rate * Math.min(3, (performance.now() - clock.seen) / 1000) : 0);
}

// What stays ---------------------------------------------------------------------------------------------------------

function setScene(fresh) {
  const same = JSON.stringify(fresh) === JSON.stringify(scene);
  scene = fresh;
  say($("counts"), scene.counts);
  $("main").hidden = false;
  if (same) return;
  say($("scenario"), scene.scenario);
  $("finish").hidden = !scene.finishes;
  for (const tag of document.querySelectorAll(".legend .tag")) {
    tag.hidden = !scene.agents.some((agent) => tag.classList.contains(agent.kind));
  }
  setAgents();
  setTasks();
  setButtons();
  setOrders();
  setMap();
}

// What changes -------------------------------------------------------------------------------------------------------

function setView(fresh) {
  const restart = !view || fresh.seq < view.seq;
  view = fresh;
  showConnection();
  if (!view.live || !view.answers) clock = { now: view.live ? view.now : view.at, seen: performance.now(), rate: 0 };
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
  setObjectives();
  pairs(widgets.rest, $("rest"), Object.keys(view.rest));
  pairs(widgets.clocks, $("clocks"), Object.keys(view.clocks));
  pairs(widgets.rules, $("rules"), Object.keys(view.inside));
  pairs(widgets.statuses, $("statuses"), Object.keys(view.statuses));
  $("stands").hidden = widgets.statuses.size === 0;
  for (const [list, values] of [["statuses", view.statuses], ["rules", view.inside], ["rest", view.rest]]) {
    for (const [name, value] of Object.entries(values)) say(widgets[list].get(name), String(value));
  }
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
  const now = present(), here = isCurrent(), over = view.verdict !== "";
  say($("now"), units(now));
  for (const id of ["people", "others", "menu", "free"]) $(id).classList.toggle("over", over); // there is nothing to report any more
  enable($("start"), here && !over && view.status === "waiting" && view.phase === "ready");
  enable($("finish"), isConnected() && !over && view.live);
  enable($("stop"), isConnected() && !over); // it is carried out when the observer answers
  for (const [name, value] of Object.entries(view.clocks)) say(widgets.clocks.get(name), units(value + now - view.at));
  showButtons(now, here);
  showOrders(here);
  showObjectives(now);
  showAfter();
  showTimeline();
  for (const agent of view.agents) showAgent(widgets.rows.get(agent.name), agent, now);
  for (const [name, widget] of widgets.tasks) showTask(widget, name, view.tasks.find((task) => task.agent === name), now, here);
}

function forgetLog() {
  heard = 0;
  $("entries").replaceChildren();
}

function addLog(entries) {
  const log = $("entries");
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
$("inside").addEventListener("toggle", () => $("log").classList.toggle("raw", $("inside").open));
$("log").addEventListener("scroll", () => {
  const log = $("log");
  following = log.scrollHeight - log.scrollTop - log.clientHeight < 40;
});
new ResizeObserver(() => {
  if (scene && ($("map").clientWidth !== map.width || $("map").clientHeight !== map.height)) setMap();
}).observe($("map"));
new ResizeObserver(follow).observe($("log"));
setInterval(refresh, 200);
window.addEventListener("DOMContentLoaded", connect); // when all scripts are there
