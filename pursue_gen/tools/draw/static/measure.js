// Measuring the ways on the map: the text gets what was measured, as one change that Undo takes back.
import { byId } from "./elements.js";
import { ask, refusal, replace, say, state } from "./state.js";

let mine = 0; // the number of the job that measures

export async function measure() {
  const text = state.text;
  const [radius, speed] = ["radius", "speed"].map((id) => byId(id).value.trim() ? Number(byId(id).value) : null);
  const settings = { radius, speed, ways: byId("add-ways").checked };
  const answer = await ask("survey", { text, ...settings });
  mine = answer.job;
  take(answer, text);
}

function take(answer, text) {
  if (answer.refused) return say(refusal(answer), true);
  if (answer.job !== mine) return say("Measuring was ended.", true);
  if (answer.verdict) {
    say(answer.surveyed ? "Measured." : "The ways cannot be measured yet.", !answer.surveyed);
    byId("measured").hidden = false;
    byId("measured").textContent = answer.lines.join("\n");
    if (!answer.surveyed) return;
    state.paths = answer.paths;
    if (state.text === text) replace(answer.surveyed);
    else say("The text was changed meanwhile: measure again.", true);
  } else if (answer.state === "running") {
    say(`measuring … ${answer.seconds} s`);
    setTimeout(async () => take(await ask("job"), text), 300);
  }
}
