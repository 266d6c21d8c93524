// The text and what is seen of it: the text is what counts, the picture follows it.
import { byId } from "./elements.js";

export const state = { text: "", view: null, viewed: "", selected: null, saved: "", playing: null, leads: [], past: [], future: [], opened: null, paths: [] };
// `viewed`: the text that `view` shows, which may be older than `text`. `playing`: in a game, where everybody is: agent → [place], or [from, to].
// `leads`: in a game, the place to which each of its choices leads, "" where it leads to none.
// `paths`: of ways, as they were measured on the map: their places `a` and `b`, and the bends of the `line` in metres.
const listeners = [];
let queue = Promise.resolve(); // changes are made one after the other
let typed = 0; // when the text was last typed in

export function onShow(listener) {
  listeners.push(listener);
}

export function show() {
  for (const listener of listeners) listener();
}

// Half a character, which a person can paste but no file can hold, is sent as a replacement character.
const whole = (_, value) => (typeof value === "string" ? value.replace(/\p{Surrogate}/gu, "\ufffd") : value);

// Asks the server; {refused, hint} where it does not do it or cannot be reached.
export async function ask(request, body = {}) {
  try {
    const headers = { "Content-Type": "application/json" };
    const answer = await fetch(request, { method: "POST", headers, body: JSON.stringify(body, whole) });
    if (answer.ok) return await answer.json();
    return { refused: await answer.text(), hint: "" };
  } catch (problem) {
    return { refused: "pursue-gen draw does not answer", hint: "start it again; the text is still here: copy it" };
  }
}

export function say(words, bad = false) {
  byId("status").textContent = words;
  byId("status").className = bad ? "bad" : "";
}

export function refusal(answer) {
  return answer.hint ? `${answer.refused} (${answer.hint})` : answer.refused;
}

// What can be selected ---------------------------------------------------------------------------------------------

export const wayKey = (way) => `${way.a} ${way.b} ${way.one_way} ${way.only_for} ${way.not_for}`;

export function all(view) {
  const some = (kind, list, key) => list.map((one) => ({ kind, key: key(one), thing: one }));
  return [
    ...some("place", view.places, (one) => one.name),
    ...some("way", view.ways, wayKey),
    ...some("agent", view.agents, (one) => one.name),
    ...some("event", view.events, (one) => one.name),
    ...some("other", view.others, (one) => one.words),
  ];
}

export function isSelected(kind, key) {
  return state.selected !== null && state.selected.kind === kind && state.selected.key === key;
}

export function selected() {
  return all(state.view).find((one) => isSelected(one.kind, one.key)) || null;
}

export function select(one) {
  state.selected = one && { kind: one.kind, key: one.key };
  show();
}

export function atStatement(number) {
  return all(state.view).find((one) => one.thing.statement === number && !one.thing.made) || null;
}

// What comes of a statement that is for each of a group is changed there only: says so, and is true.
export function isFixed(thing) {
  if (thing.made) say(`${fixed(thing)}: change that.`, true);
  return Boolean(thing.made);
}

export function fixed(thing) {
  return `It comes of the statement in line ${thing.from}, which is for each of a group (here ${thing.made})`;
}

// Changes ----------------------------------------------------------------------------------------------------------

function remember() {
  state.past.push(state.text);
  if (state.past.length > 500) state.past.shift();
  state.future = [];
}

// Lets the server make a change, and selects what it is about; `then` is called after that. What depends on the view is
// a function that makes the operation when it is its turn.
export function change(asked, then = null) {
  const made = queue.then(async () => {
    const before = state.text;
    const operation = typeof asked === "function" ? asked() : asked;
    if (!operation) return;
    const answer = await ask("change", { text: before, operation });
    if (answer.refused) {
      say(refusal(answer), true);
      await look(); // what was dragged goes back to where it is in the text
    } else if (state.text !== before) {
      say("The text was changed meanwhile: do it again.", true);
    } else {
      say("");
      if (answer.text !== before) remember();
      typed = 0;
      state.text = state.viewed = answer.text;
      state.view = answer.view;
      const about = answer.statement === null ? null : atStatement(answer.statement);
      if (about) state.selected = { kind: about.kind, key: about.key };
    }
    show();
    if (then && !answer.refused) then();
  });
  queue = made.catch((problem) => say(`This page has an error: ${problem.message}`, true));
  return queue;
}

let wanted = 0;
let waiting = 0;

// The text was typed in: the picture follows as soon as there is a pause.
export function type(text) {
  if (Date.now() - typed > 1000) remember();
  typed = Date.now();
  state.text = text;
  state.future = [];
  clearTimeout(waiting);
  waiting = setTimeout(look, 200);
  for (const id of ["undo", "redo"]) byId(id).disabled = !state[id === "undo" ? "past" : "future"].length;
}

// Shows the present text.
export async function look() {
  const number = ++wanted;
  const text = state.text;
  const answer = await ask("view", { text });
  if (number !== wanted || text !== state.text) return;
  if (answer.refused) say(refusal(answer), true);
  else Object.assign(state, { view: answer.view, viewed: text });
  show();
}

// Another text in the place of the present one.
export function replace(text) {
  if (text === state.text) return;
  remember();
  typed = 0;
  state.text = text;
  look();
}

function turnBack(from, to) {
  if (!from.length) return;
  to.push(state.text);
  state.text = from.pop();
  typed = 0;
  look();
}

export function undo() {
  turnBack(state.past, state.future);
}

export function redo() {
  turnBack(state.future, state.past);
}
