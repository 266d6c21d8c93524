"use strict";
// The page of a mission: it shows what the UI sends on the WebSocket, and asks for what the buttons say.
// Names and words come from a scenario that somebody else wrote: they become text nodes, never markup.

const SVG = "http://www.w3.org/2000/svg";
const MARGIN = 0.05; // time units inside a bound that something must be to count as possible, as in ui/mission_view.py
const SETTLED = 300; // ms for which buttons that have just appeared do nothing: the press was meant for what was there
const $ = (id) => document.getElementById(id);

let scene = null; // what stays: map, agents, buttons
let view = null; // what changes
let clock = { now: 0, seen: 0, rate: 0 }; // time units since the start, when that was heard (ms), units per second
let heard = 0; // number of the last entry of the log
let following = true; // whether the end of the log is kept in sight
const widgets = { buttons: new Map(), rows: new Map(), tasks: new Map(), groups: [], clocks: new Map(), rest: new Map(), statuses: new Map() };

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
  setMap();
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
    if (agent.kind === "human") text.setAttribute("aria-live", "assertive"); // the text alone: times change all the while
    const idle = agent.kind === "human" ? "nothing to do now" : "not under way";
    const task = { row, text, time, done, idle, word: "", pressed: "" };
    onPress(done, () => {
      const now = present(), given = view.tasks.find((each) => each.agent === agent.name), message = { do: "done", word: task.word, seq: view.seq };
      const report = () => {
        ask(message);
        task.pressed = message.word; // a second press would mean what comes next
        setTimeout(() => { task.pressed = ""; refresh(); }, 2000);
        refresh();
      };
      if (isEarly(given, now)) confirmed(earlyText(given, now), "It has ended", "Not yet", report);
      else report();
    });
    row.append(text, time, done);
    widgets.tasks.set(agent.name, task);
    return row;
  }));
}

function setButtons() { // only those are shown that are possible where their agent is
  const groups = new Map();
  widgets.buttons.clear();
  for (const { agent, word, label, from } of scene.buttons) {
    if (!groups.has(agent)) {
      const group = make("div", "group"), inside = make("div"), none = make("p", "none", "nothing now");
      group.setAttribute("role", "group");
      group.setAttribute("aria-label", `${shown(agent)}: what it may do`);
      group.append(make("span", "tag agent", shown(agent)), inside);
      inside.append(none);
      groups.set(agent, { group, inside, none, words: [], counts: new Map(), there: "", since: -Infinity });
    }
    const known = groups.get(agent), button = make("button"), time = make("small");
    button.type = "button";
    button.hidden = true;
    button.dataset.word = word;
    button.setAttribute("aria-disabled", "true");
    button.append(make("span", "", label), time);
    onPress(button, () => ask({ do: "say", word, seq: view.seq }));
    known.inside.append(button);
    known.words.push(word);
    for (const place of from) known.counts.set(place, (known.counts.get(place) || 0) + 1);
    widgets.buttons.set(word, { button, time, group: known });
  }
  widgets.groups = [...groups.values()];
  for (const { inside, counts } of widgets.groups) inside.dataset.rows = String(Math.min(6, Math.ceil(Math.max(...counts.values()) / 2)));
  $("free").hidden = groups.size === 0;
  $("buttons").replaceChildren(...widgets.groups.map(({ group }) => group));
}

function showButtons(now, here) {
  for (const group of widgets.groups) {
    const there = group.words.filter((word) => view.open[word]).join(" ");
    if (there !== group.there) Object.assign(group, { there, since: performance.now() });
    group.none.hidden = there !== "";
  }
  for (const [word, { button, time, group }] of widgets.buttons) {
    const [opens, closes] = view.open[word] || [Infinity, null];
    const possible = opens <= now + MARGIN && (closes === null || now <= closes);
    const settled = performance.now() - group.since >= SETTLED;
    button.hidden = !view.open[word];
    enable(button, here && possible && settled);
    say(time, possible ? (closes === null ? "now" : `now, for ${units(closes - now)}`) : opens > now && opens < Infinity ? `in ${units(opens - now)}` : "");
  }
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
  const now = present(), here = isCurrent(), over = view.verdict !== "";
  say($("now"), units(now));
  for (const id of ["people", "others", "free"]) $(id).classList.toggle("over", over); // there is nothing to report any more
  enable($("start"), here && !over && view.status === "waiting" && view.phase === "ready");
  enable($("finish"), isConnected() && !over && view.live);
  enable($("stop"), isConnected() && !over); // it is carried out when the observer answers
  for (const [name, value] of Object.entries(view.clocks)) say(widgets.clocks.get(name), units(value + now - view.at));
  showButtons(now, here);
  showObjectives(now);
  showAfter();
  showTimeline();
  for (const agent of view.agents) showAgent(widgets.rows.get(agent.name), agent, now);
  for (const [name, widget] of widgets.tasks) showTask(widget, name, view.tasks.find((task) => task.agent === name), now, here);
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
window.addEventListener("resize", () => {
  if (scene && $("map").clientWidth !== map.width) setMap();
  follow();
});
setInterval(refresh, 200);
window.addEventListener("DOMContentLoaded", connect); // when all scripts are there
