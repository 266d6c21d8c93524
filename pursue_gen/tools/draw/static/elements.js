// Elements of the page. Whatever comes from a scenario becomes text, never markup.

const SVG = "http://www.w3.org/2000/svg";

function filled(element, attributes, children) {
  for (const [name, value] of Object.entries(attributes)) {
    if (name.startsWith("on")) element.addEventListener(name.slice(2), value);
    else if (value === true) element.setAttribute(name, "");
    else if (value !== false && value !== null && value !== undefined) element.setAttribute(name, value);
  }
  element.append(...children.filter((child) => child !== null));
  return element;
}

export function html(name, attributes = {}, ...children) {
  return filled(document.createElement(name), attributes, children);
}

export function svg(name, attributes = {}, ...children) {
  return filled(document.createElementNS(SVG, name), attributes, children);
}

export function byId(id) {
  return document.getElementById(id);
}

// Puts the cursor into the name of what was added, so that it can be typed.
export function typeName() {
  const name = byId("field-name");
  if (!name) return;
  name.focus();
  name.select();
}

// What people read for a place, an event or an agent.
export function shown(thing) {
  return thing.label || thing.name;
}

// For whom a way is, behind its length.
export function whom(way) {
  return way.only_for ? ` for ${way.only_for}` : way.not_for ? ` except ${way.not_for}` : "";
}

// A labelled field for a form; `change` gets the new value when it has been typed or chosen.
export function field(id, label, value, change, more = {}) {
  const { options, wide, ...attributes } = more;
  let input;
  if (options) {
    input = html("select", { id, onchange: () => change(input.value), ...attributes });
    for (const [key, words] of options) input.append(html("option", { value: key, selected: key === value }, words));
  } else {
    input = html("input", { id, value, autocomplete: "off", onchange: () => change(input.value), ...attributes });
  }
  return html("label", wide ? { class: "wide" } : {}, label, input);
}

export function tick(id, label, checked, change) {
  const input = html("input", { id, type: "checkbox", checked, onchange: () => change(input.checked) });
  return html("label", {}, input, ` ${label}`);
}

export function button(label, press, attributes = {}) {
  return html("button", { type: "button", onclick: press, ...attributes }, label);
}
