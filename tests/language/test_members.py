"""`any of`, `all of`, `none of`, and `each robot`: what they mean, and what is refused."""

from __future__ import annotations

from typing import Dict, List, Tuple

import pytest
from hypothesis import given
from hypothesis import strategies as st

from pursue_gen.language import network_names
from pursue_gen.language.checks import check_reading
from pursue_gen.language.conditions import condition_text
from pursue_gen.language.parser import read
from pursue_gen.language.scenario import Scenario
from pursue_gen.tools.simulation.meaning import holds

PLACES = ["hall", "room1", "room2", "dock"]
ROBOTS = ["cart1", "cart2"]
AGENTS = [*ROBOTS, "nurse", "guest"]
EVENTS = ["load", "pack"]

STORY = """\
poi "hall"
poi "room1"
poi "room2"
poi "dock"
for each r in rooms: connect hall and r distance 2
connect hall and dock distance 1
event "load" location dock duration 2
event "pack" location dock duration 2
event "ring"
group "rooms": room1, room2
group "crew": cart1, nurse, guest
group "jobs": load, pack
agent "cart1" controllable mobile 1 location hall can_do jobs
agent "cart2" controllable mobile 1 location room1 can_do jobs
agent "nurse" human controllable mobile 2 location hall can_do jobs
agent "guest" mobile 3 location room2 can_do ring
"""


def story(*lines: str) -> Scenario:
    reading = read(STORY + "\n".join(lines), "story.pur")
    assert reading.scenario is not None, reading.diagnostics
    return reading.scenario


def meant(condition: str) -> str:
    """The condition, written out."""
    (only,) = story(f"objective: avoid {condition}").safety[0].conditions
    return condition_text(only)


def found(text: str) -> List[Tuple[str, int, int, str, str]]:
    """Code, line, column, message and hint of each finding."""
    findings = check_reading(read(text, "story.pur"))
    return [(f.code, f.span.line, f.span.column, f.message, f.hint) for f in findings if f.span]


# Conditions -----------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("said", "written_out"),
    [
        ("none of crew at dock", "not cart1 at dock and not nurse at dock and not guest at dock"),
        ("not none of robots on_way", "not (not cart1 on_way and not cart2 on_way)"),
        ("guest at any of rooms", "guest at room1 or guest at room2"),
        ("not guest at any of rooms", "not (guest at room1 or guest at room2)"),
        ("cart1 doing any of jobs and guest at hall", "(cart1 doing load or cart1 doing pack) and guest at hall"),
        ("any robot at any of rooms", "any robot at room1 or any robot at room2"),
        ("no robot at any of rooms", "no robot at room1 and no robot at room2"),
        ("any of robots at any of rooms",
         "(cart1 at room1 or cart1 at room2) or (cart2 at room1 or cart2 at room2)"),
        ("all of robots at any of rooms",
         "(cart1 at room1 or cart1 at room2) and (cart2 at room1 or cart2 at room2)"),
        ("none of robots doing any of jobs",
         "not (cart1 doing load or cart1 doing pack) and not (cart2 doing load or cart2 doing pack)"),
    ],
)  # fmt: skip
def test_they_are_written_out(said: str, written_out: str) -> None:
    assert meant(said) == written_out


def test_groups_are_not_needed_for_robots() -> None:
    text = 'poi "a"\nagent "x" controllable location a\nagent "y" controllable location a\nobjective: avoid {}'
    (objective,) = read(text.format("none of robots at a"), "story.pur").partial.safety
    assert condition_text(objective.conditions[0]) == "not x at a and not y at a"


QUANTIFIERS = {"any": any, "all": all}
MEMBERS = {"crew": ["cart1", "nurse", "guest"], "robots": ROBOTS, "rooms": ["room1", "room2"], "jobs": EVENTS}


@given(
    st.sampled_from(["guest", "cart2", "any robot", "no robot"])
    | st.builds("{} of {}".format, st.sampled_from(["any", "all", "none"]), st.sampled_from(["crew", "robots"])),
    st.sampled_from(["at hall", "at room1", "at any of rooms", "doing load", "doing any of jobs", "on_way"]),
    st.booleans(),
    st.fixed_dictionaries({name: st.sampled_from([*PLACES, "load", "pack", ""]) for name in AGENTS}),
)
def test_they_mean_what_they_say(who: str, what: str, negated: bool, doing: Dict[str, str]) -> None:
    """`doing`: agent → where it stands idle, the event at dock, or "": on the way from hall to dock."""
    verb, *rest = what.replace("any of ", "").split()
    wanted = {"on_way": [""]}.get(verb) or MEMBERS.get(rest[0], rest)

    def does(agent: str) -> bool:
        return doing[agent] in wanted or (verb == "at" and "dock" in wanted and doing[agent] in EVENTS)

    word, *others = who.split()
    names = [word] if not others else ROBOTS if others == ["robot"] else MEMBERS[others[1]]
    truth = (all if word == "all" else any)(does(name) for name in names) != (word in ("no", "none"))
    scenario = story(f"objective: avoid {'not ' * (negated and word != 'no')}{who} {what}")
    truth = truth != (negated and word != "no")
    way = network_names.going("hall", "dock")
    places = {
        name: place if place in PLACES else network_names.doing(place, "dock") if place else way
        for name, place in doing.items()
    }
    assert holds(scenario.safety[0].conditions[0], scenario, places, {}) is truth


# Each robot -----------------------------------------------------------------------------------------------------------


def test_each_robot_and_each_two_robots() -> None:
    scenario = story(
        "for each robot r: objective: avoid r at dock and guest at dock",
        "for each two robots a, b: objective: a never_with b",
        "for each robot r, p in rooms: objective: if ring then r at p within 60",
        "for each p in rooms, robot r: objective: r never_with guest at p",
    )  # fmt: skip
    assert [each.text for each in scenario.safety] == [
        *(f"avoid {r} at dock and guest at dock" for r in ROBOTS), "cart1 never_with cart2",
        *(f"if ring then {r} at {p} within 60" for r in ROBOTS for p in MEMBERS["rooms"]),
        *(f"{r} never_with guest at {p}" for p in MEMBERS["rooms"] for r in ROBOTS),
    ]  # fmt: skip


def test_what_is_called_robots_or_robot_keeps_its_name() -> None:
    scenario = story(
        'group "robots": room1, room2', 'group "robot": dock',
        'for each p in robots: event "go" of p location p', 'for each p in robot: event "stay" of p location p',
        "for each robot r: objective: avoid r doing load",
    )  # fmt: skip
    names = [event.name for event in scenario.events if event.name[:2] in ("go", "st")]
    assert names == ["go_room1", "go_room2", "stay_dock"]
    assert [each.text for each in scenario.safety] == [f"avoid {robot} doing load" for robot in ROBOTS]


@given(st.lists(st.sampled_from(["controllable", "controllable human", "human controllable", ""]), max_size=6))
def test_robots_are_those_that_are_controllable_and_not_human(kinds: List[str]) -> None:
    agents = [f'agent "a{number}" {kind} location a' for number, kind in enumerate(kinds)]
    each = ['for each robot r: event "go" of r', 'for each two robots r, s: event "e" of r of s']
    reading = read("\n".join(['poi "a"', *agents, *each]), "story.pur")
    robots = [agent.name for agent in reading.partial.agents if agent.is_robot]
    events = [event.name for event in reading.partial.events]
    if len(robots) > 1:
        pairs = [(a, b) for number, a in enumerate(robots) for b in robots[number + 1 :]]
        assert events == [*(f"go_{name}" for name in robots), *(f"e_{a}_{b}" for a, b in pairs)]


# Findings -------------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("line", "code", "column", "message", "hint"),
    [
        ("objective: avoid no of rooms on_way", "PML010", 21, "expected `robot` or `agent` after `no`", "none of"),
        ("objective: avoid guest at all of rooms", "PML413", 27, "`all of` stands behind `at`", "at any of"),
        ("objective: avoid any of crew doing none of jobs", "PML413", 36, "`none of` stands behind", "doing any of"),
        ("objective: cart1 never_with guest at any of rooms", "PML411", 38, "`any of` stands in conditions", "as in"),
        ('rule "one": load before none of jobs', "PML411", 25, "`none of` stands in conditions only", "for each"),
        ("objective: avoid none of rooms", "PML411", 18, "`none of` stands in", "any of carts at door"),
        ("objective: avoid crew at any of rooms", "PML409", 18, "crew is a group", "any of crew"),
        ("objective: avoid guest at rooms", "PML409", 27, "rooms is a group", "any of rooms"),
        ("objective: avoid any of rooms at any of rooms", "PML110", 25, "room1 is a POI", "the name of an agent"),
        ('for each robot r: agent "key" of r location hall', "PML414", 10, "cannot be for each", 'group "carts"'),
        ('for each r in robots: agent "key" of r location hall', "PML414", 15, "cannot be for each", "for each c"),
        ("for each robot r in rooms: objective: avoid r at dock", "PML010", 18, "found `in`", "for each robot r"),
        ("for each robots r: objective: avoid r at dock", "PML010", 10, "found `robots`", "each two robots a, b"),
        ("for each two robot a, b: objective: a never_with b", "PML010", 14, "found `robot`", "each two robots a, b"),
        ("for each robot guest: objective: avoid guest at dock", "PML404", 16, "guest is an agent", "another name"),
        ("for each robot r: objective: avoid guest at dock", "PML405", 16, "r is not used", "name it"),
    ],
)  # fmt: skip
def test_what_is_wrong_is_said_where_it_stands(line: str, code: str, column: int, message: str, hint: str) -> None:
    first = found(STORY + line)[0]
    assert first[:3] == (code, 17, column) and message in first[3] and hint in first[4], first


@pytest.mark.parametrize(
    ("line", "code", "message"),
    [
        ("for each robot r: objective: avoid r at a", "PML401", "nothing is in robots"),
        ("objective: avoid any of robots at a", "PML401", "nothing is in robots"),
        ('agent "x" controllable location a\nfor each two robots r, s: objective: r never_with s', "PML407", "no pair"),
    ],
)
def test_there_have_to_be_robots(line: str, code: str, message: str) -> None:
    first = found(f'poi "a"\nagent "g" location a\n{line}')[0]
    assert first[0] == code and message in first[3]
