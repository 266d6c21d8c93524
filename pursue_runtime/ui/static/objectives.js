"use strict";
// What is to be achieved, what of it is achieved, and the time that the strategy guarantees.

const BECOME = { reached: "reached", kept: "kept so far", broken: "broken", open: "to be reached", "not promised": "not promised" };

function setObjectives() {
  const list = $("objectives"), known = view.objectives;
  $("goal").hidden = known.length === 0;
  while (list.children.length > known.length) list.lastChild.remove();
  while (list.children.length < known.length) {
    const row = make("li");
    row.append(make("span", "become"), " ", make("span", "says"), make("div", "now"));
    list.append(row);
  }
  known.forEach(({ says, is, now }, number) => {
    const row = list.children[number];
    row.dataset.is = is;
    say(row.querySelector(".become"), is === "kept" && view.status === "won" ? "kept" : BECOME[is] || is);
    say(row.querySelector(".says"), says);
    say(row.querySelector(".now"), now);
  });
}

function showObjectives(now) {
  say($("next"), view.status === "running" && view.planned ? next(now) : "");
  say($("guarantee"), guarantee(now));
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
