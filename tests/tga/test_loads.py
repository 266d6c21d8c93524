"""What agents carry in the network: one variable for each agent, which its own edges test and set."""

from __future__ import annotations

from typing import List, Tuple

from pursue_gen.tga import translate
from pursue_gen.tga.network import Edge, Network, Test
from pursue_gen.vocabulary.statuses import statuses
from tests.tga.networks import scenario

SHOP = """
poi "store" poi "shop"
connect store and shop distance 4
thing "box" label "parcel"
event "load" location store duration 2 takes box
event "unload" location shop gives box
agent "cart" controllable mobile 1 carries 2 location store can_do load, unload
agent "maid" human controllable mobile 1 location store can_do load, unload
agent "thief" mobile 1 location store can_do unload
reach_objective: do unload
"""


def network(text: str = SHOP) -> Network:
    return translate(scenario(text))


def edges(agent: str, channel: str, text: str = SHOP) -> List[Edge]:
    return [edge for edge in network(text).automaton(agent).edges if edge.sent == channel]


def steps(agent: str, channel: str, text: str = SHOP) -> List[Tuple[int, int]]:
    """The loads from which and to which an agent's edges on a channel lead."""
    found = []
    for edge in edges(agent, channel, text):
        (before,) = [clause for clause in edge.guard.integers if clause[0].variable == f"H{agent}"]
        then = [value for name, value in edge.assign if name == f"H{agent}"]
        found += [(test.value, then[0] if then else test.value) for test in before]
    return found


def test_who_is_bound_has_a_variable_and_there_is_no_automaton() -> None:
    made = network()
    assert [automaton.name for automaton in made.automata] == ["cart", "maid", "thief", "reachObj"]
    assert [(name, value) for name, value in made.variables if name[0] == "H"] == [("Hcart", 0), ("Hmaid", 0)]
    assert all("Hthief" not in str(edge) for edge in made.automaton("thief").edges)


def test_what_takes_time_tests_the_load_at_its_beginning_and_changes_it_at_its_end() -> None:
    assert (steps("cart", "load"), steps("cart", "loadDONE")) == ([(0, 0), (1, 1)], [(0, 1), (1, 2)])
    assert (steps("maid", "load"), steps("maid", "loadDONE")) == ([(0, 0)], [(0, 1)])
    assert len(edges("cart", "load")) == 1


def test_what_takes_no_time_does_both_at_once() -> None:
    assert sorted(steps("cart", "unload")) == [(1, 0), (2, 1)] and steps("maid", "unload") == [(1, 0)]


def test_all_things_share_the_room() -> None:
    text = SHOP.replace("reach", 'thing "bin" event "fetch" takes bin event "bring" gives bin\nreach')
    text = text.replace("can_do load, unload\n", "can_do load, unload, fetch, bring\n", 1)
    at_store = [edge for edge in edges("cart", "fetch", text) if edge.source == "store"]
    assert sorted(test.value for edge in at_store for test in edge.guard.integers[0]) == [0, 1, 2]
    labels = {status.of: status for status in statuses(scenario(text), network(text))}
    assert list(labels["Hcart"].texts.values()) == [
        "nothing", "1 of parcel", "1 of bin", "2 of parcel", "1 of parcel and 1 of bin", "2 of bin",
    ]  # fmt: skip
    assert labels["Hcart"].label == "load of cart" and len(labels["Hmaid"].texts) == 2


def test_several_at_once_are_one_step() -> None:
    text = SHOP.replace("takes box", "takes 2 box").replace("gives box", "gives 2 box")
    text = text.replace("mobile 1 l", "carries 2 l")
    assert (steps("cart", "load", text), steps("cart", "loadDONE", text)) == ([(0, 0)], [(0, 2)])
    assert steps("cart", "unload", text) == [(2, 0)]


def test_other_guards_stay() -> None:
    text = SHOP.replace("reach", 'rule "all": load before unload\nreach')
    (begin,) = edges("maid", "load", text)
    assert begin.guard.integers == ((Test("Pall", 0),), (Test("Hmaid", 0),))
