// Mouse, fingers and keys on the picture.
import { pan, size, toMap, zoom } from "./camera.js";
import { byId, typeName } from "./elements.js";
import { goTo } from "./game.js";
import { draw, fitAll, movable, pending } from "./plan.js";
import { all, change, isFixed, look, say, select, selected, state } from "./state.js";

const plan = byId("plan");
const STILL = 6; // pixels that a click may move
const pointers = new Map();
let gesture = null; // { kind: "tap" | "drag" | "pan" | "way" | "pinch", … }

export function tool() {
  return document.querySelector("input[name=tool]:checked").value;
}

function target(event) {
  const element = document.elementFromPoint(event.clientX, event.clientY);
  return hitBy(element && element.closest("#plan .place, #plan .way, #plan .spot, #plan .row"));
}

function hitBy(element) {
  if (element && element.dataset.kind) return { kind: element.dataset.kind, key: element.dataset.name };
  return element && { kind: ["place", "spot"].find((one) => element.classList.contains(one)) || "way", key: element.dataset.key };
}

// A spot is at a place: for all but moving it, that is meant.
const placeOf = (hit) => (hit && hit.kind === "spot" ? { kind: "place", key: hit.key.split(" ")[0] } : hit);

// Writes that a place or a spot is elsewhere.
function moveTo({ kind, key }, x, y) {
  const [name, robot] = key.split(" ");
  change(kind === "place" ? { do: "move place", name, x, y } : { do: "move spot", name, robot, x, y });
}

const rounded = (metres) => Math.round(metres * 100) / 100;

// What tools do ----------------------------------------------------------------------------------------------------

// A finger does not want a keyboard.
const named = (byFinger) => (byFinger ? null : typeName);

function use(found, point, byFinger) {
  const hit = placeOf(found);
  const name = hit && hit.kind === "place" ? hit.key : null;
  if (tool() === "select" && name && state.playing && goTo(name)) return;
  if (tool() === "place" && !name) {
    change({ do: "add place", x: rounded(point.x), y: rounded(point.y) }, named(byFinger));
  } else if (tool() === "agent") {
    if (name) change({ do: "add agent", location: name }, named(byFinger));
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
    const there = state.view.ways.some((one) => (one.a === from && one.b === name) || (one.b === from && one.a === name));
    const told = () => say("There is a way already. Under it you can choose who takes another one, of another length.");
    change({ do: "connect", a: from, b: name }, there ? told : null);
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

// What was a click becomes a drag: of a place or a spot, which was perhaps not grasped in its middle, of a way, or of
// the ground.
function begin(drag) {
  const thing = drag.hit && movable(drag.hit);
  drag.kind = thing && tool() === "way" ? "way" : thing && tool() === "select" ? "drag" : "pan";
  if (drag.kind === "drag" && isFixed(thing)) drag.kind = "done";
  if (drag.kind !== "drag") return;
  const grasped = toMap(drag.x, drag.y);
  drag.beside = { x: thing.x - grasped.x, y: thing.y - grasped.y };
}

// Where that is what is dragged.
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
  if (gesture.kind === "drag") {
    const thing = movable(gesture.hit);
    if (thing) Object.assign(thing, dragged(gesture, event));
  } else if (gesture.kind === "way") {
    pending.from = placeOf(gesture.hit).key;
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
  } else if (ended.kind === "drag") {
    const { x, y } = dragged(ended, event);
    moveTo(ended.hit, x, y);
  } else if (ended.kind === "way") {
    const hit = placeOf(target(event));
    stepOfWay(hit && hit.kind === "place" ? hit.key : null);
  }
}

// Keys -------------------------------------------------------------------------------------------------------------

const ARROWS = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };
let moved = null; // a place or a spot that arrows have moved, and the timer after which that is written

function moveBy(hit, [dx, dy], step) {
  const thing = movable(hit);
  if (!thing || isFixed(thing)) return;
  if (moved && moved.hit.key !== hit.key) writeMove();
  thing.x = rounded(thing.x + dx * step);
  thing.y = rounded(thing.y + dy * step);
  if (moved) clearTimeout(moved.timer);
  moved = { hit, x: thing.x, y: thing.y, timer: setTimeout(writeMove, 300) };
  draw();
}

function writeMove() {
  if (!moved) return;
  clearTimeout(moved.timer);
  const { hit, x, y } = moved;
  moved = null;
  moveTo(hit, x, y);
}

function pressed(event) {
  const hit = hitBy(event.target.closest("#plan .place, #plan .way, #plan .spot"));
  const arrow = ARROWS[event.key];
  if (arrow && !event.ctrlKey && !event.altKey) {
    if (hit && movable(hit)) moveBy(hit, arrow, event.shiftKey ? 1 : 0.1);
    else pan(-40 * arrow[0], 40 * arrow[1]);
    draw();
  } else if (event.key === "Enter" || event.key === " ") {
    const { left, top, width, height } = size();
    use(hit, toMap(left + width / 2, top + height / 2), false);
    if (hit && tool() === "select") typeName();
  } else if (event.key === "Delete" || event.key === "Backspace") {
    const one = hit ? all(state.view).find((each) => each.kind === hit.kind && each.key === hit.key) : selected();
    if (one && !isFixed(one.thing)) change({ do: "delete", statement: one.thing.statement }, () => plan.focus({ preventScroll: true }));
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
