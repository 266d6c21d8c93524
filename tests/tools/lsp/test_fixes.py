"""Quick fixes: each mends the finding it is for."""

from __future__ import annotations

import re
from typing import List

import pytest

from pursue_gen.diagnostics import Diagnostic
from pursue_gen.language.chunks import COMMENTS
from pursue_gen.language.document import edited
from pursue_gen.language.draft import Draft
from pursue_gen.tools.lsp.fixes import _PROPOSERS, Fix, fixes

from .scenarios import ROOT, SMALL


def found(text: str) -> List[Fix]:
    return list(fixes(Draft.of(text, "x.pur"), 0, len(text)))


def findings(text: str) -> List[Diagnostic]:
    return list(Draft.of(text, "x.pur").findings)


def changed(old: str, new: str) -> str:
    assert old in SMALL
    return SMALL.replace(old, new, 1)


def carrying(old: str = "", new: str = "") -> str:
    """A robot that takes a box where it works, and gives it to the man."""
    text = SMALL.replace("duration 3\n", "duration 3 takes box\n").replace("collaborative", "collaborative gives box")
    return text.replace(old, new, 1).replace('event "work"', 'thing "box"\nevent "work"')


POSE = "[0, 0, 0, 0, 0, 0, 1]"
PLACED_B = 'poi "b" //[3, 0, 0, 0, 0, 0, 1]'
MISTAKES = {
    "PML010 quotes": changed('event "rest"', "event rest"),
    "PML010 a name of two words": changed('poi "b"', 'poi "b"\npoi front door\nconnect b and front_door distance 1'),
    "PML010 quotes and a blank": changed("location b can_do rest", 'location "b!" can_do rest'),
    "PML010 curly quotes": changed('event "rest"', "event “rest”"),
    "PML010 no quotes": changed("location b can_do rest", 'location "b" can_do rest'),
    "PML010 colon": changed('rule "order": work', 'rule "order" work'),
    "PML010 colon behind objective": changed("objective: if", "objective if"),
    "PML010 comma": changed("can_do work, hand", "can_do work hand"),
    "PML010 comma in a state": changed("false, true_if", "false true_if"),
    "PML010 misspelt word": changed("controllable", "controlable"),
    "PML010 bracket": changed("work before hand", "(work before hand"),
    "PML010 bracket too many": changed("work before hand", "work before hand)"),
    "PML010 two words in a row": changed("work before hand", "work or rest before hand"),
    "PML010 objective: do": changed("reach_objective: do hand after 4", "objective: do hand"),
    "PML011": changed('poi "b"', 'pio "b"'),
    "PML012": changed('event "rest"', 'event "rest'),
    "PML012 with more behind": changed('event "work" location', 'event "work location'),
    "PML013": SMALL + "/* the end",
    "PML014": 'unit second\n' + changed("within 20", "within 2 minutes"),
    "PML014 without a blank": 'unit second\n' + changed("within 20", "within 2min"),
    "PML015": changed('poi "a"', 'poi\u200b "a"'),
    "PML017": changed('poi "b"', 'poi "b"\ncontrol: A<> x'),
    "PML022": changed('poi "a"', f'poi "a" //{POSE} bot {POSE}, bot {POSE} by the door').replace('poi "b"', PLACED_B),
    "PML122": changed('poi "a"', f'poi "a" //{POSE} man {POSE} bot [0, 1, 0, 0, 0, 0, 1]').replace('poi "b"', PLACED_B),
    "PML110 in a pose": changed('poi "a"', f'poi "a" //{POSE} bto {POSE}').replace('poi "b"', PLACED_B),
    "PML101": changed('poi "b"', 'poi "my b"').replace("location b", "location b"),
    "PML102": re.sub(r"\btired\b", "lambda", SMALL),
    "PML103": SMALL + 'poi "a"\n',
    "PML110": changed("do hand", "do hnd"),
    "PML110 undeclared place": SMALL.replace('poi "b"\n', ""),
    "PML110 undeclared event": SMALL.replace('event "rest"\n', ""),
    "PML110 undeclared state": SMALL.replace(SMALL.split("\n")[7] + "\n", ""),
    "PML110 in a way": changed("connect a and b", "connect a and bb"),
    "PML130": re.sub("agent .*\n", "", SMALL),
    "PML131": SMALL.replace("controllable ", ""),
    "PML132": "reach_objective: do e\n",
    "PML140": changed("distance 3", "distance 0"),
    "PML141": changed("duration 3", "duration 0"),
    "PML142": changed("mobile 2", "mobile 0"),
    "PML143": changed("within 20", "within 0"),
    "PML145": changed("distance 3\n", "distance 3\nconnect a and a distance 2\n"),
    "PML146": changed("distance 3\n", "distance 3\nconnect b and a distance 2\n"),
    "PML147": changed('poi "b"\n', 'poi "b"\npoi "attic"\n'),
    "PML150": changed("can_do work, hand", "can_do hand"),
    "PML150 nothing done yet": changed(" can_do rest reacts_to", " reacts_to"),
    "PML151": changed(" reacts_to hand", ""),
    "PML152": changed("can_do rest reacts_to hand", "can_do rest reacts_to hand, work"),
    "PML153 not mobile": changed(" mobile 2", ""),
    "PML153 no way": changed("connect a and b distance 3\n", ""),
    "PML155": changed("can_do work, hand", "can_do work, hand reacts_to hand"),
    "PML156": changed("can_do work, hand", "can_do work, hand, work"),
    "PML156 in front": changed("can_do work, hand", "can_do hand, hand, work"),
    "PML157": changed('event "rest"', 'event "ring" duration 2\nevent "rest"'),
    "PML158": changed('"hand" collaborative', '"hand" collaborative duration 3'),
    "PML159": changed('"work" location', '"work" together location'),
    "PML159 without a duration": changed('"hand" collaborative', '"hand" collaborative together'),
    "PML200": changed("duration 3", "duration 9 to 4"),
    "PML200 decimals": changed("duration 3", "duration 4.5 to 2"),
    "PML223 decimals": changed("do hand after 4", "do hand after 4.5 within 3"),
    "PML200 no width": changed("duration 3", "duration 4 to 4"),
    "PML200 a way": SMALL + "travel bot from a to b takes 7 to 5\n",
    "PML200 no time": SMALL + "travel bot from a to b takes 0\n",
    "PML201 not mobile": SMALL + "travel man from a to b takes 5\n",
    "PML201 no way": changed('poi "b"\n', 'poi "b"\npoi "c"\nconnect b and c distance 1\n')
    + "travel bot from a to c takes 5\n",
    "PML201 one way": changed('poi "b"\n', 'poi "b"\npoi "c"\nconnect b and c distance 1 one_way\n')
    + "travel bot from c to b takes 5\n",
    "PML202": SMALL + "travel bot from a to b takes 5\ntravel bot from a to b takes 6 // again\n",
    "PML204 never": changed('event "rest"', 'event "rest" at_most 0 times'),
    "PML204 too often": changed('event "rest"', 'event "rest" at_most 500 times only_if no robot at b'),
    "PML205": changed('rule "order"', 'rule "nap" for each robot: rest before ring\nrule "order"')
    .replace('event "rest"', 'event "rest"\nevent "ring"').replace("can_do rest", "can_do rest, ring"),
    "PML221": changed("reach_objective", "objective: avoid hand\nreach_objective"),
    "PML221 of several": changed("do hand after", "do hand and rest after") + "objective: avoid rest\n",
    "PML222": changed("do hand after", "do hand and hand after"),
    "PML222 of several": changed("do hand after", "do rest and hand and rest after"),
    "PML223": changed("do hand after 4", "do hand after 4 within 3"),
    "PML232": changed('event "rest"', 'event "rest" only_if bot at a or not bot at a'),
    "PML232 a way": changed("distance 3", "distance 3 only_if man at b"),
    "PML232 an objective": SMALL + "objective: always man at b // he sits there\n",
    "PML250": SMALL + "assume: bot does work at_most 2 times\n",
    "PML251 too often": SMALL + "assume: man does rest at_most 500 times\n",
    "PML251 no wait": SMALL + "assume: man waits 0 between rest\n",
    "PML251 too short": changed("location b can_do rest", "mobile 1 location b can_do rest")
    + "assume: man leaves b within 1\n",
    "PML252": SMALL + "assume: man never at b\n",
    "PML253": SMALL + "assume: man waits 4 between rest\nassume: man waits 5 between rest\n",
    "PML254": SMALL + "assume: man never at a\n",
    "PML254 an event": SMALL + "assume: man does work at_most 2 times\n",
    "PML220": SMALL + SMALL.rstrip().rsplit("\n", 1)[-1] + "\n",
    "PML267": SMALL + "objective: patrol b every 90 by bot or bot\n",
    "PML340": carrying("mobile 2", "mobile 2 carries 0"),
    "PML341": carrying(" takes box", "").replace('event "rest"', 'event "rest" takes box'),
    "PML342": carrying("takes box", "takes box gives box"),
    "PML343": carrying(" gives box", "").replace('event "rest"', 'event "rest" gives box'),
    "PML344": SMALL + 'thing "box" // it is here\n',
    "PML461": SMALL + 'door "d1" opens within 8 // it is shut\n',
    "PML472": SMALL + 'lift "lift1" at a, b comes within 40 takes 10 to 20 // it is out of order\n',
    "PML344 room": changed("mobile 2", "mobile 2 carries 2"),
    "PML320": changed("true_if work", "true_if work, rest"),
    "PML320 in a list": changed("true_if work false_if rest", "true_if work false_if work, rest"),
    "PML420": changed("within 20", "within 2 min"),
    "PML422": "unit second\nunit minute\n" + SMALL,
    "PML171": re.sub("(reach_)?objective.*\n", "", SMALL),
    "PML180": changed('agent "man"', 'agent "man" human'),
    "PML190": 'agent "early" location a // it waits\n' + SMALL,
}


@pytest.mark.parametrize("case", MISTAKES)
def test_each_proposal_mends_its_finding(case: str) -> None:
    text, code = MISTAKES[case], case.split(" ")[0]
    before = [f for f in findings(text) if f.code == code]
    assert before, [f.message for f in findings(text)]
    proposals = [fix for fix in found(text) if fix.finding.code == code]
    assert proposals
    for fix in proposals:
        after = findings(edited(text, fix.edits))
        assert fix.finding.message not in [f.message for f in after if f.code == code], fix.title
        syntax = [f.message for f in after if f.code < "PML1"]
        assert len(syntax) <= len([f for f in findings(text) if f.code < "PML1"]), (fix.title, syntax)


NEED_MORE = ("PML130", "PML132", "PML110 undeclared state")  # who moves, what happens: only a person can say


@pytest.mark.parametrize("case", [case for case in MISTAKES if case not in NEED_MORE])
def test_the_preferred_proposals_one_after_the_other_make_it_sound(case: str) -> None:
    text = MISTAKES[case]
    for _ in range(6):
        preferred = [fix for fix in found(text) if fix.preferred]
        if not preferred:
            break
        text = edited(text, preferred[0].edits)
    assert [f.message for f in findings(text)] == []


def test_every_mistake_that_has_a_fix_is_tried() -> None:
    assert {case.split(" ")[0] for case in MISTAKES} == set(_PROPOSERS)


def test_every_code_with_a_fix_exists() -> None:
    used = "".join(p.read_text(encoding="utf-8") for p in (ROOT / "pursue_gen" / "language").rglob("*.py"))
    assert all(f'"{code}"' in used for code in _PROPOSERS)


def test_only_findings_in_the_selection_are_mended() -> None:
    text = changed("distance 3", "distance 0").replace("duration 3", "duration 0")
    document = Draft.of(text, "x.pur")
    at = text.index("duration 0")
    assert {fix.finding.code for fix in fixes(document, at, at)} == {"PML141"}


def test_did_you_mean_comes_first() -> None:
    titles = [fix.title for fix in found(MISTAKES["PML110"])]
    assert titles[0] == "Write hand" and titles[-1] == 'Declare it: event "hnd"'


def test_sorting_keeps_every_statement_and_every_comment() -> None:
    text = """\
// A floor, drawn on a Monday.

agent "bot" controllable location a can_do e // the robot
// what happens
// and where
event "e" location a /* long
comment */
reach_objective: do e
control : A<>reachObj.win
poi "a" //[0, 0, 0, 0, 0, 0, 1]
"""
    (fix,) = [fix for fix in found(text) if fix.finding.code == "PML190"]
    after = edited(text, fix.edits)
    assert (
        after
        == """\
// A floor, drawn on a Monday.

poi "a" //[0, 0, 0, 0, 0, 0, 1]

// what happens
// and where
event "e" location a /* long
comment */

agent "bot" controllable location a can_do e // the robot

reach_objective: do e
control : A<>reachObj.win
"""
    )
    assert not findings(after)

    def told(text: str) -> List[str]:
        return sorted(str(t) for t in Draft.of(text, "x.pur").tokens if t.type in COMMENTS)

    assert told(after) == told(text)


def test_new_statements_stand_with_their_kind() -> None:
    (fix,) = [fix for fix in found(MISTAKES["PML147"]) if fix.finding.code == "PML147"]
    lines = edited(MISTAKES["PML147"], fix.edits).split("\n")
    assert lines[3:5] == ["connect a and b distance 3", "connect a and attic distance 1"]
