"""What holds for each kind of statement: its text, its forms, its words."""

from __future__ import annotations

import re
from dataclasses import fields, is_dataclass
from typing import Any, Dict, Iterator, List, Type

import pytest

from pursue_gen.language import parse
from pursue_gen.language.conditions import names_in
from pursue_gen.language.document import Document
from pursue_gen.language.kinds import BY_RULE, DECLARED, KEYWORDS, MAY_BE_NAMES, MEANINGS, STATEMENTS
from pursue_gen.language.occurrences import GROUP, VARIABLE, are_names, occurrences
from pursue_gen.language.parser import read
from pursue_gen.language.scenario import Scenario
from pursue_gen.language.statements.base import StatementKind
from pursue_gen.language.statements.event import Event
from pursue_gen.language.statements.group import ForEach
from pursue_gen.language.word import HOLE

STORY = """\
unit second
rest 0.5
poi "a" label "the hall" //[1, 2, 0, 0, 0, 0, 1] bot [3, 4, 0, 0, 0, 0, 1]
poi "b"
poi "c"
connect a and b distance 3 one_way only_if open is_true
door "d1" label "glass door" opens within 8 s //[2, 2, 0, 0, 0, 0, 1]
connect b and a distance 2.5 through d1
lift "lift1" label "goods" at a, c comes within 40 s takes 10 to 20 s //[2, 2, 0, 0, 0, 0, 1] c [2, 2, 3, 0, 0, 0, 1]
connect a and c distance 4 by lift1
thing "box" label "parcel"
event "work" collaborative together location a duration 6 to 9 at_most 2 times only_if not (bot on_way)
event "first" label "do it" duration 3
thing "brush"
event "second" takes box gives box mounts brush needs brush
rule "order" for each robot: (first before second) before (work or second)
rule "turns" for each agent: first and second
rule "plain": first before second
state "open": initially false, true_if first, second false_if work
state "shut": initially true, false_if first
stateDependency: second only_if open is_false
agent "bot" label "Porter 1" controllable mobile 3 radius 0.2 tolerance 0.1 location a can_do work, first
agent "ally" human controllable carries 2 has box, box location b reacts_to work
agent "courier" speed 0.5 location b
agent "guest" mobile 0.5 location b can_do second
travel "bot" from a to b takes 5 to 8
travel "guest" from b to a takes 4
battery "bot" capacity 100 uses 2 per unit recharges 5 per unit at a
assume: guest does second at_most 2 times
objective: if first then second within 20
mission ends after 480 when all is answered
"""

BESIDE = {"GROUP": '\npoi "room1"\npoi "room2"', "FOR": '\npoi "a"\ngroup "rooms": a'}
"""What has to be declared beside an example."""

each_kind = pytest.mark.parametrize("kind", list(STATEMENTS.values()), ids=list(STATEMENTS))


def all_kinds(of: Type[StatementKind] = StatementKind) -> Iterator[Type[StatementKind]]:
    for kind in of.__subclasses__():
        yield from [kind] if not kind.__subclasses__() else []
        yield from all_kinds(kind)


def declared(scenario: Scenario) -> List[Any]:
    """What statements declare that declare one thing."""
    parts = [part for field in fields(scenario) for part in getattr(scenario, field.name) if field.name != "text"]
    return [part for part in parts if isinstance(part, StatementKind)]


def meaning(part: Any) -> Dict[str, Any]:
    """Its fields but for places in the text."""
    return {field.name: re.sub(r"Span\([^)]*\)", "", repr(getattr(part, field.name))) for field in fields(part)}


def examples(kind: Type[StatementKind]) -> List[str]:
    """The statements in the form that messages show, without what that says about them in brackets."""
    return [re.split(r"(?<!not) \(", text)[0].strip() for text in kind.form().split(" · ")]


def test_every_kind_is_in_the_list_once() -> None:
    assert set(STATEMENTS.values()) == set(BY_RULE.values()) == set(all_kinds())
    words = [word.token for kind in STATEMENTS.values() for word in kind.own_words]
    assert len(words) == len(set(words)), "a word belongs to the first kind that has it"


def test_what_a_statement_declares_is_written_as_it_is_read() -> None:
    scenario = parse(STORY, "story.pur", "story")
    kinds = {type(part) for part in declared(scenario)}
    assert kinds == {kind for kind in STATEMENTS.values() if is_dataclass(kind)}, "the story has each of them"
    again = parse("\n".join(part.text for part in declared(scenario)), "story.pur", "story")
    assert list(map(meaning, declared(again))) == list(map(meaning, declared(scenario)))


def test_it_uses_the_names_that_editors_find_in_its_text() -> None:
    for part in declared(parse(STORY, "story.pur", "story")):
        condition = getattr(part, "only_if", None)
        used = [*part.names(), *(names_in(condition) if condition is not None else ())]
        found = [each for each in occurrences(Document(part.text).statements) if not each.declares]
        assert {(kind, ref.name) for kind, ref in used} == {(each.kind, each.name) for each in found}, part.text


@each_kind
def test_the_form_that_messages_show_is_a_statement_of_the_kind(kind: Type[StatementKind]) -> None:
    for text in examples(kind):
        document = Document(text + BESIDE.get(kind.token(), ""))
        assert document.syntax.findings == ()
        assert document.syntax.trees[0].data == (kind.rule() if kind is not ForEach else Event.rule())
        assert document.statements[0].tokens[0].type == kind.token()


@each_kind
def test_its_shortest_declaration_declares_a_name_and_no_more(kind: Type[StatementKind]) -> None:
    text = kind.shortest.format(name="new", place="a")
    if text:
        part = next(each for each in declared(read(f"poi \"a\"\n{text}", "story.pur").partial) if each.name == "new")
        assert (type(part), part.name) == (kind, "new") and part.text == text


@each_kind
def test_every_name_in_it_stands_for_something(kind: Type[StatementKind]) -> None:
    for text in examples(kind):
        statements = Document(text).statements
        tokens = statements[0].tokens
        names = [str(token) for token, is_name in zip(tokens, are_names(tokens)) if is_name and kind is not ForEach]
        known = [occurrence for occurrence in occurrences(statements) if occurrence.kind not in (GROUP, VARIABLE)]
        assert sorted(names) == sorted(occurrence.name for occurrence in known if not occurrence.declares)
        assert (kind.token() in DECLARED) == any(occurrence.declares for occurrence in known)


@each_kind
def test_its_words_are_words_of_the_language(kind: Type[StatementKind]) -> None:
    for word in kind.own_words:
        assert (KEYWORDS[word.token], MEANINGS[word.token]) == (word.text, word.meaning) and word.meaning.endswith(".")
        assert word.may_be_name == (word.token in MAY_BE_NAMES)
    for text in (*kind.used(), *kind.conditions_behind(), *(kind.second)):
        assert text.upper() in KEYWORDS, text
    assert not kind.among or kind.among in STATEMENTS
    assert all(part in KEYWORDS or part == "POSE" for part in kind.parts)


@each_kind
def test_its_forms_ask_for_things_that_there_are(kind: Type[StatementKind]) -> None:
    assert kind.forms and len({form.title for form in kind.forms}) == len(kind.forms)
    things = {"POI", "event", "state", "agent", "group", "thing", "door", "lift"}
    for form in kind.forms:
        assert all(example or what in things for example, what in HOLE.findall(form.words)), form
