"use strict";
// What comes after the mission: how it is replayed, the next one, the end of the page. And the missions played before.

let missions = []; // what the UI has found, the newest first

function setMissions(found) {
  missions = found;
  $("missions").hidden = missions.length === 0;
  $("missions-count").textContent = `Missions played here (${missions.length})`;
  $("missions-list").replaceChildren(...missions.map(missionRow));
  showAfter();
}

function missionRow(mission) {
  const row = make("li", "mission"), line = make("p"), result = make("strong", "result", mission.result);
  result.dataset.is = mission.result;
  line.append(result, ` ${dayTime(1000 * mission.began)}`);
  if (mission.units !== null) line.append(`, ${units(mission.units)} ${scene.counts}`);
  if (mission.present) line.append(", this mission");
  row.append(line);
  if (mission.why) row.append(make("p", "why", mission.why));
  row.append(...replayLines(mission));
  return row;
}

function replayLines(mission) {
  const files = make("p", "files", `Recorded: ${mission.files.join(", ") || "its journal, which is being closed"}`);
  if (!mission.replay) return [files];
  const replay = make("p", "replay", "Replay: ");
  replay.append(make("code", "", mission.replay));
  return [files, replay];
}

const two = (number) => String(number).padStart(2, "0");
function dayTime(moment) { // the day and the time, by this browser's clock
  const day = new Date(moment);
  return `${day.getFullYear()}-${two(day.getMonth() + 1)}-${two(day.getDate())} ${clockTime(moment)}`;
}

function showAfter() { // what can be done when the mission has ended
  const over = Boolean(view && view.verdict && view.stays);
  $("after").hidden = !over;
  if (!over) return;
  const offers = isConnected() ? view.offers : [], present = missions.find((mission) => mission.present);
  enable($("another"), offers.includes("next"));
  enable($("close"), offers.includes("close"));
  $("close").hidden = !view.offers.includes("close");
  const places = view.agents.filter((agent) => isRobot(agent.name)).map((agent) => `${shown(agent.name)} at ${shown(scene.start[agent.name])}`);
  const ready = offers.includes("next") ? "Another mission can be prepared." : "The nodes are not ready for another mission.";
  const begin = places.length ? ` It begins with ${places.join(", ")}: bring real robots there before it is started.` : "";
  say($("after-text"), ready + (offers.includes("next") ? begin : ""));
  const key = present ? JSON.stringify(present) : "";
  if ($("recorded").dataset.of !== key) {
    $("recorded").dataset.of = key;
    $("recorded").replaceChildren(...(present ? replayLines(present) : [make("p", "", "No recording or journal of it was found on this machine.")]));
  }
}

const isRobot = (name) => scene.agents.some((agent) => agent.name === name && agent.kind === "robot");

onPress($("another"), () => ask({ do: "next" }));
onPress($("close"), () => { if ($("closing").showModal) $("closing").showModal(); });
onPress($("close-yes"), () => { $("closing").close(); ask({ do: "close" }); });
onPress($("close-no"), () => $("closing").close());
