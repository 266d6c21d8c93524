"""What is offered while a scenario is written."""

from __future__ import annotations

import re
from typing import List

import pytest
from hypothesis import given
from hypothesis import strategies as st

from pursue_gen.language.chunks import COMMENTS
from pursue_gen.language.document import Edit, edited
from pursue_gen.language.draft import Draft
from pursue_gen.language.kinds import KEYWORDS, MEANINGS, STATEMENTS
from pursue_gen.language.parser import read
from pursue_gen.language.syntax import accepts
from pursue_gen.tools.lsp.completion import complete, fill_in

from .scenarios import SCENARIOS, SMALL, marked


def labels(text: str, kind: str = "") -> List[str]:
    plain, at = marked(text)
    return [item.label for item in complete(Draft.of(plain, "x.pur"), at) if not kind or item.kind == kind]


WHOLE = SMALL + "{}"
WHERE = ["collaborative", "location", "duration"]
MOVES = ["may_stop", "takes", "gives", "mounts", "needs"]
SIZE = ["speed", "radius", "tolerance", "inflation", "carries", "has"]


@pytest.mark.parametrize(
    ("line", "names"),
    [
        ("connect |", ["a", "b"]),
        ("battery |", ["bot", "man"]),
        ("battery bot capacity 9 uses 1 per unit recharges 2 per unit at |", ["a", "b"]),
        ("optional 1 reach_objective: do |", ["work", "hand", "rest"]),
        ("optional 1 objective: patrol |", ["a", "b"]),
        ("connect a and |", ["b"]),
        ('event "new" location |', ["a", "b"]),
        ('rule "new": |', ["work", "hand", "rest"]),
        ('rule "new": (work before |', ["hand", "rest"]),
        ('rule "new": (work and |', ["hand", "rest"]),
        ('rule "new" for each robot: |', ["work", "hand", "rest"]),
        ('state "new": initially true, true_if |', ["work", "hand", "rest"]),
        ("stateDependency: |", ["work", "hand", "rest"]),
        ("stateDependency: work only_if |", ["tired"]),
        ('agent "new" location |', ["a", "b"]),
        ('agent "new" controllable radius 0.2 location |', ["a", "b"]),
        ('agent "new" location a can_do |', ["work", "hand", "rest"]),
        ('agent "new" location a can_do work, |', ["hand", "rest"]),
        ('agent "new" location a can_do work, re|', ["hand", "rest"]),
        ('agent "new" location a can_do work reacts_to |', ["hand"]),  # the only collaborative one
        ("travel |", ["bot", "man"]),
        ("travel bot from |", ["a", "b"]),
        ("travel bot from a to |", ["b"]),
        ("travel bot from a to b takes |", []),
        ("objective: |", ["bot", "man"]),
        ("objective: bot never_with |", ["man"]),
        ("assume: not |", ["bot", "man", "tired"]),
        ("assume: not (bot at |", ["a", "b"]),
        ("objective: if |", ["work", "hand", "rest", "bot", "man", "tired"]),
        ("objective: if bot at |", ["a", "b"]),
        ("objective: if bot at a then |", ["work", "hand", "rest", "bot", "man", "tired"]),
        ("objective: if bot at a then man at |", ["a", "b"]),
        ("objective: if bot at a then hand within |", []),
        ("objective: avoid |", ["work", "hand", "rest", "bot", "man", "tired"]),
        ("objective: always |", ["bot", "man", "tired"]),
        ("objective: avoid bot at |", ["a", "b"]),
        ("objective: bot never_with man at |", ["a", "b"]),
        ("reach_objective: do |", ["work", "hand", "rest"]),
        ("connect a and b distance |", []),
        ("event |", []),
    ],
)
def test_names_that_fit(line: str, names: List[str]) -> None:
    assert labels(WHOLE.format(line), "name") == names


ROBOTS = 'agent "bot1" controllable location a\nagent "bot2" controllable location a\nagent "man" location a\n'


@pytest.mark.parametrize(
    ("comment", "names"),
    [
        ("//[1, 2, 0, 0, 0, 0, 1] |", ["bot1", "bot2"]),
        ("//[1, 2, 0, 0, 0, 0, 1], b|", ["bot1", "bot2"]),
        ("//[1, 2, 0, 0, 0, 0, 1] bot2 [1, 3, 0, 0, 0, 0, 1] |", ["bot1"]),
        ("//[1, 2, 0, | 0, 0, 0, 1]", []),
        ("//|[1, 2, 0, 0, 0, 0, 1]", []),
        ("//[1, 2, 0, 0, 0, 0, 1] the hall |", []),
        ("// the hall |", []),
    ],
)
def test_robots_that_may_have_a_pose_of_their_own(comment: str, names: List[str]) -> None:
    assert labels(f'poi "a" {comment}\n{ROBOTS}', "name") == names


def test_a_robots_pose_begins_with_that_of_the_place() -> None:
    plain, at = marked(f'poi "a" //[1, 2, 0, 0, 0, 0, 1] bo| the hall\n{ROBOTS}')
    item = complete(Draft.of(plain, "x.pur"), at)[1]
    changed = edited(plain, (Edit(item.start, item.end, item.insert),))
    assert changed.splitlines()[0] == 'poi "a" //[1, 2, 0, 0, 0, 0, 1] bot2 [1, 2, 0, 0, 0, 0, 1] the hall'
    assert read(changed, "x.pur").diagnostics == ()


@pytest.mark.parametrize(
    ("line", "words"),
    [
        ("connect a |", ["and"]),
        ('event "new" |', ["label", *WHERE, "on_order", *MOVES, "at_most", "in", "only_if"]),
        ('event "new" collaborative loc|', ["together", *WHERE[1:], *MOVES, "at_most", "in", "only_if"]),
        ('event "new" collaborative together |', ["location", "duration", *MOVES, "at_most", "in", "only_if"]),
        ('agent "new" |', ["label", "location", "human", "controllable", "mobile", *SIZE]),
        ('agent "new" label "a" |', ["location", "human", "controllable", "mobile", *SIZE]),
        ('agent "new" label |', []),
        ('agent "new" location a |', ["or", "can_do", "reacts_to"]),
        ('state "new": initially |', ["true", "false", "unknown"]),
        ("objective: |", ["if", "avoid", "always", "patrol", "place", "way", "at_least", "escort"]),
        ("objective: patrol a, b |", ["in", "every", "by"]),
        ("objective: patrol a, b in |", ["order"]),
        ('rule "new": work |', ["and", "before", "or"]),
        ("stateDependency: work only_if tired |", ["is_true", "is_false"]),
        ("reach_objective: do work |", ["and", "within", "at_least", "twice", "after"]),
        ("nonsense here |", []),
    ],
)
def test_words_that_may_come_next(line: str, words: List[str]) -> None:
    assert labels(WHOLE.format(line), "word") == words


def test_signs_and_values() -> None:
    assert labels('rule "r" |', "sign") == [":"]
    assert labels('rule "r": |', "sign") == ["("]
    assert labels("poi |", "value") == ['"a"']
    assert labels('poi "a" |', "value") == ["//[0, 0, 0, 0, 0, 0, 1]"]
    assert labels('poi "a"\n|', "value") == []  # a pose stands on the line of its place


def test_units_stand_behind_times_where_the_scenario_has_a_unit() -> None:
    timed = 'unit second\npoi "a"\n'
    for words in ('event "e" duration 5 ', "travel b from a to c takes 5 to 8 ", "objective: if e then f within 2 "):
        assert [label for label in labels(f"{timed}{words}|", "value") if label in "s min h"] == ["s", "min", "h"]
    assert not {"s", "min"} & {*labels('poi "a"\nevent "e" duration 5 |')}
    assert labels(f"{timed}connect a and b distance 5 |", "value") == ["m", "cm"]
    assert not {"m", "cm"} & {*labels('poi "a"\nconnect a and b distance 5 |')}
    assert {"m", "cm"} <= {*labels('poi "a"\nagent "b" controllable mobile 1 radius 20 |')}
    assert not {"s", "min"} & {*labels(timed + 'event "e" duration 5 min |')}
    assert labels("unit |", "word") == ["second", "minute", "hour"]


def test_statements_begin_at_the_beginning_and_behind_a_complete_one() -> None:
    for text in ("|", "po|", 'poi "a"\n|', 'poi "a" |', "connect a and\n|"):
        assert len(labels(text, "statement")) == sum(len(kind.forms) for kind in STATEMENTS.values())
    assert labels("connect a and |", "statement") == []


def test_between_the_quotes_of_a_declaration_stand_names_that_are_used_only() -> None:
    uses = 'event "w" location there\nagent "x" location there can_do e\n'
    for text in (uses + 'poi "|', uses + 'poi "|"', uses + 'poi "th|"'):
        plain, at = marked(text)
        (item,) = complete(Draft.of(plain, "x.pur"), at)
        assert edited(plain, (Edit(item.start, item.end, item.insert),)).endswith('poi "there"')
    assert labels(uses + 'event "|') == ["e"]


@pytest.mark.parametrize("text", ["// po|", "/* p| */", 'poi "a" //[1, |', "/* never closed |"])
def test_nothing_is_offered_in_comments(text: str) -> None:
    assert labels(text) == []


def test_a_place_may_be_called_together() -> None:
    text = 'poi "together"\nevent "e" collaborative together location |'
    assert labels(text, "name") == ["together"] and labels(text, "word") == []


@pytest.mark.parametrize(
    ("condition", "names", "words"),
    [
        ("|", ["bot", "man", "tired"], ["at_most", "not", "any", "no"]),
        ("b|", ["bot", "man", "tired"], ["at_most", "not", "any", "no"]),
        ("bot |", [], ["is_true", "is_false", "at", "on_way", "between", "doing", "has"]),
        ("bot on_way |", [], ["and", "or", "from"]),
        ("bot on_way from |", ["a", "b"], []),
        ("bot on_way from a to |", ["a", "b"], []),
        ("bot between |", ["a", "b"], []),
        ("bot between a and |", ["a", "b"], []),
        ("bot between a and b and |", ["bot", "man", "tired"], ["at_most", "not", "any", "no"]),
        ("at_most 2 |", [], ["of", "robots", "robot", "agents"]),
        ("at_most 2 robots |", [], ["at", "on_way", "between", "doing"]),
        ("at_most 2 of |", ["bot", "man", "tired"], ["robots"]),
        ("at_most 2 of bot, |", ["bot", "man", "tired"], []),
        ("at_most 2 of bot, man at |", ["a", "b"], ["any"]),
        ("at_most 2 of bot, man at a, |", ["a", "b"], []),
        ("bot at |", ["a", "b"], []),
        ("not bot doing |", ["work", "hand", "rest", "new"], []),
        ("bot at a and (|", ["bot", "man", "tired"], ["at_most", "not", "any", "no"]),
        ("bot at a and bot at |", ["a", "b"], []),
        ("no robot at |", ["a", "b"], []),
        ("any |", [], ["is_true", "is_false", "at", "on_way", "between", "doing", "has", "robot"]),
        ("tired |", [], ["is_true", "is_false", "at", "on_way", "between", "doing", "has"]),
    ],
)
def test_what_comes_next_in_a_condition(condition: str, names: List[str], words: List[str]) -> None:
    line = WHOLE.format(f'event "new" only_if {condition}')
    assert labels(line, "name") == names
    assert [word for word in labels(line, "word") if word != "agent"] == words


def test_an_agent_may_be_called_human() -> None:
    assert labels('agent "human" location a\nobjective: |', "name") == ["human"]
    assert "human" not in labels('agent "human" location a\nobjective: |', "word")


def test_a_name_in_the_middle_of_a_word_replaces_all_of_it() -> None:
    plain, at = marked(SMALL.replace("then hand", "then ha|nx"))
    item = next(item for item in complete(Draft.of(plain, "x.pur"), at) if item.label == "hand")
    assert "if work then hand within" in edited(plain, (Edit(item.start, item.end, item.insert),))


@given(st.sampled_from(sorted(SCENARIOS)), st.data())
def test_after_every_prefix_of_a_scenario_what_comes_next_is_offered(name: str, data: st.DataObject) -> None:
    document = Draft.of(SCENARIOS[name], name + ".pur")
    plain = [part for part in document.statements if part.kind not in ("FOR", "GROUP")]  # no grammar has those words
    part = data.draw(st.sampled_from(plain))
    index = data.draw(st.integers(0, len(part.tokens) - 1))
    token = part.tokens[index]
    at = token.start_pos or 0
    typed = data.draw(st.integers(0, len(token) - 1)) if token.type == "WORD" or token.type in KEYWORDS else 0
    before = document.text[:at]
    if before and not before[-1].isspace():
        before += " "  # a word that one is still writing is completed, else
    text = before + str(token)[:typed]
    at = len(before)
    if data.draw(st.booleans()) and not typed:
        text += document.text[at:]  # what follows is there already
    named = [p for p in document.statements if p.name is not None and p.kind != "BATTERY"]  # a robot has one battery
    declarations = "\n".join(document.text[p.start : p.end] for p in named)
    offered = complete(Draft.of(text + "\n" + declarations, name + ".pur"), at + typed)
    if token.type == "TAIL":
        return  # understood, but nobody should write it
    assert token.type in accepts(part.tokens[:index])
    unquoted = {"WORD"} if token.type == "NAME" and part.kind in ("BATTERY", "TRAVEL") else set()
    same = [item for item in offered if item.token in {token.type} | unquoted]
    assert same, f"{token!r} behind {text[max(0, at - 40) : at]!r}"
    if token.type == "WORD":
        assert str(token) in [item.label.partition(" of ")[0] for item in same]  # or all of a family: look of rooms


@given(st.sampled_from(sorted(SCENARIOS)), st.data())
def test_whatever_is_offered_is_accepted(name: str, data: st.DataObject) -> None:
    document = Draft.of(SCENARIOS[name], name + ".pur")
    part = data.draw(st.sampled_from(document.statements))
    index = data.draw(st.integers(1, len(part.tokens)))
    at = (part.tokens[index - 1].start_pos or 0) + len(part.tokens[index - 1])
    before = document.text[:at] + " "
    for item in complete(Draft.of(before, name + ".pur"), at + 1):
        assert item.token in accepts(part.tokens[:index]) or "$END" in accepts(part.tokens[:index])


def expanded(snippet: str) -> str:
    """A snippet as it stands when one accepts every hole's default."""
    return re.sub(r"\$\{\d+\|([^,|]*)[^}]*\}", r"\1", re.sub(r"\$\{\d+:([^}]*)\}", r"\1", snippet))


def test_statements_to_fill_in_are_well_formed() -> None:
    robots = "".join(f'\nagent "robot{number}" controllable location a' for number in (1, 2))
    groups = '\npoi "a"\npoi "b"\ngroup "rooms": a' + robots
    needed = {"GROUP": '\npoi "a"', "FOR": groups}
    names = {kind: list(names) for kind, names in Draft.of(SMALL, "x.pur").declared.items()}
    for token, statement in STATEMENTS.items():
        for form in statement.forms:
            for text in (fill_in(form.words, {}, plain=True), expanded(fill_in(form.words, names))):
                assert read(text + needed.get(token, ""), "x.pur").diagnostics == (), text
                assert text.startswith(KEYWORDS[token])


def test_a_form_that_asks_twice_offers_two_names() -> None:
    assert expanded(fill_in("connect {POI} and {POI}", {"POI": ["a", "b"]})) == "connect a and b"


def test_every_word_has_a_meaning() -> None:
    assert set(MEANINGS) == set(KEYWORDS)
    assert not COMMENTS & set(KEYWORDS)
