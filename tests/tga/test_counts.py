"""Events that can happen a limited number of times: an automaton counts them, and nobody does them once too often."""

from __future__ import annotations

from pursue_gen.tga import translate
from pursue_gen.tga.network import Test
from pursue_gen.vocabulary.words import words_of
from tests.tga.networks import scenario

TEXT = """
poi "hall"
event "call" at_most 2 times
event "work" duration 3 at_most 1 times
event "rest"
rule "order": call before work
agent "bot" controllable location hall can_do work, rest
agent "man" location hall can_do call, rest
agent "boy" location hall can_do call
objective: if call then work within 9
"""


def test_what_has_no_limit_has_no_count() -> None:
    made = translate(scenario(TEXT))
    assert [automaton.name for automaton in made.automata] == [
        "bot", "man", "boy", "obj", "order", "call_count", "work_count",
    ]  # fmt: skip
    assert {"Pcall_count", "Pwork_count"} <= {name for name, _ in made.variables}


def test_each_beginning_counts_and_none_is_one_too_many() -> None:
    made = translate(scenario(TEXT))
    count = made.automaton("call_count")
    assert [(edge.source, edge.target, edge.assign) for edge in count.edges] == [
        ("call_count_0", "call_count_1", (("Pcall_count", 1),)),
        ("call_count_1", "call_count_2", (("Pcall_count", 2),)),
    ]
    for agent in ("man", "boy"):
        guards = [e.guard.integers for e in made.automaton(agent).edges if e.sync and e.sync.channel == "call"]
        assert guards and all((Test("Pcall_count", 0), Test("Pcall_count", 1)) in guard for guard in guards)
    (begin,) = (e for e in made.automaton("bot").edges if e.sync and e.sync.channel == "work")
    assert (Test("Pwork_count", 0),) in begin.guard.integers
    (end,) = (e for e in made.automaton("bot").edges if e.sync and e.sync.channel == "workDONE")
    assert all(test.variable != "Pwork_count" for clause in end.guard.integers for test in clause)


def test_the_count_in_words() -> None:
    read = scenario(TEXT)
    words = words_of(read, translate(read))
    assert words.place("call_count", "call_count_1") == "1 of 2 times"
