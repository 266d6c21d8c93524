// Solving: how far it is, the verdict, and the report.
import { byId, html } from "./elements.js";
import { endGame } from "./game.js";
import { ask, refusal, say, state } from "./state.js";

const OUTCOMES = {
  won: "Won: it can be met, whatever the others do. The strategy is proven.",
  lost: "Lost: it cannot be met.",
  undecided: "Not decided.",
  errors: "The text has errors.",
};
let solved = null; // the text that the verdict is about
let mine = 0; // the number of the last job that solved
let shown = 0; // the job whose report is shown

export function outdated() {
  const old = solved !== null && solved !== state.text;
  byId("outdated").hidden = !old;
  byId("outcome").classList.toggle("old", old);
}

// Is what is wanted said with a verdict on the present text?
export function isCurrent() {
  return solved === state.text && byId("sentences").childElementCount > 0;
}

export function read() {
  byId("reading").showModal();
}

export async function solve() {
  endGame();
  solved = state.text;
  byId("verdict").hidden = false;
  byId("read").hidden = true;
  byId("report").removeAttribute("src");
  outdated();
  const answer = await ask("solve", { text: solved });
  mine = answer.job;
  report(answer);
}

export async function cancel() {
  report(await ask("cancel"));
}

// Something else was begun meanwhile: what is known by then stays.
function giveUp() {
  const outcome = byId("outcome");
  byId("cancel").hidden = true;
  outcome.textContent = OUTCOMES[outcome.dataset.verdict] || "Cancelled.";
}

function report(answer) {
  if (answer.refused) return say(refusal(answer), true);
  if (answer.job !== mine) return giveUp();
  const running = answer.state === "running";
  byId("cancel").hidden = !running;
  const going = running ? `${answer.progress || "solving"} … ${answer.seconds} s` : "";
  const outcome = answer.verdict ? OUTCOMES[answer.verdict] : answer.state === "cancelled" ? "Cancelled." : "";
  byId("outcome").textContent = [outcome, going].filter(Boolean).join(" ");
  byId("outcome").dataset.verdict = answer.verdict || (running ? "" : answer.state);
  byId("wanted").hidden = (answer.lines || []).length > 0 || !state.view.wanted.length;
  byId("sentences").replaceChildren(...(answer.lines || []).map((line) => html("li", {}, line)));
  if (answer.report && shown !== answer.job) {
    shown = answer.job;
    byId("report").src = `report.html?job=${answer.job}`;
    byId("read").hidden = false;
  }
  if (running) setTimeout(async () => report(await ask("job")), 300);
}
