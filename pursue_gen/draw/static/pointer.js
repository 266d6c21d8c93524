// Mouse, fingers and keys on the picture.
import { pan, size, toMap, zoom } from "./camera.js";
import { byId } from "./elements.js";
import { draw, fitAll, pending, placeNamed } from "./plan.js";
import { all, change, look, say, select, selected, state } from "./state.js";

const plan = byId("plan");
const STILL = 6; // pixels that a click may move
const pointers = new Map();
let gesture = null; // { kind: "tap" | "place" | "pan" | "way" | "pinch", … }

export function tool() {
  return document.querySelector("input[name=tool]:checked").value;
}

function target(event) {
  const element = document.elementFromPoint(event.clientX, event.clientY);
  const found = element && element.closest("#plan .place, #plan .way, #plan .row");
  if (found && found.dataset.kind) return { kind: found.dataset.kind, key: found.dataset.name };
  return found && { kind: found.classList.contains("place") ? "place" : "way", key: found.dataset.key };
}

const rounded = (metres) => Math.round(metres * 100) / 100;

// What tools do ----------------------------------------------------------------------------------------------------

// Puts the cursor into the name of what was added, so that it can be typed; a finger does not want a keyboard.
function typeName(byFinger) {
  return () => {
    const name = byId("field-name");
    if (name && !byFinger) {
      name.focus();
      name.select();
    }
  };
}

function use(hit, point, byFinger) {
  const name = hit && hit.kind === "place" ? hit.key : null;
  if (tool() === "place" && !name) {
    change({ do: "add place", x: rounded(point.x), y: rounded(point.y) }, typeName(byFinger));
  } else if (tool() === "agent") {
    if (name) change({ do: "add agent", location: name }, typeName(byFinger));
    else say("Click on the place where the agent starts.");
  } else if (tool() === "way" && (!hit || name)) {
    stepOfWay(name);
  } else {
    select(hit && all(state.view).find((one) => one.kind === hit.kind && one.key === hit.key));
  }
}

function stepOfWay(name) {
  const from = pending.from;
  pending.from = null;
  pending.to = null;
  if (!name) say("Click on a place, then on the place that the way leads to.");
  else if (from === null) {
    pending.from = name;
    say(`A way from ${name}: click on the place that it leads to. Escape ends it.`);
  } else if (from !== name) {
    change({ do: "connect", a: from, b: name });
  }
  draw();
}

// Pointers ---------------------------------------------------------------------------------------------------------

function two() {
  const [a, b] = [...pointers.values()];
  return { x: (a.x + b.x) / 2, y: (a.y + b.y) / 2, apart: Math.hypot(a.x - b.x, a.y - b.y) || 1 };
}

function down(event) {
  if (event.button > 0) return;
  plan.setPointerCapture(event.pointerId);
  pointers.set(event.pointerId, { x: event.clientX, y: event.clientY });
  if (pointers.size === 2) gesture = { kind: "pinch", ...two() };
  else if (pointers.size === 1) {
    gesture = { kind: "tap", hit: target(event), x: event.clientX, y: event.clientY, lastX: event.clientX, lastY: event.clientY };
  }
}

// What was a click becomes a drag: of a place, which was perhaps not grasped in its middle, of a way, or of the ground.
function begin(drag) {
  const place = drag.hit && drag.hit.kind === "place" && placeNamed(drag.hit.key);
  drag.kind = place && tool() === "way" ? "way" : place && tool() === "select" ? "place" : "pan";
  if (drag.kind !== "place") return;
  const grasped = toMap(drag.x, drag.y);
  drag.beside = { x: place.x - grasped.x, y: place.y - grasped.y };
}

// Where a place is that is dragged.
function dragged(drag, event) {
  const { x, y } = toMap(event.clientX, event.clientY);
  return { x: rounded(x + drag.beside.x), y: rounded(y + drag.beside.y) };
}

function move(event) {
  if (!pointers.has(event.pointerId)) {
    if (pending.from !== null) {
      pending.to = { x: event.clientX, y: event.clientY };
      draw();
    }
    return;
  }
  pointers.set(event.pointerId, { x: event.clientX, y: event.clientY });
  if (gesture.kind === "pinch") return pinch();
  const far = Math.hypot(event.clientX - gesture.x, event.clientY - gesture.y) > STILL;
  if (gesture.kind === "tap" && far) begin(gesture);
  if (gesture.kind === "tap" || gesture.kind === "done") return;
  if (gesture.kind === "place") {
    const place = placeNamed(gesture.hit.key);
    if (place) Object.assign(place, dragged(gesture, event));
  } else if (gesture.kind === "way") {
    pending.from = gesture.hit.key;
    pending.to = { x: event.clientX, y: event.clientY };
  } else {
    pan(event.clientX - gesture.lastX, event.clientY - gesture.lastY);
  }
  gesture.lastX = event.clientX;
  gesture.lastY = event.clientY;
  draw();
}

function pinch() {
  if (pointers.size < 2) return;
  const now = two();
  pan(now.x - gesture.x, now.y - gesture.y);
  zoom(now.apart / gesture.apart, now.x, now.y);
  Object.assign(gesture, now);
  draw();
}

function up(event) {
  if (!pointers.delete(event.pointerId)) return;
  const ended = gesture;
  gesture = pointers.size ? { kind: "done" } : null;
  if (event.type === "pointercancel") {
    pending.from = null;
    pending.to = null;
    look(); // what was dragged goes back
  } else if (ended.kind === "tap") {
    use(ended.hit, toMap(event.clientX, event.clientY), event.pointerType === "touch");
  } else if (ended.kind === "place") {
    change({ do: "move place", name: ended.hit.key, ...dragged(ended, event) });
  } else if (ended.kind === "way") {
    const hit = target(event);
    stepOfWay(hit && hit.kind === "place" ? hit.key : null);
  }
}

// Keys -------------------------------------------------------------------------------------------------------------

const ARROWS = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };
let moved = null; // a place that arrows have moved, and the timer after which that is written

function moveBy(key, [dx, dy], step) {
  const place = placeNamed(key);
  if (!place) return;
  if (moved && moved.key !== key) writeMove();
  place.x = rounded(place.x + dx * step);
  place.y = rounded(place.y + dy * step);
  if (moved) clearTimeout(moved.timer);
  moved = { key, x: place.x, y: place.y, timer: setTimeout(writeMove, 300) };
  draw();
}

function writeMove() {
  if (!moved) return;
  clearTimeout(moved.timer);
  const { key, x, y } = moved;
  moved = null;
  change({ do: "move place", name: key, x, y });
}

function pressed(event) {
  const focused = event.target.closest(".place, .way");
  const hit = focused && { kind: focused.classList.contains("place") ? "place" : "way", key: focused.dataset.key };
  const arrow = ARROWS[event.key];
  if (arrow && !event.ctrlKey && !event.altKey) {
    if (hit && hit.kind === "place") moveBy(hit.key, arrow, event.shiftKey ? 1 : 0.1);
    else pan(-40 * arrow[0], 40 * arrow[1]);
    draw();
  } else if (event.key === "Enter" || event.key === " ") {
    const { left, top, width, height } = size();
    use(hit, toMap(left + width / 2, top + height / 2), false);
    if (hit && tool() === "select") typeName(false)();
  } else if (event.key === "Delete" || event.key === "Backspace") {
    const one = hit ? all(state.view).find((each) => each.kind === hit.kind && each.key === hit.key) : selected();
    if (one) change({ do: "delete", statement: one.thing.statement }, () => plan.focus({ preventScroll: true }));
  } else if (event.key === "Escape") {
    pending.from = null;
    pending.to = null;
    select(null);
  } else if (event.key === "+" || event.key === "-") {
    nearer(event.key === "+" ? 1.25 : 0.8);
  } else {
    return;
  }
  event.preventDefault();
}

function nearer(factor) {
  const { left, top, width, height } = size();
  zoom(factor, left + width / 2, top + height / 2);
  draw();
}

export function listen() {
  plan.addEventListener("pointerdown", down);
  plan.addEventListener("pointermove", move);
  for (const end of ["pointerup", "pointercancel"]) plan.addEventListener(end, up);
  plan.addEventListener("keydown", pressed);
  plan.addEventListener(
    "wheel",
    (event) => {
      event.preventDefault();
      zoom(event.deltaY < 0 ? 1.15 : 1 / 1.15, event.clientX, event.clientY);
      draw();
    },
    { passive: false },
  );
  for (const input of document.querySelectorAll("input[name=tool]")) {
    input.addEventListener("change", () => {
      plan.setAttribute("class", tool());
      pending.from = null;
      draw();
    });
  }
  byId("zoom-in").addEventListener("click", () => nearer(1.4));
  byId("zoom-out").addEventListener("click", () => nearer(1 / 1.4));
  byId("zoom-fit").addEventListener("click", () => {
    fitAll();
    draw();
  });
  new ResizeObserver(() => state.view && draw()).observe(plan);
}
