"""Whole small files as beginners write them: every mistake is told at its line, in file order, and nothing else."""

from __future__ import annotations

from typing import List, Tuple

import pytest

from pursue_gen.language.checks import check_reading
from pursue_gen.language.parser import read

Told = Tuple[str, int, str]
"""The code, the line, and how the hint begins."""

FILES: List[Tuple[str, str, List[Told]]] = [
    ("no quotes where a name is declared", """\
poi desk
poi "shelf"
connect desk and shelf distance 4
event fetch location shelf duration 3
agent "bot" controllable mobile 1 location desk can_do fetch
reach_objective: do fetch
""", [
        ("PML010", 1, 'put the name in quotes where it is declared: poi "desk"'),
        ("PML010", 4, 'put the name in quotes where it is declared: event "fetch"'),
    ]),
    ("quotes where a name is used", """\
poi "desk"
poi "shelf"
connect "desk" and "shelf" distance 4
event "fetch" location "shelf" duration 3
agent "bot" controllable mobile 1 location "desk" can_do fetch
reach_objective: do "fetch"
""", [
        ("PML010", 3, "quotes stand only where a name is declared: write desk without"),
        ("PML010", 4, "quotes stand only where a name is declared: write shelf withou"),
        ("PML010", 5, "quotes stand only where a name is declared: write desk without"),
        ("PML010", 6, "quotes stand only where a name is declared: write fetch withou"),
    ]),
    ("capitals and underscores", """\
poi "Kitchen"
poi "living_room"
connect kitchen and living_room distance 4
event "pick_up" location livingRoom duration 3
agent "bot" controllable mobile 1 location Kitchen can_do pickUp
reach_objective: do pickup
""", [
        ("PML110", 3, "did you mean Kitchen? (capitals matter)"),
        ("PML110", 4, "did you mean living_room?"),
        ("PML110", 5, "did you mean pick_up?"),
        ("PML110", 6, "did you mean pick_up?"),
    ]),
    ("own words for statements", """\
place "desk"
room "shelf"
path desk and shelf distance 4
action "fetch" location shelf duration 3
robot "bot" controllable mobile 1 location desk can_do fetch
goal: do fetch
""", [
        ("PML011", 1, "did you mean poi?"),
        ("PML011", 2, "did you mean poi?"),
        ("PML011", 3, "did you mean connect?"),
        ("PML011", 4, "did you mean event?"),
        ("PML011", 5, "did you mean agent?"),
        ("PML011", 6, "did you mean reach_objective?"),
    ]),
    ("keywords misspelled", """\
poi "desk"
poi "shelf"
conect desk and shelf distance 4
event "fetch" locaton shelf duration 3
agent "bot" controlable mobile 1 location desk cando fetch
reachObjective: do fetch
""", [
        ("PML011", 3, "did you mean connect?"),
        ("PML010", 4, "did you mean location?"),
        ("PML010", 5, "did you mean controllable?"),
        ("PML011", 6, "did you mean reach_objective?"),
    ]),
    ("an event named with its agent", """\
poi "desk"
event "wave"
event "answer"
agent "bot" controllable location desk can_do bot_wave
agent "guest" location desk can_do answer
reach_objective: do bot.wave
""", [
        ("PML110", 4, "write wave: an event is named without its agent"),
        ("PML010", 6, "a name stands alone, without the agent it belongs to: write wa"),
    ]),
    ("an event named with its agent, well formed", """\
poi "desk"
event "wave"
event "answer"
agent "bot" controllable location desk can_do wave
agent "guest" location desk can_do guest_answer
objective: if answer then bot_wave within 10
""", [
        ("PML110", 5, "write answer: an event is named without its agent"),
        ("PML110", 6, "write wave: an event is named without its agent"),
    ]),
    ("the wrong kind of thing", """\
poi "desk"
poi "door"
connect desk and door distance 3
event "open" location door
rule "first": door before open
agent "bot" controllable mobile 1 location open can_do open
objective: if bot then open within 10
""", [
        ("PML110", 5, "write the name of an event: open"),
        ("PML110", 6, "write the name of a POI: desk, door"),
        ("PML110", 7, "write the name of an event: open"),
    ]),
    ("semicolons, as in other languages", """\
poi "desk";
poi "door";
connect desk and door distance 3;
event "knock" location door;
agent "bot" controllable mobile 1 location desk can_do knock;
reach_objective: do knock;
""", [
        ("PML010", 1, "delete it: nothing stands behind a statement; the form is: poi"),
        ("PML010", 2, "delete it: nothing stands behind a statement; the form is: poi"),
        ("PML010", 3, "delete it: nothing stands behind a statement; the form is: con"),
        ("PML010", 4, "delete it: nothing stands behind a statement; the form is: eve"),
        ("PML010", 5, "delete it: nothing stands behind a statement; the form is: age"),
        ("PML010", 6, "delete it: nothing stands behind a statement; the form is: rea"),
    ]),
    ("units behind numbers", """\
poi "desk"
poi "door"
connect desk and door distance 3m
event "knock" location door duration 2 s
agent "bot" controllable mobile 0.5 location desk can_do knock
reach_objective: do knock after 10 seconds
""", [
        ("PML014", 3, "write 3 m, with a blank, where it is a length"),
        ("PML420", 4, "write a line above all others: unit second"),
        ("PML014", 6, "write 10 s"),
    ]),
    ("missing commas, colons and words", """\
poi "desk"
poi "door"
connect desk door distance 3
event "knock" location door
event "ring" location door
rule "order" knock before ring
agent "bot" controllable mobile 1 location desk can_do knock ring
reach_objective knock
""", [
        ("PML010", 3, "the form is: connect a and b distance 3"),
        ("PML010", 6, 'the form is: rule "order": first before second (or: first or s'),
        ("PML010", 7, "put a comma between two names"),
        ("PML010", 8, "the form is: reach_objective: do e1 and e2 after 10 within 60"),
    ]),
    ("two words in a row", """\
poi "desk"
event "take"
event "carry"
event "drop"
rule "trip": take or carry before drop
agent "bot" controllable location desk can_do take, carry, drop
reach_objective: do dropp
""", [
        ("PML010", 5, "put brackets around what belongs together: (first or second) b"),
        ("PML110", 7, "did you mean drop?"),
    ]),
    ("syntax and names at once", """\
poi "desk"
poi shelf
connect desk and shelf distance 4
connect desk and dor distance 2
event "fetch" location shelf duration 3
agent "bot" controllable mobile 1 location desk can_do fetsh
reach_objective: do fetch
""", [
        ("PML010", 2, 'put the name in quotes where it is declared: poi "shelf"'),
        ("PML110", 4, 'declare it: poi "dor", or use one of: desk'),
        ("PML110", 6, "did you mean fetch?"),
    ]),
    ("a name with a blank", """\
poi "front desk"
poi "shelf"
connect front_desk and shelf distance 4
event "fetch" location shelf
agent "bot" controllable mobile 1 location front_desk can_do fetch
reach_objective: do fetch
""", [
        ("PML101", 1, "use letters, digits and _, a letter first, for example front_d"),
    ]),
    ("a quote and a bracket left open", """\
poi "desk
event "take"
event "carry"
event "drop"
rule "trip": (take before carry before drop
agent "bot" controllable location desk can_do take, carry, drop
reach_objective: do drop
""", [
        ("PML012", 1, 'write it as "name"'),
        ("PML010", 5, "put a `)` for each `(`"),
    ]),
    ("word processor's quotes and blanks", """\
poi “desk”
event\u00a0"ring"
agent "bot" controllable location desk can_do ring
reach_objective: do ring
""", [
        ("PML010", 1, 'use straight double quotes: "name"'),
        ("PML015", 2, "delete it, or put an ordinary blank in its place"),
    ]),
    ("a state used wrongly", """\
poi "desk"
event "unlock"
event "enter"
state "open": initially false true_if unlock
stateDependency: enter only_if opened is_true
stateDependency: entre only_if open is true
agent "bot" controllable location desk can_do unlock, enter
reach_objective: do enter
""", [
        ("PML010", 4, 'put a comma behind true or false: state "open": initially fals'),
        ("PML110", 5, "did you mean open?"),
        ("PML010", 6, "did you mean is_true?"),
    ]),
    ("parts of an agent in another order", """\
poi "desk"
event "ring"
agent "bot" mobile 1 controllable location desk can_do ring
agent "nurse" controllable human location desk can_do ring
agent "guest" can_do ring location desk
reach_objective: do ring
""", [
        ("PML010", 3, 'write controllable before mobile; its parts come in this order: agent "bot" human control'),
        ("PML010", 4, 'write human before controllable; its parts come in this order: agent "bot" human control'),
        ("PML010", 5, 'its parts come in this order: agent "bot" human control'),
    ]),
    ("who is there, but nobody to command", """\
poi "desk"
poi "door"
event "knock" location door duration 0
event "ring"
agent "bot" mobile 1 location desk can_do knock
reach_objective: do knock
objective: avoid knok
""", [
        ("PML141", 3, "write duration and a number above 0, or delete duration: then i"),
        ("PML131", 5, "write controllable behind the name of each robot"),
        ("PML153", 5, "connect them, or take knock away from bot"),
        ("PML110", 7, "did you mean knock?"),
    ]),
    ("twice the same", """\
poi "desk"
poi "door"
poi "desk"
connect desk and door distance 3
connect door and desk distance 3
event "knock" location door
agent "bot" controllable mobile 1 location desk can_do knock, knock
reach_objective: do knock
reach_objective: do knock
""", [
        ("PML103", 3, "delete one"),
        ("PML146", 5, "delete one: a connection goes both ways"),
        ("PML156", 7, "delete one"),
        ("PML220", 9, "delete one of the two"),
    ]),
    ("a handover without a partner", """\
poi "desk"
poi "shelf"
event "handover" collaborative
agent "bot" controllable mobile 1 location desk can_do handover
agent "visitor" location shelf can_do handOver
reach_objective: do handover
""", [
        ("PML151", 3, "give another agent reacts_to handover, or delete collaborative"),
        ("PML110", 5, "did you mean handover? (capitals matter)"),
    ]),
    ("the end of an event as an event", """\
poi "desk"
event "wash" duration 5
event "dry" duration 3
rule "order": washDONE before dry
agent "bot" controllable location desk can_do wash, dry
reach_objective: do dryDONE
""", [
        ("PML110", 4, "write wash: with an event that takes time, its end counts by i"),
        ("PML110", 6, "write dry: with an event that takes time, its end counts by it"),
    ]),
    ("other words inside statements", """\
poi "desk"
poi "door"
connect desk to door distance 3
event "knock" at door
event "ring" in door
rule "order": knock then ring
agent "bot" controllable speed 2 location desk can knock, ring
reach_objective: knock
""", [
        ("PML010", 3, "did you mean and?"),
        ("PML010", 4, "did you mean location?"),
        ("PML010", 5, "did you mean location?"),
        ("PML010", 6, "did you mean before?"),
        ("PML010", 7, "did you mean can_do?"),
        ("PML010", 8, "the form is: reach_objective: do e1 and e2 after 10 within 60"),
    ]),
    ("human in front", """\
poi "desk"
event "sign"
human "nurse" controllable location desk can_do sign
reach_objective: do sign
""", [
        ("PML011", 3, 'it belongs to an agent: agent "bot" human controllable mobile '),
    ]),
    ("a colon too many", """\
poi: "desk"
event "ring"
agent "bot" controllable location: desk can_do: ring
reach_objective: do ring
""", [
        ("PML010", 1, 'delete the colon behind poi; the form is: poi "a"'),
        ("PML010", 3, 'delete the colon behind location; the form is: agent "bot" hum'),
    ]),
]  # fmt: skip


@pytest.mark.parametrize(("name", "text", "expected"), FILES, ids=[name for name, *_ in FILES])
def test_what_a_beginner_is_reported(name: str, text: str, expected: List[Told]) -> None:
    found = check_reading(read(text, "first.pur"))
    assert [(f.code, f.span.line if f.span else 0) for f in found] == [row[:2] for row in expected]
    for finding, (_, _, hint) in zip(found, expected):
        assert finding.hint.startswith(hint)
