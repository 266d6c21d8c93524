// What to do next, as long as something is missing without which there is nothing to solve.
import { button, byId, html, typeName } from "./elements.js";
import { change, state } from "./state.js";

export const MISSING = new Set(["PML132", "PML130", "PML171"]); // no place, no agent, no objective: the steps say so

function choose(tool) {
  const input = document.querySelector(`input[name=tool][value=${tool}]`);
  input.checked = true;
  input.dispatchEvent(new Event("change", { bubbles: true }));
  byId("plan").focus({ preventScroll: true });
}

function open(id) {
  byId(id).scrollIntoView({ block: "nearest" });
  byId(id).focus();
}

// What is missing first: its words, how it is done, and whether it is there.
function steps() {
  const { places, ways, agents, events, findings } = state.view;
  const wants = !findings.some((one) => one.code === "PML171");
  return [
    ["Where: add places", "Click on the plan where rooms, doors or machines are, and type their names.", places.length > 0, ["Add places", () => choose("place")]],
    ["Ways: connect places", "Drag from a place to the next one. A way is as long as it is drawn, until you say how long it is.", ways.length > 0 || (places.length === 1 && agents.length > 0), ["Draw ways", () => choose("way")]],
    ["Who: add robots and people", "Click on the place where each of them starts; choose what it is.", agents.length > 0, ["Add agents", () => choose("agent")]],
    ["What happens: add events", "Something to do at a place, or a call. Tick at each agent what it can do.", events.length > 0 || wants, ["Add an event", () => change({ do: "add event" }, typeName)]],
    ["What is wanted: choose an objective", "From the list below; then press Solve.", wants, ["Choose an objective", () => open("form")]],
  ];
}

export function guide() {
  const all = steps(), next = all.findIndex(([, , done]) => !done);
  byId("guide").hidden = next < 0 || !state.view.findings.some((one) => MISSING.has(one.code));
  byId("steps").replaceChildren(...all.map(([title, how, done, [label, act]], number) => {
    const now = number === next;
    const words = done ? `✓ ${title}` : title;
    return html("li", { class: done ? "done" : now ? "now" : "", "aria-current": now ? "step" : null }, words, now ? html("p", {}, how) : null, now ? button(label, act) : null);
  }));
}

// A page that is opened with nothing on it begins with places.
export function greet() {
  if (!state.text.trim()) choose("place");
}
