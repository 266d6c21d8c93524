"""What is wrong with a well-formed scenario is told at once, with its place, its reason and a way out."""

from __future__ import annotations

from dataclasses import replace
from typing import Dict, List, Tuple

import pytest

from pursue_gen.diagnostics import Severity
from pursue_gen.language import check, parse

from .texts import findings, text

BOT = 'agent "bot" controllable mobile 2 location a can_do work, hand'
MAN = 'agent "man" location b can_do rest reacts_to hand'

EVENTS = [f'event "e{k}"' for k in range(10)]
TEN = ", ".join(f"e{k}" for k in range(10))
ALL = "(" * 8 + "e0 and e1" + "".join(f") and e{k}" for k in range(2, 10))
"""Ten events in any order."""

# what is changed in the sample; then the findings: code, line, a part of the message, a part of the hint
FAULTS: List[Tuple[Dict[str, str], List[Tuple[str, int, str, str]]]] = [
    # names that are used
    ({"connect": "connect a and x distance 3"}, [("PML110", 3, "there is no POI x", 'declare it: poi "x"')]),
    ({"event_work": 'event "work" location bb'}, [("PML110", 4, "there is no POI bb", "did you mean b?")]),
    ({"rule": 'rule "order": wrk before hand'}, [("PML110", 7, "there is no event wrk", "did you mean work?")]),
    ({"state": 'state "tired": initially true, true_if a'}, [("PML110", 8, "a is a POI, but an event is needed", "")]),
    ({"dependency": "stateDependency: hand only_if tird is_true"}, [("PML110", 9, "no state tird", "mean tired?")]),
    ({"dependency": "stateDependency: hant only_if tired is_true"}, [("PML110", 9, "no event hant", "mean hand?")]),
    ({"agent_bot": BOT.replace("location a", "location hall")}, [("PML110", 10, "no POI hall", "one of: a, b")]),
    ({"agent_bot": BOT + ", fly"}, [("PML110", 10, "there is no event fly", "one of: work, hand, rest")]),
    ({"agent_man": MAN + ", man"}, [("PML110", 11, "man is an agent, but an event is", "write the name of an event")]),
    ({"objective": "objective: if work then hnd within 3"}, [("PML110", 12, "there is no event hnd", "mean hand?")]),
    ({"objective": "objective: avoid x"}, [("PML110", 12, "there is no event x", "declare it")]),
    ({"objective": "objective: bot never_with men"}, [("PML110", 12, "there is no agent men", "did you mean man?")]),
    ({"reach": "reach_objective: do nothing"}, [("PML110", 13, "there is no event nothing", "declare it")]),
    # numbers
    ({"connect": "connect a and b distance 0"}, [("PML140", 3, "has no length", "above 0")]),
    ({"event_work": 'event "work" location b duration 0'}, [("PML141", 4, "duration of 0", "delete duration")]),
    ({"agent_bot": BOT.replace("mobile 2", "mobile 0")}, [("PML142", 10, "no time for any way", "above 0")]),
    (
        {"connect": "connect a and b distance 4.25", "agent_bot": BOT.replace("mobile 2", "mobile 0.625")},
        [("PML281", 10, "needs 2.65625 time units from a to b", "takes 2.656")],
    ),
    ({"objective": "objective: if work then hand within 0"}, [("PML143", 12, "no time to answer", "time units")]),
    (
        {"connect": "connect a and b distance 1000000", "agent_bot": BOT.replace("mobile 2", "mobile 11")},
        [("PML144", 10, "more than 10000000 time units", "larger unit")],
    ),
    ({"event_work": 'event "work" location b duration 3 to 3'}, [("PML200", 4, "later than 3 and at 3", "3 to 4")]),
    ({"event_work": 'event "work" location b duration 5 to 3'}, [("PML200", 4, "no such time", "duration 3 to 5")]),
    ({"event_work": 'event "work" location b duration 0 to 3'}, []),
    # travel times
    ({"more": "travel bot from a to b takes 5 to 8\ntravel bot from b to a takes 7"}, []),
    ({"more": "travel bot from a to b takes 8 to 8"}, [("PML200", 14, "way of bot from a to b ends", "takes 8 to 9")]),
    ({"more": "travel bot from a to b takes 0"}, [("PML200", 14, "takes no time", "takes 0 to 1")]),
    ({"more": "travel man from a to b takes 5"}, [("PML201", 14, "man does not move", "write mobile 1 behind man")]),
    (
        {"poi_b": 'poi "b" poi "c"', "more": "connect b and c distance 1 travel bot from a to c takes 5"},
        [("PML190", 14, "only before", ""), ("PML201", 14, "no way leads from a to c", "connect a and c")],
    ),
    (
        {"connect": "connect a and b distance 3 one_way", "more": "travel bot from b to a takes 5"},
        [("PML201", 14, "(it is one_way, from a to b)", "delete this line")],
    ),
    ({"more": "travel bot from a to b takes 5\ntravel bot from a to b takes 6"}, [("PML202", 15, "line 14", "delete")]),
    ({"more": "travel boot from a to b takes 5"}, [("PML110", 14, "there is no agent boot", "did you mean bot?")]),
    ({"more": "travel bot from a to x takes 5"}, [("PML110", 14, "there is no POI x", "declare it")]),
    ({"event_rest": 'event "rest" at_most 2 times'}, []),
    ({"event_rest": 'event "rest" at_most 0 times'}, [("PML204", 6, "expected 1 to 100", "avoid rest")]),
    ({"event_rest": 'event "rest" at_most 101 times'}, [("PML204", 6, "at_most 101 times", "or delete it")]),
    # rules
    ({"rule": 'rule "order" for each robot: (work or hand) before rest'}, [
        ("PML206", 10, "bot cannot end a round of the rule order: it cannot do rest", "add rest behind"),
    ]),
    ({"rule": 'rule "order" for each agent: (work and hand) before rest'}, [
        ("PML206", 10, "it cannot do rest", ""), ("PML206", 11, "man cannot end", "add work, hand behind"),
    ]),
    ({"rule": 'rule "order" for each robot: rest or nap', "event_rest": 'event "rest" event "nap"',
      "agent_man": MAN.replace("rest", "rest, nap")}, [("PML205", 7, "no robot can do one of its events", "let one")]),
    ({"rule": 'rule "order" for each robot: work before hand'}, []),
    ({"rule": 'rule "order": (work and rest) before hand'}, []),
    (
        {"more": " ".join([*EVENTS, 'rule "all": ' + ALL, f'agent "x" location a can_do {TEN}'])},
        [("PML190", 14, "only before", ""), ("PML203", 14, "has 1,023 positions", "fewer events")],
    ),
    (
        {"event_rest": 'event "rest" event "nap"', "rule": 'rule "order": (work and nap) before hand'},
        [("PML150", 6, "nobody can do nap", ""), ("PML161", 7, "nobody can do nap", "")],
    ),
    (
        {"rule": 'rule "order": (work and rest) before hand rule "more": hand before rest'},
        [("PML161", 7, "rest waits for hand in the rule more", ""), ("PML161", 7, "hand waits for rest", "")],
    ),
    # connections
    ({"connect": "connect a and b distance 3\nconnect a and a distance 1"}, [("PML145", 4, "a with itself", "two")]),
    ({"connect": "connect a and b distance 3\nconnect b and a distance 4"}, [("PML146", 4, "line 3", "delete")]),
    (
        {"connect": "connect a and b distance 3 one_way\nconnect b and a distance 4"},
        [("PML146", 4, "connected twice", "write one_way behind both")],
    ),
    ({"connect": "connect b and a distance 3 one_way"}, [
        ("PML154", 5, "hand can never happen", "connect"),
        ("PML153", 10, "bot can never do work: no way leads from a to b", "connect them"),
    ]),
    ({"connect": "connect a and b distance 3 one_way\nconnect b and a distance 4 one_way"}, []),
    ({"poi_b": 'poi "b" poi "c" poi "d" connect c and d distance 1'}, [("PML147", 2, "from a to c", "connect c and")]),
    # events
    ({"event_rest": 'event "rest" event "fly"'}, [("PML157", 6, "nothing uses fly", "can_do fly")]),
    ({"event_rest": 'event "rest" event "fly" collaborative'}, [("PML157", 6, "nothing uses fly", "delete the event")]),
    ({"event_rest": 'event "rest" event "fly"', "rule": 'rule "order": wrk before hand'}, [("PML110", 7, "wrk", "")]),
    ({"event_rest": 'event "rest" event "fly"', "agent_man": MAN + ", fly"}, [
        ("PML150", 6, "nobody can do fly", "can_do fly"), ("PML152", 11, "fly is not collaborative", ""),
    ]),
    ({"event_rest": 'event "rest" event "fly"', "reach": "reach_objective: do fly"}, [
        ("PML150", 6, "nobody can do fly", "can_do fly"),
    ]),
    ({"agent_man": 'agent "man" location b can_do rest'}, [("PML151", 5, "nobody reacts to it", "reacts_to hand")]),
    (
        {"agent_bot": BOT + " reacts_to hand", "agent_man": 'agent "man" location b can_do rest'},
        [("PML151", 5, "nobody else reacts to it", "another agent")],
    ),
    ({"agent_bot": BOT + " reacts_to hand"}, [("PML155", 10, "its own partner", "delete hand")]),
    ({"agent_man": MAN + ", work"}, [("PML152", 11, "work is not collaborative", "collaborative")]),
    ({"agent_bot": BOT.replace("mobile 2 ", "")}, [
        ("PML154", 5, "never get to one place", "where they can meet"),
        ("PML153", 10, "bot stays in a and can never do work in b", "make it mobile"),
    ]),
    ({"connect": ""}, [
        ("PML154", 5, "hand can never happen", "connect"),
        ("PML153", 10, "no way leads from a to b", "connect them"),
    ]),
    (
        {"event_hand": 'event "hand" collaborative location a'},
        [("PML154", 5, "hand can never happen", "")],
    ),
    ({"agent_bot": BOT + ", work"}, [("PML156", 10, "work twice behind can_do", "delete one")]),
    ({"event_hand": 'event "hand" collaborative duration 3'}, [("PML158", 5, "may leave as soon as", "together")]),
    ({"event_work": 'event "work" together location b duration 3'}, [("PML159", 4, "not collaborative", "delete")]),
    ({"event_hand": 'event "hand" collaborative together'}, [("PML159", 5, "has no duration", "duration 4")]),
    (
        {
            "event_hand": 'event "hand" collaborative together duration 3',
            "agent_bot": BOT + '\nagent "bot2" controllable mobile 1 location a can_do hand',
        },
        [("PML163", 5, "anywhere by bot and by bot2", "location")],
    ),
    # conditions
    ({"event_rest": 'event "rest" only_if bt at a'}, [("PML110", 6, "no agent bt", "did you mean bot?")]),
    ({"event_rest": 'event "rest" only_if bot at c'}, [("PML110", 6, "there is no POI c", "declare it")]),
    ({"event_rest": 'event "rest" only_if bot doing wrk'}, [("PML110", 6, "no event wrk", "did you mean work?")]),
    ({"event_rest": 'event "rest" only_if bot is_true'}, [("PML110", 6, "bot is an agent, but a state", "write the")]),
    ({"connect": "connect a and b distance 3 only_if tird is_true"}, [("PML110", 3, "no state tird", "mean tired?")]),
    ({"event_rest": 'event "rest" only_if man at a'}, [("PML230", 6, "man is never at a", "make it mobile")]),
    ({"event_rest": 'event "rest" only_if not man on_way'}, [("PML230", 6, "man is never on its way", "mobile 1")]),
    (
        {
            "event_rest": 'event "rest" only_if any robot on_way',
            "agent_bot": BOT.replace("mobile 2 location a", "location b"),
        },
        [("PML230", 6, "no robot is ever on its way", "mobile 1")],
    ),
    ({"event_rest": 'event "rest" only_if man doing work'}, [("PML231", 6, "man is never doing work", "can_do work")]),
    ({"event_rest": 'event "rest" only_if no agent doing hand'}, [("PML231", 6, "hand takes no time", "a duration")]),
    (
        {"event_rest": 'event "rest" only_if bot at a and bot at b'},
        [("PML232", 6, "this condition never holds: bot at a and bot at b", "delete it")],
    ),
    (
        {"event_rest": 'event "rest" only_if not (bot at a and bot on_way)'},
        [("PML232", 6, "this condition always holds", "delete it")],
    ),
    ({"objective": "objective: avoid bot at a"}, [("PML234", 12, "lost before anything moves: bot is at a", "start")]),
    ({"objective": "objective: always tired is_true"}, [("PML234", 12, "tired is false", "other values")]),
    ({"objective": "objective: avoid man at a"}, [("PML230", 12, "man is never at a", "another place")]),
    ({"objective": "objective: bot never_with man at a"}, [("PML230", 12, "man is never at a", "another place")]),
    ({"objective": "objective: bot never_with man at c"}, [("PML110", 12, "there is no POI c", "declare it")]),
    (
        {"objective": "objective: bot never_with man at b", "agent_bot": BOT.replace("location a", "location b")},
        [("PML174", 12, "both start in b", "somewhere else")],
    ),
    ({"objective": "objective: always bot at a or not bot at a"}, [("PML232", 12, "always holds", "delete it")]),
    # room, and how many
    ({"objective": "objective: place b holds 1 agent"}, []),
    ({"objective": "objective: place a, b holds 1 agent"}, [("PML234", 12, "more than 1 agent is at a", "start")]),
    ({"objective": "objective: place a holds 0 robots"}, [("PML234", 12, "more than 0 robots are at a", "start")]),
    ({"objective": "objective: place a holds 1 robot"}, [("PML232", 12, "never are more than 1 at a", "delete it")]),
    ({"objective": "objective: place a holds 1 of bot, man"}, [("PML230", 12, "man is never at a", "mobile")]),
    ({"objective": "objective: place a holds 1 of bot, men"}, [("PML110", 12, "no agent men", "did you mean man?")]),
    ({"objective": "objective: place c holds 1 robot"}, [("PML110", 12, "there is no POI c", "declare it")]),
    ({"objective": "objective: place b holds 1.5 robots"}, [("PML014", 12, "a whole number", "without decimals")]),
    ({"objective": "objective: way b to a holds 0 robots"}, []),
    (
        {"objective": "objective: way a to a holds 1 robot"},
        [("PML230", 12, "no robot is ever between a and a", "connect a with a")],
    ),
    ({"event_rest": 'event "rest" only_if bot on_way from b to a and bot between a and b'}, []),
    (
        {"event_rest": 'event "rest" only_if man on_way from a to b'},
        [("PML230", 6, "man is never on its way from a to b", "make it mobile")],
    ),
    ({"event_rest": 'event "rest" only_if at_most 1 agent at b and at_most 0 robots at a'}, []),
    ({"event_rest": 'event "rest" only_if at_most 2 agents at b'}, [("PML232", 6, "always holds", "delete it")]),
    # rules and dependencies
    ({"rule": 'rule "order": (work before hand) before work'}, [("PML160", 7, "names work twice", "each event once")]),
    ({"rule": 'rule "order": work before hand\nrule "back": hand before work'}, [
        ("PML161", 7, "work waits for hand in the rule back", "change the order"),
        ("PML161", 8, "hand waits for work in the rule order", ""),
        ("PML162", 10, "tired never becomes true", "behind true_if of tired"),
    ]),
    ({"event_rest": 'event "rest" event "fly"', "rule": 'rule "order": work before fly'}, [
        ("PML150", 6, "nobody can do fly", ""),
        ("PML161", 7, "the rule order can never turn: nobody can do fly", ""),
    ]),
    ({"state": 'state "tired": initially false, false_if rest'}, [
        ("PML161", 7, "hand waits for a state that never has the value", ""),
        ("PML162", 9, "hand can never happen: tired never becomes true", "start it as true"),
    ]),
    ({"state": 'state "tired": initially false, true_if work, rest false_if rest'}, [
        ("PML320", 8, "rest would make tired both true and false", "out of true_if or of false_if"),
    ]),
    # agents and objectives
    ({"agent_bot": BOT.replace("controllable ", "")}, [("PML131", 10, "nobody in this scenario", "controllable")]),
    ({"agent_man": MAN.replace("location", "human location")}, [("PML180", 11, "human but not controllable", "ally")]),
    ({"objective": "", "reach": ""}, [("PML171", 14, "has no objective", "reach_objective: do e")]),
    ({"objective": "objective: if work then work within 4"}, [("PML172", 12, "its own answer", "follow")]),
    ({"objective": "objective: bot never_with bot"}, [("PML173", 12, "bot is always with itself", "two different")]),
    (
        {"objective": "objective: bot never_with man", "agent_man": MAN.replace("location b", "location a")},
        [("PML174", 12, "both start in a", "somewhere else")],
    ),
    ({"more": "objective: avoid rest\nreach_objective: do hand after 99\nobjective: bot never_with man"}, []),
    ({"more": "objective: patrol a, a every 30 by bot"}, [("PML220", 14, "a stands twice in this patrol", "delete")]),
    ({"objective": "objective: if work then hand within -20"}, [("PML014", 12, "found -20", "write")]),
    ({"more": "battery bot capacity -4 uses 1 per unit"}, [("PML014", 14, "expected a whole number", "write digits")]),
    ({"more": "objective: patrol a every -20 by bot"}, [("PML014", 14, "expected a number, found -20", "write")]),
    ({"objective": "objective: avoid rest", "more": "objective: avoid rest"}, [("PML220", 14, "line 12", "delete")]),
    ({"reach": "reach_objective: do rest", "more": "objective: avoid rest"}, [("PML221", 13, "line 14 has", "delete")]),
    ({"reach": "reach_objective: do work and work"}, [("PML222", 13, "work stands twice", "delete one")]),
    ({"reach": "reach_objective: do work and hand and wrk"}, [("PML110", 13, "no event wrk", "did you mean work?")]),
    ({"reach": "reach_objective: do work within 0"}, [("PML223", 13, "ends before it counts", "within 1 or more")]),
    ({"reach": "reach_objective: do work after 9 within 9"}, [("PML223", 13, "later than 9", "within 10 or more")]),
    ({"reach": "reach_objective: do work and hand after 9 within 10"}, []),
    ({"more": "objective: if work then work within 3"}, [("PML172", 14, "its own answer", "follow")]),
    ({"more": "objective: if work then hand within 0"}, [("PML143", 14, "no time to answer", "time units")]),
    ({"more": 'poi "c" connect c and a distance 1'}, [("PML190", 14, "only before objective", "the order is free")]),
]  # fmt: skip


@pytest.mark.parametrize(("changes", "expected"), FAULTS, ids=[str(row[0])[:50] for row in FAULTS])
def test_a_fault_is_reported_with_its_place_and_a_way_out(
    changes: Dict[str, str], expected: List[Tuple[str, int, str, str]]
) -> None:
    source = text(**changes)
    found = findings(source)
    assert [(finding.code, finding.span and finding.span.line) for finding in found] == [row[:2] for row in expected]
    for finding, (_, _, message, hint) in zip(found, expected):
        assert message in finding.message
        assert finding.hint and hint in finding.hint


WARNINGS = {"PML120", "PML121", "PML147", "PML152", "PML157", "PML158", "PML180", "PML190", "PML206", "PML232"}


def test_only_what_can_be_meant_is_a_warning() -> None:
    seen = set()
    for changes, _ in FAULTS:
        for finding in findings(text(**changes)):
            assert (finding.severity is Severity.WARNING) == (finding.code in WARNINGS), finding
            seen.add(finding.code)
    assert len(seen) > 25


def test_an_empty_text_is_reported_what_a_scenario_needs() -> None:
    assert [finding.code for finding in findings("")] == ["PML132", "PML130", "PML171"]


def test_everything_is_reported_at_once_in_file_order() -> None:
    source = text(
        connect="connect a and b distance 0",
        event_work='event "work" location c duration 0',
        agent_bot=BOT.replace("mobile 2", "mobile 0"),
        reach="reach_objective: do hadn",
    )
    assert [finding.code for finding in findings(source)] == ["PML140", "PML141", "PML110", "PML142", "PML110"]


def test_a_mistake_in_a_name_is_not_reported_twice_as_its_consequences() -> None:
    """An event with a misspelt name in can_do is not also said to be one that nobody can do."""
    assert [finding.code for finding in findings(text(agent_bot=BOT.replace("hand", "hnd")))] == ["PML110"]


def test_a_choice_turns_as_long_as_one_way_is_open() -> None:
    source = text(
        event_rest='event "rest" event "help" location b event "call"',
        rule='rule "order": (work or help) before (hand or call)',
        agent_bot=BOT + ", help, call",
        dependency="stateDependency: help only_if tired is_true",
        state='state "tired": initially false, false_if rest',
    )
    assert [finding.code for finding in findings(source)] == ["PML162"]


def test_a_value_made_by_hand_is_checked_without_a_text() -> None:
    scenario = replace(parse(text(), "test.pur"), text="")
    assert check(scenario) == ()
    assert [finding.code for finding in check(replace(scenario, connections=()))] == ["PML154", "PML153"]


WITH_UNKNOWN_PLACE = """poi "a"
poi "b"
event "meet" collaborative
event "nobody"
event "work" location b
agent "bot" controllable mobile 1 location a can_do meet, work
agent "man" mobile 2 location q
reach_objective: do work
"""


def test_a_name_that_is_declared_nowhere_hides_no_other_mistake() -> None:
    found = {(finding.code, finding.span.line) for finding in check(parse(WITH_UNKNOWN_PLACE, "x.pur")) if finding.span}
    assert {("PML110", 7), ("PML151", 3), ("PML157", 4)} <= found
    assert not any(code == "PML153" for code, _ in found), "where agents can get is not known"
