"""Random scenarios of several robots and people: what each robot does, what comes before the report, who is met."""

from __future__ import annotations

from random import Random
from typing import List


def random_story(draw: Random) -> str:
    """The PuRSUE-ML of a scenario: one to three robots with a deed or two each, up to two people who walk about, are
    met, call or are in the way; rules, states, a deadline or something to be avoided; mostly a report at the end. Some
    of them have errors."""
    places = [f"p{k}" for k in range(draw.randint(2, 3))]
    ways = [(a, b, draw.randint(1, 3)) for a, b in zip(places, places[1:])]
    robots, people = draw.randint(1, 3), draw.randint(0, 2)
    events: List[str] = ['event "report"']
    rules: List[str] = []
    agents: List[str] = []
    states: List[str] = []
    met = draw.randint(0, people)
    for k in range(robots):
        deeds = [f"a{k}", f"b{k}"][: draw.randint(1, 2)]
        for deed in deeds:
            events.append(f'event "{deed}"{_where(draw, places)}{_long(draw)}')
        word = draw.choice(("before", "before", "or", "and"))
        body = deeds[0] if len(deeds) == 1 else f"({deeds[0]} {word} b{k})"
        if draw.randint(0, 4):
            rules += [f"{body} before report"] * draw.choice((1, 1, 1, 2))
        meets = [f"meet{n}" for n in range(met) if n % robots == k]
        other = [f"a{(k + 1) % robots}"] if robots > 1 and draw.randint(0, 5) == 0 else []
        tells = ["report"] if k == 0 or draw.randint(0, 3) == 0 else []
        can_do = ", ".join([*deeds, *meets, *other, *tells])
        agents.append(f'agent "bot{k}" controllable mobile 1 location {draw.choice(places)} can_do {can_do}')
    for n in range(people):
        calls = [f"call{n}"] if _maybe(draw) else []
        events += [f'event "{call}"{_rarely(draw)}' for call in calls]
        parts = f" mobile {draw.randint(2, 4)}" if draw.randint(0, 3) else ""
        parts += f" location {draw.choice(places)}"
        parts += f" can_do {calls[0]}" if calls else ""
        parts += f" reacts_to meet{n}" if n < met else ""
        agents.append(f'agent "guest{n}"{parts}')
        if n < met:
            events.append(f'event "meet{n}" collaborative{_where(draw, places) if _maybe(draw) else ""}')
            rules.append(f"meet{n} before report")
        if calls and draw.randint(0, 3) == 0:
            rules.append(f"{calls[0]} before {draw.choice(('a0', 'report', f'p{n}'))}".replace(f"p{n}", "a0"))
    if draw.randint(0, 3) == 0:
        states.append('state "open": initially false, true_if a0')
        states.append(f"stateDependency: {draw.choice(('report', f'a{robots - 1}'))} only_if open is_true")
    objectives = [f"reach_objective: do report{draw.choice(('', ' after 0', ' after 6'))}"]
    callers = [line.split()[1].strip('"') for line in events if '"call' in line]
    safety = draw.choice(("", "", "", "avoid", "within", "with"))
    if safety == "avoid":
        objectives.insert(0, f"objective: avoid {draw.choice((*callers, 'a0'))}")
    elif safety == "within" and callers:
        objectives.insert(0, f"objective: if {callers[0]} then a0 within {draw.randint(4, 30)}")
    elif safety == "with" and people:
        objectives.insert(0, "objective: bot0 never_with guest0")
    if len(objectives) > 1 and draw.randint(0, 3) == 0:
        del objectives[1]
    more = draw.choice(("", "", "", "goal", "deadline", "call", "with"))
    if more in ("goal", "deadline"):
        todo = draw.choice(("a0", "report", "a0 and report"))
        objectives.append(f"reach_objective: do {todo} after 1" + (" within 60" if more == "deadline" else ""))
    elif more == "call" and callers:
        objectives.append(f"objective: if {callers[-1]} then report within {draw.randint(10, 40)}")
    elif more == "with" and people > 1:
        objectives.append("objective: bot0 never_with guest1")
    lines = [f'poi "{place}"' for place in places]
    lines += [f"connect {a} and {b} distance {distance}{_one_way(draw)}" for a, b, distance in ways]
    lines += events + [f'rule "r{number}"{_each(draw)}: {rule}' for number, rule in enumerate(rules)] + states
    return "\n".join([*lines, *agents, *objectives, ""])


def _where(draw: Random, places: List[str]) -> str:
    return f" location {draw.choice(places)}" if draw.randint(0, 3) else ""


def _each(draw: Random) -> str:
    return "" if draw.randint(0, 7) else draw.choice((" for each robot", " for each agent"))


def _rarely(draw: Random) -> str:
    return f" at_most {draw.randint(1, 2)} times" if draw.randint(0, 3) == 0 else ""


def _one_way(draw: Random) -> str:
    return "" if draw.randint(0, 7) else " one_way"


def _long(draw: Random) -> str:
    low = draw.randint(1, 3)
    until = f" to {low + draw.randint(1, 3)}" if draw.randint(0, 5) == 0 else ""
    return f" duration {low}{until}" if _maybe(draw) else ""


def _maybe(draw: Random) -> bool:
    return draw.choice((True, False))
