"use strict";
// What can be pressed: the ends that people report, and what those may do whom nobody controls.

const SETTLED = 300; // ms for which buttons that have just appeared or moved do nothing: the press was meant for what was there

function setTasks() {
  const reporters = scene.agents.filter((agent) => scene.reporters.includes(agent.name));
  widgets.tasks.clear();
  setTaskList("people", "tasks", reporters.filter((agent) => agent.kind === "human"));
  setTaskList("others", "ends", reporters.filter((agent) => agent.kind !== "human"));
}

function setTaskList(section, list, agents) {
  $(section).hidden = agents.length === 0;
  $(list).replaceChildren(...agents.map((agent) => {
    const row = make("li", "idle"), text = make("span", "task"), time = make("span", "task-time"), done = make("button", "done", "Done");
    done.type = "button";
    if (agent.kind === "human") text.setAttribute("aria-live", "assertive"); // the text alone: times change all the while
    const idle = agent.kind === "human" ? "nothing to do now" : "not under way";
    const task = { row, text, time, done, idle, word: "", pressed: "" };
    onPress(done, () => {
      const now = present(), given = view.tasks.find((each) => each.agent === agent.name), message = { do: "done", word: task.word, seq: view.seq };
      const report = () => {
        ask(message);
        task.pressed = message.word; // a second press would mean what comes next
        setTimeout(() => { task.pressed = ""; refresh(); }, 2000);
        refresh();
      };
      if (isEarly(given, now)) confirmed(earlyText(given, now), "It has ended", "Not yet", report);
      else report();
    });
    row.append(text, time, done);
    widgets.tasks.set(agent.name, task);
    return row;
  }));
}

function setButtons() { // only those are shown that are possible where their agent is
  const groups = new Map();
  widgets.buttons.clear();
  for (const { agent, word, label } of scene.buttons) {
    if (!groups.has(agent)) {
      const group = make("div", "group"), inside = make("div"), none = make("p", "none", "nothing now");
      group.setAttribute("role", "group");
      group.setAttribute("aria-label", `${shown(agent)}: what it may do`);
      group.append(make("span", "tag agent", shown(agent)), inside);
      inside.append(none);
      groups.set(agent, { group, inside, none, words: [], there: "", top: 0, since: -Infinity });
    }
    const known = groups.get(agent), button = make("button"), time = make("small");
    button.type = "button";
    button.hidden = true;
    button.dataset.word = word;
    button.setAttribute("aria-disabled", "true");
    button.append(make("span", "", label), time);
    onPress(button, () => ask({ do: "say", word, seq: view.seq }));
    known.inside.append(button);
    known.words.push(word);
    widgets.buttons.set(word, { button, time, group: known });
  }
  widgets.groups = [...groups.values()];
  $("free").hidden = groups.size === 0;
  $("buttons").replaceChildren(...widgets.groups.map(({ group }) => group));
}

function showButtons(now, here) {
  for (const group of widgets.groups) {
    const there = group.words.filter((word) => view.open[word]).join(" ");
    if (there !== group.there) Object.assign(group, { there, since: performance.now() });
    group.none.hidden = there !== "";
    for (const word of group.words) widgets.buttons.get(word).button.hidden = !view.open[word];
  }
  for (const group of widgets.groups) {
    const top = group.group.offsetTop;
    if (top !== group.top) Object.assign(group, { top, since: performance.now() });
  }
  for (const [word, { button, time, group }] of widgets.buttons) {
    const [opens, closes] = view.open[word] || [Infinity, null];
    const possible = opens <= now + MARGIN && (closes === null || now <= closes);
    const settled = performance.now() - group.since >= SETTLED;
    enable(button, here && possible && settled);
    say(time, possible ? (closes === null ? "now" : `now, for ${units(closes - now)}`) : opens > now && opens < Infinity ? `in ${units(opens - now)}` : "");
  }
}

function showTask(widget, name, task, now, here) {
  widget.row.classList.toggle("idle", !task);
  widget.word = task ? task.word : "";
  say(widget.text, task ? `${shown(name)}: ${task.text}` : `${shown(name)}: ${widget.idle}`);
  say(widget.done, task ? task.label : widget.done.textContent);
  say(widget.time, task && task.low !== null ? `for ${units(now - task.since)}; planned ${units(task.low - task.since)} to ${units(task.high - task.since)}` : "");
  widget.done.setAttribute("aria-label", task ? `${task.label}: ${shown(name)}, ${task.text}` : widget.done.textContent);
  enable(widget.done, here && Boolean(task) && widget.pressed !== widget.word);
}
