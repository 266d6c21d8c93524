// A game of the scenario: what a person does, what follows, and where everybody is then, in the picture.
import { button, byId } from "./elements.js";
import { ask, refusal, say, show, state } from "./state.js";

let job = 0; // the number of the game's job; 0: none is under way
let turn = 0; // how much of it is shown

export async function play() {
  const answer = await ask("play", { text: state.text });
  if (answer.refused) return say(refusal(answer), true);
  job = answer.job;
  turn = 0;
  byId("game").hidden = false;
  byId("game-lines").textContent = "";
  byId("choices").replaceChildren();
  byId("parts").scrollTop = 0;
  take(answer);
}

export function endGame() {
  job = 0;
  state.playing = null;
  state.leads = [];
  byId("game").hidden = true;
  show();
}

async function end() {
  endGame();
  await ask("cancel");
}

async function send(line) {
  if (!job) return;
  write(`> ${line}`);
  take(await ask("say", { line }));
}

function write(text) {
  const lines = byId("game-lines");
  lines.textContent += `${text}\n`;
  lines.scrollTop = lines.scrollHeight;
}

// Shows what has come, and asks again until the game has answered.
function take(answer) {
  if (!job || (answer.job !== undefined && answer.job !== job)) return;
  if (answer.refused) return write(refusal(answer));
  if (answer.verdict) {
    byId("game-state").textContent = "There is no game.";
    return answer.lines.forEach(write);
  }
  const game = answer.game;
  if (game && game.turn > turn) {
    turn = game.turn;
    byId("game-state").textContent = "";
    write(game.lines.join("\n"));
    byId("choices").replaceChildren(...game.choices.map(choice));
    state.playing = game.at;
    state.leads = game.to;
    return show();
  }
  if (answer.state !== "running") return write("The game has ended.");
  if (!game) byId("game-state").textContent = `${answer.progress || "solving"} … ${answer.seconds} s`;
  setTimeout(async () => take(await ask("job")), 150);
}

// A place was pressed on the plan: whoever can set off to it does. False where nobody can.
export function goTo(place) {
  const numbers = state.leads.flatMap((to, number) => (to === place ? [number + 1] : []));
  if (numbers.length === 1) send(String(numbers[0]));
  else if (numbers.length) say("Several can go there: choose who, beside the plan.");
  return numbers.length > 0;
}

function choice([what, when], number) {
  return button(`${what}, ${when}`, () => send(String(number + 1)));
}

export function listen() {
  for (const one of document.querySelectorAll("button[data-line]")) {
    one.addEventListener("click", () => send(one.dataset.line));
  }
  byId("game-form").addEventListener("submit", (event) => {
    event.preventDefault();
    const line = byId("line").value.trim();
    byId("line").value = "";
    if (line) send(line);
  });
  byId("end").addEventListener("click", end);
}
