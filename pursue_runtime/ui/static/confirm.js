"use strict";
// What cannot be taken back is confirmed: a stop, and the report of an end for which it is too early by the model.

const STOP_TEXT = "Stop the mission? Robots get no further goals, and every node ends.";
const FINISH_TEXT = "Finish the mission? What is due is answered first. Then all was kept, robots are left standing, and every node ends.";
let sure = null; // what is done once it is confirmed

function confirmed(text, yes, no, act, calm = false) {
  if (!$("sure").showModal) {
    if (window.confirm(text)) act();
    return;
  }
  say($("sure-text"), text);
  say($("stop-yes"), yes);
  say($("stop-no"), no);
  $("stop-yes").classList.toggle("calm", calm);
  sure = act;
  $("sure").showModal();
}

function isEarly(task, now) { // the model does not have it end yet; a robot that is held may go on at any time
  return task !== undefined && task.label !== "Resume" && task.low !== null && now < task.low - MARGIN;
}

function earlyText(task, now) {
  return `${shown(task.agent)}: ${task.text}. By the model this ends in ${units(task.low - now)} ${scene.counts} at the earliest. `
    + "Has it ended? A report cannot be taken back.";
}

onPress($("stop"), () => confirmed(STOP_TEXT, "Stop it", "Go on", () => ask({ do: "stop" })));
onPress($("finish"), () => confirmed(FINISH_TEXT, "Finish it", "Go on", () => ask({ do: "finish" }), true));
onPress($("stop-yes"), () => {
  const act = sure;
  sure = null;
  $("sure").close();
  if (act) act();
});
onPress($("stop-no"), () => $("sure").close());
