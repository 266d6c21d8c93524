"use strict";
// A mission on the map: moves the marks to where everybody was at the chosen moment.
for (const source of document.querySelectorAll("script[type='application/json'][id$='-movements']")) {
  const ident = source.id.slice(0, -"-movements".length);
  const data = JSON.parse(source.textContent);
  const at = (name) => document.getElementById(`${ident}-${name}`);
  const time = at("time"), play = at("play"), speed = at("speed"), lines = at("where").children;
  const marks = data.agents.map((agent, number) => at(`agent-${number}`));
  let now = 0, running = false, before = 0;

  const segmentAt = (segments) => {
    let found = segments[0];
    for (const segment of segments) if (segment[0] <= now) found = segment;
    return found;
  };
  const along = (line, share) => { // the point after so much of a line with bends
    const sizes = line.slice(1).map(([x, y], k) => Math.hypot(x - line[k][0], y - line[k][1]));
    let left = share * sizes.reduce((sum, size) => sum + size, 0);
    for (const [k, size] of sizes.entries()) {
      if (size > 0 && size >= left) return [0, 1].map((axis) => line[k][axis] + (left / size) * (line[k + 1][axis] - line[k][axis]));
      left -= size;
    }
    return line[line.length - 1];
  };
  const show = () => {
    data.agents.forEach((agent, number) => {
      const [start, end, line, description, busy] = segmentAt(agent.segments);
      const share = end > start ? Math.min(1, Math.max(0, (now - start) / (end - start))) : 1;
      const inner = line.length === 1 ? 0 : 0.8 * Math.min(1, 5 * Math.min(share, 1 - share)); // on the way: nearer to its line
      const [x, y] = along(line, share);
      const [atX, atY] = [x - inner * agent.offset[0], y - inner * agent.offset[1]];
      marks[number].setAttribute("transform", `translate(${atX.toFixed(1)} ${atY.toFixed(1)})`);
      marks[number].querySelector(".busy").setAttribute("visibility", busy ? "visible" : "hidden");
      lines[number].querySelector("span").textContent = description;
    });
    let step = data.steps[0];
    for (const one of data.steps) if (one[0] <= now) step = one;
    at("caption").textContent = `${shortly(step[0])}: ${step[1]}`;
    at("now").textContent = shortly(now);
    time.value = now;
    time.setAttribute("aria-valuetext", `${shortly(now)} ${data.unit}`);
  };
  const shortly = (value) => String(Math.round(value * 100) / 100);
  const go = (moment) => { now = Math.min(data.end, Math.max(0, moment)); show(); };
  const run = (wanted) => {
    running = wanted;
    play.textContent = running ? "❚❚ pause" : "▶ play";
    if (running) { before = performance.now(); requestAnimationFrame(frame); }
  };
  const frame = (moment) => {
    if (!running) return;
    go(now + Math.max(0, moment - before) / 1000 * Number(speed.value));
    before = moment;
    if (now >= data.end) run(false); else requestAnimationFrame(frame);
  };
  const moments = [...new Set([0, ...data.steps.map((step) => step[0]), data.end])].sort((a, b) => a - b);

  play.addEventListener("click", () => { if (!running && now >= data.end) go(0); run(!running); });
  time.addEventListener("input", () => { run(false); go(Number(time.value)); });
  at("on").addEventListener("click", () => { run(false); go(moments.find((m) => m > now + 1e-9) ?? data.end); });
  at("back").addEventListener("click", () => { run(false); go(moments.filter((m) => m < now - 1e-9).pop() ?? 0); });
  play.parentElement.hidden = false;
  show();
}
