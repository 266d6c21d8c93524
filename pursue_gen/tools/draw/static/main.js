// Begins with what the server has, and connects the parts of the page.
import * as editor from "./editor.js";
import { byId } from "./elements.js";
import * as game from "./game.js";
import { greet, guide } from "./guide.js";
import { inspect } from "./inspector.js";
import { list } from "./lists.js";
import { measure } from "./measure.js";
import { draw } from "./plan.js";
import * as pointer from "./pointer.js";
import { ask, change, onShow, redo, refusal, say, selected, show, state, undo } from "./state.js";
import { cancel, outdated, read, solve } from "./verdict.js";

let revealed = null;

function follow() {
  byId("undo").disabled = !state.past.length;
  byId("redo").disabled = !state.future.length;
  byId("note").hidden = !state.view.computed;
  byId("file").textContent = `${state.opened.file}${state.text === state.saved ? "" : " *"}`;
  const one = selected();
  const key = one && `${one.kind} ${one.key}`;
  if (one && key !== revealed) editor.reveal(one.thing);
  revealed = key;
  outdated();
}

async function save(overwrite) {
  const text = state.text;
  const answer = await ask("save", { text, overwrite, version: state.opened.version });
  if (answer.code === "DRW003") {
    byId("changed-text").textContent = refusal(answer);
    byId("changed").showModal();
  } else if (answer.refused) {
    say(refusal(answer), true);
  } else {
    state.saved = text;
    state.opened.version = answer.version;
    say(`Saved: ${answer.saved}`);
    follow();
  }
}

function shortcuts(event) {
  if (!(event.ctrlKey || event.metaKey) || event.altKey) return;
  const key = event.key.toLowerCase();
  if (key === "z" || key === "y") (key === "y" || event.shiftKey ? redo : undo)();
  else if (key === "s") save(false);
  else return;
  event.preventDefault();
}

function press(id, action) {
  byId(id).addEventListener("click", action);
}

async function begin() {
  const opened = await ask("open");
  if (opened.refused) return say(refusal(opened), true);
  const { text, view } = opened;
  Object.assign(state, { opened, text, view, viewed: text, saved: opened.new ? null : text });
  document.title = `Draw ${opened.file}`;
  for (const listener of [draw, inspect, list, editor.write, guide, follow]) onShow(listener);
  pointer.listen();
  editor.listen();
  game.listen();
  press("undo", undo);
  press("redo", redo);
  press("save", () => save(false));
  press("solve", solve);
  press("play", game.play);
  press("cancel", cancel);
  press("read", read);
  press("unread", () => byId("reading").close());
  press("measure", measure);
  byId("measuring").hidden = opened.floor === null;
  press("format", () => change({ do: "format" }));
  press("overwrite", () => { byId("changed").close(); save(true); });
  press("keep", () => byId("changed").close());
  document.addEventListener("keydown", shortcuts);
  window.addEventListener("beforeunload", (event) => {
    if (state.text !== (state.saved || "")) event.preventDefault();
  });
  new ResizeObserver(([{ target }]) => document.documentElement.style.setProperty("--header", `${target.offsetHeight}px`)).observe(document.querySelector("header"));
  show();
  greet();
  document.body.dataset.ready = "yes";
}

begin();
