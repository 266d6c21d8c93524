// The text with its line numbers, and the findings beneath it.
import { byId, html } from "./elements.js";
import { state, type } from "./state.js";

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
  byId("counts").textContent = `${some(errors, "error")}, ${some(warnings, "warning")}`;
  byId("findings").replaceChildren(...state.view.findings.map(finding));
}

function number() {
  const count = state.text.split("\n").length;
  const wanted = Array.from({ length: count }, (_, line) => line + 1).join("\n");
  if (lines.textContent !== wanted) lines.textContent = wanted;
  lines.scrollTop = text.scrollTop;
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
  text.addEventListener("scroll", () => (lines.scrollTop = text.scrollTop));
}
