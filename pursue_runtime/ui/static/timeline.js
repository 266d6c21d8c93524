"use strict";
// The timeline of a mission that has ended: a lane for each agent, and for each objective.

const LANE = 30; // pixels from one lane to the next
const LETTER = 7; // pixels of a letter, about
let drawn = ""; // what the picture shows

function showTimeline() {
  const lanes = view.lanes;
  $("timeline").hidden = !lanes;
  const width = $("lanes").clientWidth, key = lanes ? JSON.stringify([lanes, width]) : "";
  if (key === drawn || (lanes && !width)) return;
  drawn = key;
  $("lanes").replaceChildren();
  if (lanes) drawLanes(lanes, width);
}

function drawLanes({ begins, ends, lanes }, width) {
  const whole = lanes.map(({ agent, promise }) => (promise === undefined ? shown(agent) : promise)), names = whole.map(short);
  const left = Math.min(width / 3, 12 + (LETTER + 1.2) * Math.max(...names.map((name) => name.length)));
  const scale = (width - left - 24) / (ends - begins || 1), across = (moment) => left + scale * (moment - begins);
  const height = LANE * lanes.length + 24, picture = document.createElementNS(SVG, "svg");
  for (const [key, value] of Object.entries({ viewBox: `0 0 ${width} ${height}`, height, role: "img" })) picture.setAttribute(key, value);
  picture.setAttribute("aria-label", "Timeline; the list \"What happened\" says the same in words");
  $("lanes").replaceChildren(picture);
  lanes.forEach(({ segments }, row) => {
    const middle = LANE * row + LANE / 2;
    draw("text", picture, { class: "lane-name", x: 0, y: middle }).textContent = names[row];
    segments.forEach(([from, kind, text], number) => {
      const to = number + 1 < segments.length ? segments[number + 1][0] : ends;
      drawSegment(picture, `${whole[row]}: ${text}, ${units(from)} to ${units(to)}`, text, kind, across(from), across(to), middle);
    });
  });
  for (let part = 0; part <= 4; part += 1) {
    const moment = begins + (ends - begins) * part / 4;
    draw("text", picture, { class: "lane-time", x: across(moment), y: height - 10 }).textContent = units(moment);
  }
}

function drawSegment(picture, title, text, kind, from, to, middle) {
  const group = draw("g", picture, { class: `segment ${kind}` }), wide = Math.max(1, to - from);
  const high = kind === "stands" ? 4 : kind === "due" ? 12 : 22;
  draw("title", group).textContent = title;
  draw("rect", group, { x: from, y: middle - high / 2, width: wide, height: high });
  if (kind !== "stands" && kind !== "due" && LETTER * text.length + 6 < wide) draw("text", group, { x: from + wide / 2, y: middle }).textContent = text;
}

window.addEventListener("resize", () => { if (view) showTimeline(); });
