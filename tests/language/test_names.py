"""Names that cannot stand in a ROS workspace are refused, and never changed behind the author's back."""

from __future__ import annotations

import keyword
from typing import Dict, Iterator, List, Tuple

import pytest
from hypothesis import given
from hypothesis import strategies as st

from pursue_gen.language import parse
from pursue_gen.language.names import GENERATED, check_collisions, proposal
from pursue_gen.language.scenario import Scenario

from .texts import STATEMENTS, findings, text

RULE, MAN = STATEMENTS["rule"], STATEMENTS["agent man"]
AMBIGUOUS = """poi "b" poi "c" poi "b_to_c" poi "a_to_b"
connect a and b_to_c distance 1 connect a_to_b and c distance 1 connect a and c distance 1"""


@pytest.mark.parametrize("name", ["", " ", "my robot", "2nd", "bot-1", "_bot", "büro", "a/b", "a.b", "x" * 61])
@pytest.mark.parametrize("kind", ["poi a", "event rest", "rule", "state", "agent man"])
def test_malformed_names(kind: str, name: str) -> None:
    old = STATEMENTS[kind].split('"')[1]
    found = findings(text(**{kind.replace(" ", "_"): STATEMENTS[kind].replace(f'"{old}"', f'"{name}"')}))
    finding = next(finding for finding in found if finding.code == "PML101")
    assert finding.span is not None and finding.span.line == list(STATEMENTS).index(kind) + 1
    assert finding.hint


def test_a_malformed_name_gets_a_proposal() -> None:
    (finding,) = findings(text(rule=RULE.replace("order", "my order")))
    assert "my_order" in finding.hint


UNUSABLE = [
    "security door",
    "class!",
    "going to bed",
    "the DONE",
    "büro",
    "2nd",
    "if?",
    "observer.",
    "doing_going_",
    "x" * 59 + " y",
]


@pytest.mark.parametrize("name", UNUSABLE)
def test_the_proposed_name_is_accepted(name: str) -> None:
    (finding,) = findings(text(rule=RULE.replace("order", name)))
    proposed = finding.hint.split("for example ")[1]
    assert findings(text(rule=RULE.replace("order", proposed))) == []


@given(st.text(min_size=1, max_size=70).filter(lambda name: not set('"\n\r') & set(name)))
def test_whatever_the_name_its_proposal_is_accepted(name: str) -> None:
    proposed = proposal(name, ("a", "b", "work", "hand", "rest", "tired", "bot", "man"))
    assert findings(text(rule=RULE.replace("order", proposed))) == []
    assert proposal(proposed) == proposed


def test_a_proposal_is_no_name_that_stands_for_something_else() -> None:
    (finding,) = findings(text(rule=RULE.replace("order", "the order") + '\nrule "the_order": work before rest'))
    assert finding.hint.endswith("for example the_order1")


@pytest.mark.parametrize(
    ("statement", "hint"),
    [
        ("connect a and securitydoor distance 3", "did you mean security_door?"),
        ("poi front door", 'poi "front_door"'),
        ("poi class", 'poi "class1"'),
        ('event "knock" location "security door"', "write security_door without them"),
        ("connect a and going_home distance 3", 'declare it with another name: poi "home"'),
        ("connect a and lake distance 3", 'declare it: poi "lake", or use one of: a, b, security_door'),
    ],
)
def test_every_hint_proposes_a_usable_name(statement: str, hint: str) -> None:
    found = findings(text(poi_b='poi "b"\npoi "security door"', more=statement))
    assert [hint in finding.hint for finding in found if finding.code in ("PML010", "PML110")] == [True]


TAKEN = [*sorted(GENERATED), "workDONE", "going_home", "doing_well", "before", "poi", *keyword.kwlist]


@pytest.mark.parametrize("name", TAKEN)
def test_names_that_are_taken(name: str) -> None:
    found = findings(text(rule=RULE.replace("order", name)))
    assert [(finding.code, finding.span and finding.span.line) for finding in found] == [("PML102", 7)]
    assert name in found[0].message and found[0].hint


def test_a_reserved_word_gets_a_proposal_that_is_free() -> None:
    (finding,) = findings(text(rule=RULE.replace("order", "lambda")))
    assert "for example lambda1" in finding.hint
    assert findings(text(rule=RULE.replace("order", "lambda1"))) == []


def test_a_way_to_nowhere_is_reported_where_it_names_that() -> None:
    (finding,) = findings(text(connect="connect a and bb distance 3"))
    span = finding.span
    assert finding.code == "PML110" and span is not None and (span.column, span.end_column) == (15, 17)


@pytest.mark.parametrize("name", ["human", "DONE_work", "Going_home", "base", "win", "A", "going", "waitDone"])
def test_names_that_look_alike_are_free(name: str) -> None:
    assert findings(text(rule=RULE.replace("order", name))) == []


def test_a_name_twice_is_reported_at_the_second_place() -> None:
    (finding,) = findings(text(poi_b='poi "b"\npoi "b"'))
    assert finding.code == "PML103" and finding.span is not None and finding.span.line == 3
    assert "line 2" in finding.message


@pytest.mark.parametrize("name", ["a", "work", "tired", "bot"])
def test_a_name_for_two_kinds(name: str) -> None:
    (finding,) = findings(text(rule=RULE.replace("order", name)))
    assert finding.code == "PML104"
    assert "a name stands for one thing" in finding.message


@pytest.mark.parametrize(
    ("changes", "word"),
    [
        ({"event_rest": 'event "rest" event "bot_a2b"', "agent_man": MAN.replace("rest", "rest, bot_a2b")}, "bot_a2b"),
        ({"rule": RULE.replace("order", "Cbot")}, "Cbot"),
        ({"rule": RULE.replace("order", "Pman")}, "Pman"),
        ({"rule": RULE.replace("order", "Stired")}, "Stired"),
        ({"rule": RULE.replace("order", "Creach")}, "Creach"),
        ({"agent_man": MAN.replace("man", "reach")}, "Creach"),
        ({"rule": RULE + '\nrule "Porder": work before rest'}, "Porder"),
        ({"rule": RULE.replace("order", "obj2"), "more": "objective: avoid rest"}, "obj2"),
        ({"rule": RULE.replace("order", "Creach2"), "more": "reach_objective: do rest"}, "Creach2"),
        ({"poi_b": 'poi "b" poi "a2a" connect a and a2a distance 1'}, "bot_a2a2a"),
        ({"poi_b": AMBIGUOUS}, "going_a_to_b_to_c"),
    ],
)  # fmt: skip
def test_names_from_which_one_word_would_be_made_twice(changes: Dict[str, str], word: str) -> None:
    found = [finding for finding in findings(text(**changes)) if finding.code == "PML105"]
    assert [word in finding.message for finding in found] == [True]


def test_the_names_of_further_objectives_are_taken_where_there_are_such() -> None:
    for name in ("obj2", "reachObj2", "obj7"):
        assert findings(text(agent_man=MAN.replace("man", name))) == []
    found = findings(text(agent_man=MAN.replace("man", "reachObj2"), more="reach_objective: do rest"))
    assert [finding.code for finding in found] == ["PML105"]


@pytest.mark.parametrize("name", ["assume1", "assume1count", "Cassume1"])
def test_the_names_of_assumptions_are_taken_where_there_are_such(name: str) -> None:
    event, doer = f'event "rest"\nevent "{name}"', MAN.replace("rest", f"rest, {name}")
    assert findings(text(event_rest=event, agent_man=doer)) == []
    (finding,) = findings(text(event_rest=event, agent_man=doer, more="assume: man waits 4 between rest"))
    assert (finding.code, finding.span and (finding.span.line, finding.span.column)) == ("PML105", (7, 7))
    assert finding.message == f"{name} would mean both a part of an assumption and the event {name}"


def test_package_names_do_not_collide() -> None:
    source = text(agent_man='agent "x_bringup" location b can_do rest reacts_to hand')
    assert [finding.code for finding in findings(source, "controller_x")] == ["PML105"]
    assert findings(source, "another") == []


@pytest.mark.parametrize("stem", ["my floor", "2rooms", "one-officer", ".hidden"])
def test_a_file_name_that_cannot_become_a_package(stem: str) -> None:
    (finding,) = findings(text(), stem)
    assert finding.code == "PML106" and finding.span is None
    assert "rename the file to" in finding.hint


@given(st.text(min_size=1, max_size=12).filter(lambda name: not set('"\n\r') & set(name)))
def test_any_quoted_name_is_accepted_as_it_is_or_refused(name: str) -> None:
    found = findings(text(rule=RULE.replace('"order"', f'"{name}"')))
    acceptable = name.isascii() and name.replace("_", "a").isalnum() and name[0].isalpha()
    assert acceptable or [finding.code for finding in found] == ["PML101"]


# Words are found to collide exactly where one by one they do ----------------------------------------------------------

_BITS = ["a", "b", "2", "_", "2a", "_to_", "going_", "_in_", "DONE", "P"]
_PARTS = st.lists(st.sampled_from(_BITS), min_size=1, max_size=5)
_NAMES = _PARTS.map("".join).filter(lambda name: name[0].isalpha())


def _words(scenario: Scenario) -> Iterator[Tuple[int, str, Tuple[str, ...]]]:
    """Every word that the generator makes: the space of names it is in, the word, what it means."""
    for kind, parts in (("p", scenario.pois), ("e", scenario.events), ("a", scenario.agents)):
        for part in parts:
            yield 0, part.name, (kind, part.name)
    for event in scenario.events:
        yield 0, event.name + "DONE", ("end", event.name)
        for poi in scenario.pois if event.duration is not None else ():
            yield 1, f"doing_{event.name}_in_{poi.name}", ("doing", event.name, poi.name)
    for agent in scenario.agents:
        for sign in "PC":
            yield 0, sign + agent.name, (sign, agent.name)
    for way in scenario.connections:
        for a, b in ((way.a, way.b), (way.b, way.a)):
            yield 1, f"going_{a}_to_{b}", ("way", a, b)
            for agent in scenario.agents:
                yield 0, f"{agent.name}_{a}2{b}", ("leaves", agent.name, a, b)
                yield 0, f"{agent.name}_going_{a}_to_{b}2{b}", ("arrives", agent.name, a, b)


@given(
    st.lists(_NAMES, min_size=2, max_size=5, unique=True), st.lists(_NAMES, max_size=3), st.lists(_NAMES, max_size=4)
)
def test_collisions_are_found_where_words_collide(pois: List[str], events: List[str], agents: List[str]) -> None:
    source = "".join(f'poi "{name}"\n' for name in pois)
    source += "".join(f"connect {a} and {b} distance 1\n" for n, a in enumerate(pois) for b in pois[n + 1 :])
    source += "".join(f'event "{name}" duration 1\n' for name in dict.fromkeys(events))
    source += "".join(f'agent "{name}" mobile 1 location {pois[0]}\n' for name in dict.fromkeys(agents))
    scenario = parse(source, "test.pur")
    meanings: Dict[Tuple[int, str], Tuple[str, ...]] = {}
    twice = {
        word for space, word, meaning in _words(scenario) if meanings.setdefault((space, word), meaning) != meaning
    }
    found = [finding.message.split()[0] for finding in check_collisions(scenario)]
    assert bool(found) == bool(twice)
    assert twice.issuperset(found)
