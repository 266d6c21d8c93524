// What is selected, as a form: each field that is changed changes the text.
import { button, byId, field, html, shown, tick } from "./elements.js";
import { atStatement, change, fixed, select, selected, state } from "./state.js";

const KINDS = [["robot", "a robot"], ["person", "a person who follows instructions"], ["free", "does as it likes"]];
const SIZE = [
  ["radius", "radius in metres (0.2, or 20 cm)"],
  ["tolerance", "stops so far from its goal, in metres"],
  ["inflation", "its planners keep so far from obstacles, in metres"],
];
const form = byId("inspector");
const NOUNS = { place: "POI", agent: "agent", event: "event" };

export function inspect() {
  const one = selected();
  const focused = form.contains(document.activeElement) ? document.activeElement.id : null;
  form.replaceChildren();
  if (!one) return;
  if (one.thing.made) return inspectFixed(one);
  const { title, fields, more } = { place, way, agent, event, other }[one.kind](one.thing);
  const away = button("Delete", () => change({ do: "delete", statement: one.thing.statement }), { class: "danger", id: "delete" });
  form.append(html("h2", {}, title), html("div", { class: "fields" }, ...fields), html("p", { class: "row" }, ...more, away));
  const again = focused && byId(focused);
  if (again) again.focus({ preventScroll: true });
}

// What comes of a statement that is for each of a group: that is shown, and chosen with a button.
function inspectFixed({ kind, thing }) {
  const title = kind === "way" ? `Way between ${thing.a} and ${thing.b}` : `${shown(thing)} (${kind})`;
  const there = button("Choose that statement", () => select(atStatement(thing.statement)), { id: "its-statement" });
  form.append(html("h2", {}, title), html("p", { class: "quiet" }, `${fixed(thing)}.`), html("p", { class: "row" }, there));
}

function set(thing, name) {
  return (value) => change({ do: "set", statement: thing.statement, fields: { [name]: value } });
}

function named(kind, thing) {
  const rename = (value) => change({ do: "rename", kind: NOUNS[kind], name: thing.name, new: value.trim() });
  return [
    field("field-name", "name", thing.name, rename, { spellcheck: "false", maxlength: 60 }),
    field("field-label", "label (what people read)", thing.label, set(thing, "label"), { maxlength: 60 }),
  ];
}

const places = () => state.view.places.map((one) => [one.name, shown(one)]);
const number = { type: "number", step: "any" };

// For whom a place or a way is.
const whom = (thing) => [
  field("field-only_for", "only for (agents)", thing.only_for, set(thing, "only_for"), { spellcheck: "false" }),
  field("field-not_for", "not for (agents)", thing.not_for, set(thing, "not_for"), { spellcheck: "false" }),
];

function place(thing) {
  const move = (part) => (value) =>
    change(() => {
      const now = state.view.places.find((each) => each.name === thing.name);
      return now && { do: "move place", name: now.name, x: now.x, y: now.y, [part]: Number(value) };
    });
  const fields = [
    ...named("place", thing),
    field("field-x", "x in metres", thing.x, move("x"), number),
    field("field-y", "y in metres", thing.y, move("y"), number),
    field("field-yaw", "looks to, in degrees from x", thing.yaw, move("yaw"), number),
    ...whom(thing),
  ];
  const others = places().filter(([name]) => name !== thing.name);
  const to = field("field-to", "a way to", "", (value) => value && change({ do: "connect", a: thing.name, b: value }), {
    options: [["", "choose …"], ...others],
  });
  const more = [
    button("Agent here", () => change({ do: "add agent", location: thing.name }), { id: "agent-here" }),
    button("Event here", () => change({ do: "add event", location: thing.name }), { id: "event-here" }),
  ];
  return { title: `Place ${shown(thing)}`, fields: [...fields, to], more };
}

function way(thing) {
  const fields = [
    field("field-distance", "distance", thing.distance, set(thing, "distance")),
    tick("field-one_way", `from ${thing.a} to ${thing.b} only`, thing.one_way, set(thing, "one_way")),
    ...whom(thing),
    field("field-only_if", "only while (a condition)", thing.only_if, set(thing, "only_if"), { wide: true, spellcheck: "false" }),
  ];
  return { title: `Way between ${thing.a} and ${thing.b}`, fields: [...fields, ...secondWay(thing)], more: [] };
}

// Another way between the same places, for some agents.
function secondWay(thing) {
  const mine = thing.only_for ? thing.only_for.split(/,\s*/) : null, not = thing.not_for.split(/,\s*/);
  const agents = state.view.agents.filter((one) => one.mobile || one.speed).filter((one) => (mine ? mine.includes(one.name) : !not.includes(one.name)));
  if (agents.length < (mine ? 2 : 1)) return [];
  const chosen = new Set();
  const ticks = agents.map((one) => tick(`second-${one.name}`, shown(one), false, (on) => (on ? chosen.add(one.name) : chosen.delete(one.name))));
  const length = field("second-distance", "distance", thing.distance, () => {}, {});
  const add = () => change(() => ({ do: "second way", statement: thing.statement, agents: [...chosen], distance: byId("second-distance").value }));
  const fields = [html("legend", {}, "Another way, of another length, for"), ...ticks, length, button("Add it", add, { id: "add-second" })];
  return [html("fieldset", { class: "wide row", id: "second" }, ...fields)];
}

// Ticks for the events in one of an agent's lists; an event that is ticked comes last.
function list(thing, name, words, events) {
  const ticks = events.map((one) => {
    const write = (on) =>
      change(() => {
        const now = state.view.agents.find((each) => each.name === thing.name);
        const others = now && now[name].filter((each) => each !== one.name);
        return now && { do: "set", statement: now.statement, fields: { [name]: on ? [...others, one.name] : others } };
      });
    return tick(`${name}-${one.name}`, shown(one), thing[name].includes(one.name), write);
  });
  if (!ticks.length) return [];
  return [html("fieldset", { class: "wide row" }, html("legend", {}, words), ...ticks)];
}

function agent(thing) {
  const things = state.view.names.thing;
  const fields = [
    ...named("agent", thing),
    field("field-kind", "is", thing.kind, set(thing, "kind"), { options: KINDS }),
    field("field-location", "starts at", thing.location, set(thing, "location"), { options: places() }),
    field("field-mobile", `${state.view.pace} (empty: stays)`, thing.mobile, set(thing, "mobile"), { inputmode: "decimal" }),
    field("field-speed", "or its speed in metres per second", thing.speed, set(thing, "speed"), { inputmode: "decimal" }),
    ...(things.length ? [field("field-carries", "carries so many things at a time (empty: one)", thing.carries, set(thing, "carries"), { inputmode: "numeric" }), field("field-has", "has at the start (box, box)", thing.has, set(thing, "has"), { spellcheck: "false" })] : []),
    ...(thing.kind === "robot" ? SIZE.map(([name, words]) => field(`field-${name}`, words, thing[name], set(thing, name))) : []),
    ...list(thing, "can_do", "can do", state.view.events),
    ...list(thing, "reacts_to", "reacts to", state.view.events.filter((one) => one.collaborative || thing.reacts_to.includes(one.name))),
  ];
  return { title: `Agent ${shown(thing)}`, fields, more: [] };
}

function event(thing) {
  const things = state.view.names.thing;
  const fields = [
    ...named("event", thing),
    field("field-location", "happens", thing.location, set(thing, "location"), { options: [["", "anywhere"], ...places()] }),
    field("field-duration", "duration (3, 3 to 5, or 30 s to 1 min; empty: none)", thing.duration, set(thing, "duration"), { spellcheck: "false" }),
    tick("field-may_stop", "may be broken off before it ends", thing.may_stop, set(thing, "may_stop")),
    field("field-parts", "in so many parts, which stay done", thing.parts, set(thing, "parts"), { inputmode: "numeric" }),
    ...["takes", "gives", "mounts", "needs"].filter(() => things.length).map((word) => field(`field-${word}`, word, thing[word], set(thing, word), { options: [["", "nothing"], ...[...new Set([...things, thing[word]])].filter(Boolean).map((one) => [one, one])] })),
    field("field-at_most", "at most so many times", thing.at_most, set(thing, "at_most"), { inputmode: "numeric" }),
    tick("field-collaborative", "needs a partner who reacts", thing.collaborative, set(thing, "collaborative")),
    tick("field-together", "keeps both busy until it ends", thing.together, set(thing, "together")),
    field("field-only_if", "only while (a condition)", thing.only_if, set(thing, "only_if"), { wide: true, spellcheck: "false" }),
  ];
  return { title: `Event ${shown(thing)}`, fields, more: [] };
}

function other(thing) {
  const write = (words) => change({ do: "restate", statement: thing.statement, words });
  const words = field("field-words", "words", thing.words, write, { wide: true, spellcheck: "false" });
  const note = html("p", { class: "quiet wide" }, "There is a comment in it: change it in the text.");
  return { title: "Statement", fields: [thing.single ? words : note], more: [] };
}

form.addEventListener("submit", (submitted) => submitted.preventDefault());
