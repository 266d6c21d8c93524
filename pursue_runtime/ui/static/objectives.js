"use strict";
// What is to be achieved: what is due soonest comes first, with the time that is left, and the time that is guaranteed.

const BECOME = { reached: "reached", kept: "kept so far", broken: "broken", open: "to be reached", "not promised": "not promised" };
const SOON = 0.25; // of its limit: what has less time left is marked
let promises = []; // the rows, in the order of the scenario

function setObjectives() {
  const known = view.objectives;
  $("goal").hidden = known.length === 0;
  if (promises.length !== known.length) {
    promises = known.map(() => promiseRow());
    $("objectives").replaceChildren(...promises.map(({ row }) => row));
  }
  known.forEach(({ name, says, is, now }, number) => {
    const { row, parts } = promises[number];
    row.dataset.is = is;
    say(parts.become, is === "kept" && view.status === "won" ? "kept" : BECOME[is] || is);
    say(parts.name, name);
    say(parts.says, says);
    say(parts.now, view.verdict || now === `${name} to be done` ? "" : now);
  });
  sortObjectives();
}

function promiseRow() { // a press shows the whole sentence
  const row = make("li"), whole = make("details"), line = make("summary"), parts = {};
  for (const kind of ["become", "left", "name", "now", "says"]) {
    parts[kind] = make("span", kind);
    line.append(parts[kind], " ");
  }
  whole.append(line);
  row.append(whole);
  return { row, parts };
}

function sortObjectives() { // broken, then by what is due first, then as they are written
  const rank = ({ is, due }) => (is === "broken" ? -1e300 : due !== null ? due : is === "open" ? 1e299 : 1e300);
  const order = view.objectives.map((each, number) => [rank(each), number]).sort(([a, i], [b, j]) => a - b || i - j);
  const rows = order.map(([, number]) => promises[number].row), list = $("objectives");
  if (rows.some((row, place) => list.children[place] !== row)) list.append(...rows);
}

function showObjectives(now) {
  view.objectives.forEach((objective, number) => {
    const { row, parts } = promises[number], left = leftOf(objective, now);
    row.dataset.left = left.how;
    say(parts.left, left.text);
  });
  const soonest = view.objectives.filter((each) => each.due !== null).reduce((one, other) => (one && one.due <= other.due ? one : other), null);
  const left = soonest ? leftOf(soonest, now) : { how: "", text: "" };
  $("urgent").dataset.left = left.how;
  say($("urgent"), left.text ? `${soonest.name || soonest.says}: ${left.text}` : "");
  say($("next"), view.status === "running" && view.planned ? next(now) : "");
  say($("guarantee"), guarantee(now));
}

function leftOf({ due, limit }, now) { // how long until something has to come; said, and shown by a colour
  if (due === null || !view.live) return { how: "", text: "" };
  const left = due - now;
  if (left < 0) return { how: "late", text: `${lasting(-left)} late` };
  return { how: left < SOON * limit ? "soon" : "due", text: `due in ${lasting(left)}` };
}

function lasting(time) { // a time, in minutes and seconds where it counts seconds and is long
  const whole = Math.floor(time);
  if (scene.counts !== "seconds" || whole < 100) return units(time);
  return whole < 3600 ? `${Math.floor(whole / 60)} min ${whole % 60} s` : `${Math.floor(whole / 3600)} h ${Math.floor(whole / 60) % 60} min`;
}

function next(now) { // what the strategy does, as long as others begin nothing
  if (!view.next) return "Next: what others do. Until then the strategy has no command.";
  return `Next: ${view.next.says}${due(view.next, now)}, if nobody else begins anything before.`;
}

function guarantee(now) { // until when the goal is reached, whatever others do; honest about what is not known
  const given = view.guarantee;
  if (given.most === undefined || !(view.live || view.status === "waiting")) return "";
  const inAll = given.most === null ? "" : `at most ${atMost(given.most)} ${scene.counts}`;
  if (given.void) return `The guaranteed time is not known any more: ${given.void}.`;
  if (!inAll) return `The goal is guaranteed; in how many ${scene.counts} is not known.`;
  if (!view.live) return `Guaranteed: ${inAll} from the start, if everybody keeps to the model.`;
  if (now > given.most) return `The guaranteed time of ${atMost(given.most)} ${scene.counts} from the start is over.`;
  return `Guaranteed: at most ${atMost(given.most - now)} ${scene.counts} from now, ${atMost(given.most)} in all, if everybody keeps to the model.`;
}

const atMost = (value) => String(Math.ceil(value * 10 - 1e-6) / 10); // rounded up: less is not guaranteed
