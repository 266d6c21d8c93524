// Everything that there is as lists, each with what adds to it: whoever does not see the picture has all of it here.
import { camera } from "./camera.js";
import { button, byId, field, html, shown, typeName, whom } from "./elements.js";
import { all, change, isSelected, say, select, state } from "./state.js";

const TITLES = { place: "Places", way: "Ways", agent: "Agents", event: "Events", other: "Rules, objectives and more" };
const GROUPS = {
  GROUP: "Groups", FOR: "For each of a group", RULE: "Rules", STATE: "States", STATEDEPENDENCY: "States", TRAVEL: "Travel times", BATTERY: "Batteries",
  ASSUME: "Assumptions", OBJECTIVE: "What must always hold", REACH_OBJECTIVE: "What is to be achieved",
  OPTIONAL: "Optional",
};
const chosen = { form: null, values: [], a: "", b: "", location: "" };
const box = byId("lists");

export function list() {
  const focused = box.contains(document.activeElement) ? document.activeElement.id : null;
  const closed = new Set([...box.querySelectorAll("details:not([open])")].map((one) => one.id));
  const things = all(state.view);
  box.replaceChildren(...Object.keys(TITLES).map((kind) => part(kind, things.filter((one) => one.kind === kind), closed)));
  const again = focused && byId(focused);
  if (again) again.focus({ preventScroll: true });
}

function part(kind, things, closed) {
  const items = things.map((one) => {
    const attributes = { id: `item-${kind}-${one.key}`, "aria-pressed": String(isSelected(one.kind, one.key)) };
    return html("li", {}, button(words(one), () => select(one), attributes));
  });
  const summary = html("summary", {}, `${TITLES[kind]} (${things.length})`);
  const body = [html("ul", {}, ...items), ...adding[kind]()];
  return html("details", { id: `list-${kind}`, open: !closed.has(`list-${kind}`) }, summary, ...body);
}

function words({ kind, thing }) {
  if (kind === "way") return `${thing.a} ${thing.one_way ? "→" : "–"} ${thing.b}: ${thing.distance}${whom(thing)}`;
  return kind === "other" ? thing.words : shown(thing);
}

// What adds --------------------------------------------------------------------------------------------------------

const places = () => [["", "choose …"], ...state.view.places.map((one) => [one.name, shown(one)])];

const adding = {
  place() {
    const add = () => change({ do: "add place", x: Math.round(camera.x * 100) / 100, y: Math.round(camera.y * 100) / 100 }, typeName);
    return [html("p", { class: "row" }, button("Add a place in the middle", add, { id: "add-place" }))];
  },
  way() {
    const add = () => (chosen.a && chosen.b ? change({ do: "connect", a: chosen.a, b: chosen.b }) : say("Choose two places.", true));
    return [
      html(
        "div",
        { class: "fields" },
        field("way-a", "from", chosen.a, (value) => (chosen.a = value), { options: places() }),
        field("way-b", "to", chosen.b, (value) => (chosen.b = value), { options: places() }),
        button("Add a way", add, { id: "add-way" }),
      ),
    ];
  },
  agent() {
    const add = () => (chosen.location ? change({ do: "add agent", location: chosen.location }, typeName) : say("Choose where it starts.", true));
    return [
      html(
        "div",
        { class: "fields" },
        field("agent-at", "starts at", chosen.location, (value) => (chosen.location = value), { options: places() }),
        button("Add an agent", add, { id: "add-agent" }),
      ),
    ];
  },
  event() {
    return [html("p", { class: "row" }, button("Add an event", () => change({ do: "add event" }, typeName), { id: "add-event" }))];
  },
  other() {
    return [chooser()];
  },
};

// A statement of a list, with something to choose in each of its holes.
function chooser() {
  const forms = state.opened.forms;
  const choice = html("select", { id: "form", onchange: () => choose(forms[Number(choice.value)]) });
  choice.append(html("option", { value: "-1" }, "choose …"));
  const groups = new Map();
  forms.forEach((form, number) => {
    const title = GROUPS[form.kind] || form.kind;
    if (!groups.has(title)) groups.set(title, html("optgroup", { label: title }));
    groups.get(title).append(html("option", { value: number, selected: form === chosen.form }, form.title));
  });
  choice.append(...groups.values());
  const parts = [html("label", {}, "Add ", choice)];
  if (chosen.form) {
    parts.push(html("p", { class: "row", id: "holes" }, ...holes(chosen.form)));
    parts.push(button("Add it", add, { id: "add-form" }));
  }
  return html("div", {}, ...parts);
}

function choose(form) {
  chosen.form = form || null;
  chosen.values = form ? form.holes.map((hole) => (hole.kind === "example" ? hole.of : "")) : [];
  list();
}

function holes(form) {
  const found = [];
  form.words.forEach((text, number) => {
    found.push(html("span", {}, text));
    if (number < form.holes.length) found.push(hole(form.holes[number], number));
  });
  return found;
}

function hole(what, number) {
  const id = `hole-${number}`;
  const label = `${what.of} ${number + 1}`;
  const keep = (event) => (chosen.values[number] = event.target.value);
  if (what.kind === "example") {
    return html("input", { id, "aria-label": label, value: chosen.values[number], size: 8, oninput: keep, autocomplete: "off" });
  }
  const names = [...state.view.names[what.of], ...(what.of === "agent" ? state.opened.anybody : [])];
  const choice = html("select", { id, "aria-label": label, onchange: keep });
  for (const name of ["", ...names]) choice.append(html("option", { value: name, selected: name === chosen.values[number] }, name || `${what.of === "POI" ? "place" : what.of} …`));
  return choice;
}

function add() {
  const { kind, form } = chosen.form;
  if (chosen.values.some((value) => !value)) return say("Choose something in each field.", true);
  change({ do: "add form", kind, form, values: chosen.values.map(String) }, () => choose(null));
}
