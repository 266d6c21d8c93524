// The text with its line numbers, and the findings beneath it.
import { byId, html } from "./elements.js";
import { MISSING } from "./guide.js";
import { all, isSelected, select, selected, state, type } from "./state.js";
import { isCurrent } from "./verdict.js";

const text = byId("text");
const lines = byId("lines");

export function write() {
  if (text.value !== state.text) {
    const [start, end, top] = [text.selectionStart, text.selectionEnd, text.scrollTop];
    text.value = state.text;
    text.setSelectionRange(Math.min(start, state.text.length), Math.min(end, state.text.length));
    text.scrollTop = top;
  }
  number();
  const { errors, warnings } = state.view;
  const some = (count, noun) => `${count} ${noun}${count === 1 ? "" : "s"}`;
  const missing = state.view.findings.filter((one) => MISSING.has(one.code)); // the steps say so
  const wrong = missing.length && errors === missing.length ? "not finished yet" : some(errors - missing.length, "error");
  byId("counts").textContent = `${wrong}, ${some(warnings, "warning")}`;
  byId("findings").replaceChildren(...state.view.findings.filter((one) => !MISSING.has(one.code)).map(finding));
  byId("wanted").hidden = !state.view.wanted.length || isCurrent();
  byId("wishes").replaceChildren(...state.view.wanted.map((sentence) => html("li", {}, sentence)));
}

// The numbers of the lines, those of what is selected marked.
function number() {
  const one = selected();
  const [from, to] = one ? [one.thing.from, one.thing.to] : [0, 0];
  const some = (first, last) => Array.from({ length: Math.max(0, last - first + 1) }, (_, line) => first + line).join("\n");
  const count = state.text.split("\n").length;
  const parts = from ? [`${some(1, from - 1)}\n`, html("b", {}, some(from, to)), some(to + 1, count)] : [some(1, count)];
  lines.replaceChildren(...(from === 1 ? parts.slice(1) : parts));
  lines.scrollTop = text.scrollTop;
}

// Selects what the cursor is in.
function follow() {
  const line = text.value.slice(0, text.selectionStart).split("\n").length;
  const one = all(state.view).find(({ thing }) => thing.from <= line && line <= thing.to);
  if (one && state.viewed === text.value && !isSelected(one.kind, one.key)) select(one);
}

function finding(one) {
  const where = one.line ? `${one.line}:${one.column}: ` : "";
  const go = html("button", { type: "button", onclick: () => mark(one) }, `${where}${one.severity} ${one.code}: ${one.message}`);
  const help = one.hint ? html("div", { class: "help" }, one.hint) : null;
  return html("li", { class: one.severity, "data-code": one.code }, go, help);
}

function mark(one) {
  if (one.start === undefined) return;
  text.focus();
  text.setSelectionRange(one.start, Math.max(one.end, one.start + 1));
  text.scrollTop = Math.max(0, (one.line - 6) * 20);
}

// Shows the lines of what was selected in the picture or in a list.
export function reveal(thing) {
  if (document.activeElement === text) return;
  text.scrollTop = Math.max(0, (thing.from - 6) * 20);
}

export function listen() {
  text.addEventListener("input", () => {
    type(text.value);
    number();
  });
  for (const moved of ["click", "keyup"]) text.addEventListener(moved, follow);
  text.addEventListener("scroll", () => (lines.scrollTop = text.scrollTop));
}
