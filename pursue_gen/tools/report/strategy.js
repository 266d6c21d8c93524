"use strict";
(() => {
  const book = JSON.parse(document.getElementById("strategy-data").textContent);
  const at = (id) => document.getElementById(`strategy-${id}`);
  const agents = [...book.automata.keys()].filter((k) => ["robot", "person", "other"].includes(book.automata[k].kind));
  const AT_ONCE = 20;

  const make = (tag, more, ...children) => {
    const element = Object.assign(document.createElement(tag), more);
    element.append(...children);
    return element;
  };
  const state = (n) => { const [places, values, wait, ours, others, goal, done] = book.states[n]; return { places, values, wait, ours, others, goal, done }; };
  const step = ([who, text, target, when]) => ({ who: book.automata[who].shown, number: who, text: book.texts[text], target, when });
  const said = (value) => value === 2 ? "not known" : value ? "true" : "false"; // what a state is
  const place = (k, p) => book.automata[k].places[p][0];
  // In stages a situation speaks of some only; the last place of the others stands for all.
  const free = (k, p) => book.parts.length > 0 && p === book.automata[k].places.length - 1;
  const where = (s) => {
    const seen = agents.filter((k) => !free(k, s.places[k]));
    const parts = seen.map((k) => `${book.automata[k].shown} ${place(k, s.places[k])}`);
    return [...parts, ...(seen.length < agents.length ? ["the others wherever they are"] : [])].join("; ");
  };
  const rest = (s) => [
    ...book.automata.map((a, k) => [a, k]).filter(([a, k]) => !agents.includes(k) && a.kind !== "states" && !free(k, s.places[k]))
      .map(([a, k]) => `${a.shown}: ${place(k, s.places[k])}`),
    ...book.variables.map((name, k) => `${name}: ${said(s.values[k])}`).filter((_, k) => s.values[k] >= 0)].join("; ");
  const changed = (s, t) => {
    const parts = [...s.places.keys()].filter((k) => s.places[k] !== t.places[k])
      .map((k) => `${book.automata[k].shown}${agents.includes(k) ? "" : ":"} ${place(k, t.places[k])}`);
    book.variables.forEach((name, k) => { if (s.values[k] !== t.values[k]) parts.push(`${name} is ${said(t.values[k])}`); });
    return parts.join("; ") || "nothing has changed";
  };
  const times = (zones) => {
    const parts = [];
    zones.forEach((z, k) => {
      const [words, exact] = book.zones[z];
      parts.push(k ? "; or " : "", words, ...(exact === "always" ? [] : [" ", make("code", {}, exact)]));
    });
    return parts;
  };
  const owners = (k) => (book.controllers[book.automata[k].name] || []).join(", ");

  // A situation: closed, one line; opened, what is done in it, what is waited for, and where that leads.
  const card = (n, before) => {
    const s = state(n);
    const summary = before === undefined ? where(s) : changed(state(before), s);
    const box = make("details", { className: "state" }, make("summary", {}, `#${n}  ${summary}`));
    box.dataset.state = n;
    box.addEventListener("toggle", () => { if (box.open && !box.dataset.full) { box.dataset.full = 1; box.append(...inside(n, before)); } });
    return box;
  };
  const inside = (n, before) => {
    const s = state(n);
    const parts = [];
    if (before !== undefined) parts.push(make("p", { className: "kind" }, where(s)));
    if (rest(s)) parts.push(make("p", { className: "kind" }, rest(s)));
    if (s.goal) return [...parts, make("p", { className: "goal" }, "The goal is reached.")];
    if (s.done) return [...parts, make("p", { className: "goal" }, book.ordered ? "That was its last step."
      : "This part is done; the next stage begins when all parts of this one are.")];
    const list = make("ul");
    s.ours.map(step).forEach((c) => list.append(make("li", {}, order(c), card(c.target, n))));
    if (s.wait.length || !s.ours.length) list.append(make("li", {}, waiting(s)));
    parts.push(make("p", { className: "kind" }, "What is commanded"), list);
    if (s.others.length) {
      const may = make("ul");
      s.others.map(step).forEach((c) => may.append(make("li", {}, make("span", { className: "others" }),
        make("span", { className: "who" }, c.who), ` ${c.text}`, card(c.target, n))));
      parts.push(make("p", { className: "kind" }, "What is waited for: each of these may happen"), may);
    }
    return parts;
  };
  const order = (c) => make("div", {}, make("span", { className: "ours" }), make("span", { className: "who" }, c.who),
    ` ${c.text}: `, ...times(c.when), ...(owners(c.number) ? [` (${owners(c.number)})`] : []));
  const waiting = (s) => make("div", {}, make("span", { className: "waits" }), "no command is due",
    ...(s.ours.length ? [": ", ...times(s.wait)] : []));

  // What a question says: of whom, and who is where. ---------------------------------------------------------------
  const SMALL = new Set(("a an the what will would does do is are be being who where how if when while once and or then that it " +
    "goes go going moves move walks walk drives drive on its way of gets get happens happen now must should can has have there " +
    "to towards toward into from leaves leave at in reaches reach arrives doing begins true false not").split(" "));
  const HOW = { to: "to", towards: "to", toward: "to", into: "to", from: "from", leaves: "from", leave: "from", at: "at", in: "at",
    reaches: "at", arrives: "at", doing: "doing", begins: "doing" };
  const fits = {
    to: (p, w) => p[0] === "way" && p[2] === w,
    from: (p, w) => p[0] === "way" && p[1] === w,
    at: (p, w) => (p[0] === "at" || p[0] === "doing") && p[1] === w,
    doing: (p, w) => p[0] === "doing" && p[2] === w,
    "": (p, w) => p.slice(1).includes(w),
  };
  const findName = (names, word) => {
    const exact = names.indexOf(word);
    return exact >= 0 ? exact : names.findIndex((name) => name.toLowerCase() === word.toLowerCase());
  };
  const understand = (question) => {
    const query = { of: new Set(), places: new Map(), values: new Map(), unknown: [] };
    const agentNames = agents.map((k) => book.automata[k].name);
    let who = null, how = "", hows = new Map(), value = null, or = false;
    for (const word of question.match(/[\p{L}\p{N}_]+/gu) || []) {
      const small = word.toLowerCase();
      const agent = findName(agentNames, word);
      if (agent >= 0) { who = agents[agent]; how = ""; query.of.add(who); continue; }
      const variable = findName(book.variables, word);
      if (variable >= 0) { value = variable; query.values.set(variable, 1); continue; }
      if (value !== null && (small === "false" || small === "not")) { query.values.set(value, 0); continue; }
      if (value !== null && small === "unknown") { query.values.set(value, 2); continue; }
      if (who !== null) {
        const all = book.automata[who].places.map((p) => p[1]);
        const name = all.flatMap((p) => p.slice(1)).find((one) => one === word) ||
          (SMALL.has(small) ? undefined : all.flatMap((p) => p.slice(1)).find((one) => one.toLowerCase() === small));
        const event = name && all.some((p) => p[0] === "doing" && p[2] === name);
        if (name && (how || !SMALL.has(small))) {
          const rule = event ? "doing" : how === "doing" ? "at" : how;
          let found = new Set([...all.keys()].filter((k) => fits[rule](all[k], name)));
          if (!found.size && rule) found = new Set([...all.keys()].filter((k) => fits[""](all[k], name)));
          const known = query.places.get(who);
          if (known) found = or ? new Set([...known, ...found]) : new Set([...found].filter((k) => known.has(k)));
          query.places.set(who, found);
          or = false;
          continue;
        }
      }
      if (small === "or") or = true;
      if (["if", "when", "while", "once", "and"].includes(small)) { who = null; how = ""; value = null; }
      if (HOW[small]) how = HOW[small];
      if (!SMALL.has(small)) query.unknown.push(word);
    }
    for (const k of query.places.keys()) query.of.delete(k);
    return query;
  };
  // A situation has to speak of one who is asked about.
  const matching = (query) => [...book.states.keys()].filter((n) => {
    const s = state(n);
    const asked = [...(query.of.size ? query.of : query.places.keys())];
    if (asked.length && asked.every((k) => free(k, s.places[k]))) return false;
    return [...query.places].every(([k, good]) => good.has(s.places[k]) || free(k, s.places[k])) &&
      [...query.values].every(([k, v]) => s.values[k] === v || s.values[k] < 0);
  });
  const repeated = (query) => {
    const parts = [...query.places].map(([k, good]) => `${book.automata[k].name} is ${[...good].map((p) => place(k, p)).join(" or ") || "nowhere"}`);
    query.values.forEach((v, k) => parts.push(`${book.variables[k]} is ${said(v)}`));
    return parts.join(" and ") || "anything";
  };

  // The answer: in few words for each agent that was asked about, then the situations. -------------------------------
  const answer = (query) => {
    const found = matching(query);
    const open = found.filter((n) => !state(n).goal && !state(n).done);
    const goals = found.filter((n) => state(n).goal).length;
    const out = at("found");
    out.replaceChildren();
    const box = make("div", { className: "strategy-answer" });
    if (query.unknown.length)
      box.append(make("p", {}, `Not understood: ${query.unknown.join(", ")}. Names are: ` +
        `${agents.map((k) => book.automata[k].name).join(", ")}; where they can be is listed under “Choose places”.`));
    box.append(make("p", {}, `${found.length} ${found.length === 1 ? "situation" : "situations"} of the strategy: ${repeated(query)}.` +
      (goals ? ` In ${goals} of them the goal is reached.` : "") +
      (found.length ? "" : " This never happens while the strategy is followed.")));
    for (const k of query.of) if (open.length) box.append(summed(k, open));
    out.append(box);
    let shown = 0;
    const more = make("button", { type: "button" }, "Show more");
    const show = () => {
      found.slice(shown, shown + AT_ONCE).forEach((n) => more.before(card(n)));
      shown += AT_ONCE;
      more.hidden = shown >= found.length;
      more.textContent = `Show more (${found.length - shown} left)`;
    };
    out.append(more);
    more.addEventListener("click", show);
    show();
    const first = out.querySelector(".state");
    if (first && found.length <= 3) first.open = true;
  };
  const summed = (k, found) => {
    const name = book.automata[k].name;
    const lines = new Map();
    const add = (rank, text, n, parts) => { if (!lines.has(text)) lines.set(text, { rank, parts, in: new Set() }); lines.get(text).in.add(n); };
    for (const n of found.filter((one) => !free(k, state(one).places[k]))) {
      const s = state(n);
      const own = s.ours.map(step).filter((c) => c.number === k);
      own.forEach((c) => add(0, `${c.text} ${c.when}`, n, [`${name} ${c.text}: `, ...times(c.when)]));
      const may = s.others.map(step).filter((c) => c.number === k);
      if (book.automata[k].kind === "other") may.forEach((c) => add(1, `may ${c.text}`, n, [`${name} may do this, nobody decides it: ${c.text}`]));
      else if (!own.length) add(2, `stay ${s.places[k]}`, n, [`${name} gets no command: it is ${place(k, s.places[k])}`]);
    }
    const all = [...lines.values()].sort((a, b) => a.rank - b.rank || b.in.size - a.in.size);
    const list = make("ul");
    all.slice(0, 12).forEach((line) => list.append(make("li", {}, ...line.parts, ` — in ${line.in.size} of ${found.length}`)));
    if (all.length > 12) list.append(make("li", {}, `and ${all.length - 12} more; see the situations`));
    return make("div", {}, make("p", { className: "who" }, `${name}${owners(k) ? ` (${owners(k)})` : ""}:`), list);
  };

  // The form --------------------------------------------------------------------------------------------------------
  const selects = book.automata.map((a, k) => {
    if (a.places.length < 2) return null;
    const select = make("select", {}, make("option", { value: "" }, "anywhere"));
    a.places.forEach((p, n) => free(k, n) || select.append(make("option", { value: n }, p[0])));
    if (!agents.includes(k)) select.firstChild.textContent = "any";
    at("choose").append(make("label", {}, a.shown, select));
    return select;
  });
  const values = book.variables.map((name, k) => {
    const unknown = book.states.some((each) => each[1][k] === 2) ? [["2", said(2)]] : [];
    const select = make("select", {}, ...[["", "any"], ["1", "true"], ["0", "false"], ...unknown].map(([value, text]) => make("option", { value }, text)));
    at("choose").append(make("label", {}, name, select));
    return select;
  });
  const subject = make("select", {}, make("option", { value: "" }, "anybody"));
  agents.forEach((k) => subject.append(make("option", { value: k }, book.automata[k].name)));
  at("choose").prepend(make("label", {}, "what is done by", subject));
  at("choose").addEventListener("change", () => {
    const query = { of: new Set(subject.value ? [Number(subject.value)] : []), places: new Map(), values: new Map(), unknown: [] };
    selects.forEach((select, k) => { if (select && select.value) query.places.set(k, new Set([Number(select.value)])); });
    values.forEach((select, k) => { if (select.value) query.values.set(k, Number(select.value)); });
    answer(query);
  });
  at("form").addEventListener("submit", (event) => {
    event.preventDefault();
    if (at("question").value.trim()) answer(understand(at("question").value)); else at("found").replaceChildren();
  });
  // Without stages one situation is the start. In stages each part begins where the stage before has ended. --------
  const situations = (begin, end) => {
    const some = [...Array(end - begin).keys()].map((k) => begin + k).filter((n) => !state(n).goal && !state(n).done);
    const box = make("details", {}, make("summary", {}, `It begins in one of these ${some.length} situations`));
    const list = make("div");
    const more = make("button", { type: "button" }, "Show more");
    const show = () => {
      list.append(...some.splice(0, AT_ONCE).map((n) => card(n)));
      more.hidden = !some.length;
    };
    more.addEventListener("click", show);
    box.addEventListener("toggle", () => { if (box.open && !list.firstChild) show(); });
    box.append(list, more);
    return box;
  };
  const together = (count) => (count > 1 ? `; its ${count} parts are played at the same time` : "");
  const stages = book.parts.length ? book.parts[book.parts.length - 1][0] + 1 : 0;
  book.parts.forEach(([stage, who, until, first], k) => {
    if (!k || book.parts[k - 1][0] !== stage) {
      const count = book.parts.filter((part) => part[0] === stage).length;
      const begins = stage ? "when stage " + stage + " is done" : "from the start";
      at("tree").append(make("h4", {}, until ? `Stage ${stage + 1} of ${stages}, ${begins}${together(count)}`
        : book.ordered ? "The steps of each agent" : `${count} shares, played at the same time`));
    }
    const end = k + 1 < book.parts.length ? book.parts[k + 1][3] : book.states.length;
    const names = who.map((name) => book.automata.find((a) => a.name === name).shown).join(" and ");
    at("tree").append(make("p", {}, make("span", { className: "who" }, names), `${names ? " play" + (who.length > 1 ? "" : "s") : "Played"}${until ? ` until “${until}”` : ""}.`),
      stage ? situations(first, end) : card(first));
  });
  if (!stages) at("tree").append(card(0));
  if (!stages) at("tree").firstChild.open = true;
  at("live").hidden = false;
})();
