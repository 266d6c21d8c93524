"""The timeline shows conditions, visits, deadlines and broken assumptions; its table what each step changes."""

from __future__ import annotations

from typing import Dict, List

from missions import mission
from test_timeline import lanes, tooltips

from pursue_gen.language import parse
from pursue_gen.tga import translate
from pursue_gen.tools.report.recording import Recording, Step, broken, changes, conditions, holding, stays
from pursue_gen.tools.report.timeline import draw, section

TEXT = """
poi "a"
poi "b"
connect a and b distance 2 only_if open is_true
event "unlock"
event "call"
event "stamp" location b only_if not bot at a
rule "bag" for each robot: unlock before stamp
state "open": initially false, true_if unlock
agent "bot" controllable mobile 1 location a can_do unlock, stamp
agent "guest" location b can_do call
assume: guest does call at_most 1 times
objective: avoid bot on_way and guest at a
reach_objective: do stamp within 30
"""


def made_up() -> Recording:
    """A mission in which the guest calls twice."""
    scenario = parse(TEXT, "x.pur", "x")
    network = translate(scenario)
    places = {automaton.name: automaton.initial for automaton in network.automata}
    values = dict(network.variables)
    steps: List[Step] = [Step(0.0, dict(places), dict(values))]
    moved: Dict[str, str]
    for at, agent, event, moved, new in (
        (1.0, "bot", "unlock", {}, {"Sopen": 1, "Pbag_bot": 1}),
        (2.0, "bot", "bot_a2b", {"bot": "going_a_to_b"}, {}),
        (3.0, "guest", "call", {}, {"assume1count": 1}),
        (4.5, "bot", "bot_going_a_to_b2b", {"bot": "b"}, {}),
        (6.0, "guest", "call", {}, {"assume1": 0}),
        (8.0, "bot", "stamp", {"reachObj": "win"}, {"Pbag_bot": 0}),
    ):
        places, values = {**places, **moved}, {**values, **new}
        steps.append(Step(at, dict(places), dict(values), agent, event))
    return Recording(scenario, network, tuple(steps), 8.0, "made up")


def test_conditions_are_found_once_each_and_hold_from_one_step_to_another() -> None:
    made = made_up()
    found = conditions(made.scenario)
    assert list(found) == ["open is_true", "not bot at a", "bot on_way and guest at a"]
    times = {text: [(stay.start, stay.end) for stay in holding(made, each)] for text, each in found.items()}
    assert times == {"open is_true": [(1.0, 8.0)], "not bot at a": [(2.0, 8.0)], "bot on_way and guest at a": []}


def test_a_recording_with_other_names_holds_no_condition() -> None:
    made = made_up()
    other = Recording(made.scenario, made.network, (Step(0.0, {"x": "y"}, {}),), 5.0, "made up")
    assert [holding(other, each) for each in conditions(made.scenario).values()] == [(), (), ()]
    assert draw(other).startswith("<")


def test_a_broken_assumption_is_named_with_its_moment() -> None:
    ((says, stay),) = broken(made_up())
    assert (says, stay.start) == ("guest does call at most once", 6.0)


def test_each_of_them_has_a_lane() -> None:
    found = lanes(draw(made_up()))
    assert tooltips(found["not bot at a"], "box") == ["not bot at a holds, 2 to the end"]
    assert tooltips(found["broken"], "box") == ["broken: guest does call at most once, 6 to the end"]
    assert tooltips(found["stamp"], "box") == ["stamp due by 30, 0 to 8"]


def test_the_table_says_what_each_step_changes() -> None:
    made = made_up()
    first, unlock, leaves, call, arrives, again, stamp = changes(made)
    assert "bag of bot: next: unlock" in first and "open: false" in first
    assert unlock == "bag of bot: next: stamp; open: true; open is_true: holds"
    assert leaves == "not bot at a: holds"
    assert call == "call by guest: 1 of 1 times"
    assert arrives == ""
    assert again == "guest does call at most once: broken: not assumed any more"
    assert stamp == "bag of bot: next: unlock; do stamp within 30: reached"
    assert "<td>not bot at a: holds</td>" in section(made).body_html


def test_visits_of_a_patrol_stand_between_their_deadlines() -> None:
    made = mission("museum/night_watch")
    found = lanes(draw(made))
    assert [name for name in found if name.startswith("visits")] == ["visits: gate", "visits: hall", "visits: vault"]
    there = [stay for stay in stays(made, "obj2") if stay.what == "idle"]
    assert len(there) > 2 and len(tooltips(found["visits: hall"], "turn")) == len(there)
    assert tooltips(found["visits: hall"], "box")[0].startswith("a visit of hall due by 24, 0 to ")


def test_a_battery_shows_its_levels() -> None:
    made = mission("museum/battery_watch", until=60.0)
    levels = [step.values["Lwatchman"] for step in made.steps]
    changed = [level for before, level in zip([-1, *levels], levels) if level != before]
    charge = tooltips(lanes(draw(made))["battery of watchman"], "turn")
    assert [text.split(",")[0] for text in charge] == [f"{level} of 14" for level in changed]
    assert changed[0] == 14 and len(set(changed)) > 2
