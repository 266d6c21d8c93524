"""Random small floors with a statement or two of every other kind: what must never be, comes again, or is assumed."""

from __future__ import annotations

import re
from random import Random
from string import Formatter
from typing import Dict, Sequence, Tuple

from benchmarks.lab_scenarios import Agent, Cast, Size, lab_scenario_with

MOST = 3
"""So many statements are added at most."""


def random_wishes(seed: int, size: Size) -> str:
    """The PuRSUE-ML of a lab scenario of this size, with one to three statements of the kinds that lab scenarios do
    not have; in some, what takes time may be broken off, or done in parts, what is delivered is a thing, it is not
    known where somebody starts, or a way leads through a door or goes by lift. Some have errors."""
    cast, text = lab_scenario_with(seed, size)
    draw = Random(f"wishes {seed} {size}")
    told = {**_drawn(draw, cast, text), **{f"t{time}": draw.randint(time // 2, time * 2) for time in _TIMES}}
    forms = [form for form in _FORMS if all(name in told for _, name, _, _ in Formatter().parse(form) if name)]
    kinds = draw.sample(forms, draw.randint(1, MOST))
    if draw.randint(0, 4) == 0:  # what takes time may be broken off, perhaps part by part
        parts = draw.choice(("", " in 2 parts", " in 3 parts"))
        text = re.sub(r"(duration \d+)$", rf"\1 may_stop{parts}", text, flags=re.MULTILINE)
    if draw.randint(0, 2) == 0:  # it is not known where somebody starts
        name, start = cast.people[0].name, draw.choice(cast.floor.rooms)
        text = re.sub(rf'^(agent "{name}" .*location (?!{start}\b)\w+)', rf"\1 or {start}", text, flags=re.MULTILINE)
    if '"pick' in text and draw.randint(0, 1) == 0:  # what is delivered is carried
        text = 'thing "box"\n' + re.sub(r'^(event "pick.*)$', r"\1 takes box", text, flags=re.MULTILINE)
        text = re.sub(r'^(event "drop.*)$', r"\1 gives box", text, flags=re.MULTILINE)
    if draw.randint(0, 3) == 0:  # a way leads through a door, or goes by lift
        text = _behind_something(draw, text)
    return text + "".join(f"{form.format(**told)}\n" for form in kinds)


def _behind_something(draw: Random, text: str) -> str:
    line = draw.choice([line for line in text.splitlines() if line.startswith("connect ")])
    _, one, _, other, *_ = line.split()
    first, longest = sorted(draw.sample(range(1, 6), 2))
    if draw.randint(0, 1):
        return text.replace(line, f'door "gate" opens within {longest}\n{line} through gate', 1)
    floors = f"{one}, {other} comes within {longest} takes {first} to {longest}"
    return text.replace(line, f'lift "hoist" at {floors}\n{line} by hoist', 1)


_TIMES = (4, 10, 30, 80)
"""Times are drawn from half of these to twice as much."""


def _drawn(draw: Random, cast: Cast, text: str) -> Dict[str, object]:
    """What stands in forms, by its name there; what there is nothing for is left out."""
    room, other = draw.sample(cast.floor.rooms, 2)
    way = draw.choice(cast.floor.ways)
    robot, person = draw.choice(cast.robots), draw.choice(cast.people)
    told: Dict[str, object] = {
        "robot": robot.name,
        "home": robot.home,
        "person": person.name,
        "place": draw.choice(cast.floor.halls + (other,)),
        "room": room,
        "other": other,
        "way": f"{way[0]} to {way[1]}",
        "who": draw.choice((robot.name, "any robot")),
    }
    done = [event for one in cast.robots for event in done_by(one, text)]
    called = [event for one in cast.people for event in done_by(one, text)]
    if done:
        told["done"], told["also"] = draw.choice(done), draw.choice(done)
    if called:
        told["called"], told["also_called"] = draw.choice(called), draw.choice(called)
        told["caller"] = next(one.name for one in cast.people if told["called"] in done_by(one, text))
    return told


def done_by(agent: Agent, text: str) -> Sequence[str]:
    """The events that an agent can do, by the text of its scenario."""
    line = next(line for line in text.splitlines() if line.startswith(f'agent "{agent.name}"'))
    return line.partition(" can_do ")[2].split(", ") if " can_do " in line else ()


_FORMS: Tuple[str, ...] = (
    "objective: place {room} holds 1 robot",
    "objective: place {place} holds 2 agents",
    "objective: way {way} holds 1 robot",
    "objective: every place holds 1 robot",
    "objective: every way holds 1 robot",
    "objective: at_least {t10} between {done}",
    "objective: at_least {t4} between {done} and {also}",
    "objective: if {called} then {done} within {t80}, at_most 2 open",
    "objective: escort {person} at {room} within {t30} by {who}",
    "objective: escort {person} at {room}, {other} within {t30} by any robot",
    "objective: patrol {room}, {place} in order every {t80} by {robot}",
    "objective: if {person} on_way then any robot at {place} within {t30}",
    "objective: if {robot} doing {done} then {who} at {room} within {t30}",
    "objective: avoid {robot} on_way and {person} on_way",
    "objective: always {robot} at {home} or not {person} at {room}",
    "optional 1 objective: avoid any robot at {room} and {person} at {other}",
    "reach_objective: do {done}",
    "reach_objective: do {done} within {t80}",
    "reach_objective: do {done} twice at_least {t10} apart",
    "battery \"{robot}\" lasts {t80}, charges in {t4} at {home}",
    "battery \"{robot}\" lasts {t80}, charges in {t30} in 4 parts at {home}",
    "battery \"{robot}\" capacity {t30} uses 1 per unit",
    "battery \"{robot}\" capacity {t80} uses 1 per metre, 0.5 per unit",
    "travel {robot} from {room} to {place} takes {t4}",
    "rest 0.5",
    'state "open": initially false, true_if {done} false_if {called}\nstateDependency: {also} only_if open is_false',
    'state "dry": initially unknown, shown_by {done}\nobjective: avoid {robot} doing {also} and dry is_true',
    'state "wet": initially unknown seen_at {room}, true_if {done}\nstateDependency: {also} only_if wet is_false',
    'rule "turns" for each robot: {done} before {also}',
    "assume: {caller} does {called} at_most 1 times",
    "assume: {caller} does {called} after {t10}",
    "assume: {caller} waits {t10} between {called}",
    "assume: {caller} waits {t10} between {called} and {also_called}",
    "assume: at_most 2 of {called}, {also_called} in all",
    "assume: {person} leaves {room} within {t10}",
    "assume: {caller} does {called} every {t4} to {t30}",
    "assume: {person} stays {t4} to {t30} at each place",
    "assume: {person} at {room} by {t80}",
    "assume: {person} reaches {room} within {t30} after {done}",
    "assume: {person} never at {room}",
    "assume: not ({person} at {room} or {person} at {other})",
)
