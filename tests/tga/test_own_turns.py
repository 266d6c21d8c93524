"""Rules for each robot: every robot that they bind has its own turn, which its own edges test and set."""

from __future__ import annotations

from typing import List, Tuple

from pursue_gen.tga import translate
from pursue_gen.tga.network import Edge, Network, Test
from pursue_gen.vocabulary.statuses import statuses
from tests.tga.networks import scenario

CARTS = """
poi "hall" poi "plane"
connect hall and plane distance 4
event "load" location hall duration 2
event "unload" location plane
event "rest"
rule "bag" for each robot: load before (unload and rest)
agent "cart1" controllable mobile 1 location hall can_do load, unload, rest
agent "cart2" controllable mobile 1 location hall can_do load, unload, rest
agent "man" human controllable mobile 1 location hall can_do load
reach_objective: do unload
"""


def network() -> Network:
    return translate(scenario(CARTS))


def edges(agent: str, channel: str) -> List[Edge]:
    return [edge for edge in network().automaton(agent).edges if edge.sync and edge.sync.channel == channel]


def turns(agent: str, channel: str) -> List[Tuple[int, int]]:
    """The numbers from which and to which an agent's edges on a channel lead."""
    found = []
    for edge in edges(agent, channel):
        tests = [test for clause in edge.guard.integers for test in clause if test.variable.startswith("Pbag")]
        sets = [(name, value) for name, value in edge.assign if name.startswith("Pbag")]
        assert [test.variable for test in tests] == [name for name, _ in sets] == [f"Pbag_{agent}"]
        found.append((tests[0].value, sets[0][1]))
    return found


def test_each_robot_has_a_variable_and_no_automaton() -> None:
    made = network()
    assert [automaton.name for automaton in made.automata] == ["cart1", "cart2", "man", "reachObj"]
    assert [name for name, _ in made.variables if name.startswith("Pbag")] == ["Pbag_cart1", "Pbag_cart2"]


def test_an_edge_for_each_turn_tests_and_sets_the_number_of_its_own_agent() -> None:
    for cart in ("cart1", "cart2"):
        assert (turns(cart, "load"), turns(cart, "loadDONE")) == ([(0, 1)], [(1, 2)])
        assert sorted(set(turns(cart, "unload"))) == [(2, 4), (3, 0)]
        assert sorted(set(turns(cart, "rest"))) == [(2, 3), (4, 0)]


def test_who_is_not_bound_is_not_held_up() -> None:
    assert all("Pbag" not in str(edge) for edge in network().automaton("man").edges)
    for_all = translate(scenario(CARTS.replace("each robot", "each agent")))
    assert "Pbag_man" in {name for name, _ in for_all.variables}


def test_other_guards_and_what_is_set_stay() -> None:
    both = translate(scenario(CARTS.replace("reach", 'rule "all": load before unload\nreach')))
    (begin,) = (e for e in both.automaton("cart1").edges if e.sync and e.sync.channel == "load")
    assert begin.guard.integers == ((Test("Pall", 0),), (Test("Pbag_cart1", 0),))
    assert begin.assign == (("Pcart1", -11), ("Pbag_cart1", 1))


def test_turns_in_words() -> None:
    read = scenario(CARTS)
    first = next(iter(statuses(read, translate(read))))
    texts = list(first.texts.values())
    assert first.label == "bag of cart1" and texts[:3] == ["next: load", "load goes on", "next: unload or rest"]
