"use strict";
// Who does what: a row for each agent. What robots and people do reads like an order, what others may do never does.

function setAgents() {
  widgets.rows.clear();
  $("agents").replaceChildren(...scene.agents.map((agent) => {
    const row = make("li", `agent-row ${agent.kind}`), line = make("div"), doing = make("span"), next = make("div", "next"), why = make("div", "why");
    const progress = make("progress");
    progress.max = 1;
    progress.setAttribute("aria-label", `progress of ${shown(agent.name)}`);
    line.append(make("span", `tag ${agent.kind}`, shown(agent.name)), " ", doing);
    row.append(line, progress, next, why);
    widgets.rows.set(agent.name, { row, doing, progress, next, why, kind: agent.kind });
    return row;
  }));
}

function showAgent(widget, agent, now) {
  const late = view.live && agent.high !== null && now > agent.high + LATE;
  widget.row.classList.toggle("lost", agent.lost);
  widget.row.classList.toggle("late", late);
  say(widget.doing, [agent.doing, ...agent.notes].join("; "));
  widget.progress.hidden = agent.since === null || !view.live;
  widget.progress.value = share(agent, now);
  say(widget.why, !view.live ? "" : widget.kind === "agent" ? answers(agent, now) : whyAndThen(agent, now));
  say(widget.next, !view.live ? "" : agent.awaited ? ending(widget, agent, now, late) : widget.kind === "agent" ? mayDo(agent, now) : "");
}

function whyAndThen(agent, now) { // only what the strategy says; nothing where it is not known here
  const parts = [agent.why].filter((text) => text);
  if (agent.then) parts.push(`${agent.awaited ? "then" : "next"}: ${agent.then.does}${due(agent.then, now)}`);
  else if (view.planned && view.status === "running" && !agent.awaited && !agent.lost && !isOut(agent.name) && !parts.length) parts.push("waits: nothing is planned for it until something else happens");
  return parts.join("; ");
}

function answers(agent, now) { // what the strategy does if it begins that, where that is something else than now
  const found = agent.next.filter(({ answer, closes }) => answer && (closes === null || now <= closes));
  return found.slice(0, 3).map(({ may, answer }) => `should it ${may}: ${answer}`).join("; ");
}

function due({ at, certain }, now) { // what waits for an end comes later, nobody knows by how much
  if (at > now + MARGIN) return ` in ${units(at - now)}${certain ? "" : " at the earliest"}`;
  return certain ? " now" : "";
}

const LATE = 0.2; // time units after its window at which an end is late: the observer allows for a little, too

function ending(widget, agent, now, late) { // when what it does ends
  const what = `${widget.kind === "agent" ? "may" : "is to"} ${agent.awaited}`;
  if (agent.low === null) return what;
  if (late) return `${what}: ${units(now - agent.high)} late`;
  if (now < agent.low) return `${what} in ${units(agent.low - now)}${agent.high === null ? "" : ` to ${units(agent.high - now)}`}`;
  return agent.high === null ? `${what} from now on` : `${what} now, at the latest in ${units(agent.high - now)}`;
}

function mayDo(agent, now) { // what it may begin, those with the same moment together
  const moments = new Map();
  for (const { may, opens, closes } of agent.next) {
    if (closes !== null && now > closes) continue;
    const when = opens <= now + MARGIN ? "now" : `in ${units(opens - now)}`;
    moments.set(when, [...(moments.get(when) || []), may]);
  }
  const parts = [...moments].map(([when, whats]) => `may ${whats.slice(0, 4).join(" or ")}${whats.length > 4 ? " …" : ""} ${when}`);
  return parts.slice(0, 3).join("; ");
}
