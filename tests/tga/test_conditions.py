"""Conditions in guards: they hold in a state of the network exactly where they hold of the agents' places."""

from __future__ import annotations

from typing import Dict, Set, Tuple

from hypothesis import given, settings
from hypothesis import strategies as st

from pursue_gen.language import parse
from pursue_gen.language.conditions import Condition, condition_text
from pursue_gen.proof.moves import Arena, State
from pursue_gen.tga import scenario_objective, translate
from pursue_gen.tga.network import Network
from pursue_gen.tga.uppaal import read_network, write_network
from pursue_gen.tools.simulation.meaning import holds
from tests.conditions import CONDITIONS, SCENARIO, with_only_if

OBJECTIVE = scenario_objective(parse(SCENARIO, "x.pur"))

_MOST = 150
"""States that are looked at in one network."""


def states_of(network: Network) -> "Dict[State, Set[str]]":
    """The first discrete states that moves lead to, whatever the clocks are, each with the channels sent in it."""
    arena = Arena(network, 1, idle_moves=True)
    found: Dict[State, Set[str]] = {}
    pending = [arena.initial]
    while pending and len(found) < _MOST:
        state = pending.pop(0)
        if state in found:
            continue
        found[state] = set()
        for move in arena.situation(state).moves:
            sync = move.moves[0].edge.sync
            found[state].add(sync.channel if sync else "")
            pending.append(move.target)
    return found


@given(CONDITIONS, st.sampled_from(["close", "open", "paint", "carry", "way"]))
@settings(max_examples=40)
def test_an_event_or_a_way_is_open_exactly_while_its_condition_holds(condition: Condition, what: str) -> None:
    scenario = parse(with_only_if({what: condition_text(condition)}), "x.pur")
    network, free = translate(scenario), Arena(translate(parse(SCENARIO, "x.pur")), 1, idle_moves=True)
    variables = [name for name, _ in network.variables]
    kept = [variables.index(name) for name, _ in free.network.variables]
    names = [automaton.name for automaton in network.automata]
    limited = {"anna_hall2shop", "anna_shop2hall", "dora_hall2shop", "dora_shop2hall", "bert_hall2shop"}
    limited = (limited | {"bert_shop2hall"}) if what == "way" else {what}
    for state, sent in states_of(network).items():
        locations, values = dict(zip(names, state[0])), dict(zip(variables, state[1]))
        told = holds(condition, scenario, locations, values)
        without = free.situation((state[0], tuple(state[1][k] for k in kept)))
        possible = {m.moves[0].edge.sync.channel if m.moves[0].edge.sync else "" for m in without.moves}
        assert sent == {channel for channel in possible if told or channel not in limited}


@given(CONDITIONS, st.booleans())
@settings(max_examples=40)
def test_an_objective_can_be_lost_exactly_where_its_condition_is_broken(condition: Condition, always: bool) -> None:
    text = SCENARIO + f"objective: {'always' if always else 'avoid'} {condition_text(condition)}\n"
    scenario = parse(text, "x.pur")
    network, broken = translate(scenario), scenario.safety[0].breaks.condition
    assert broken is not None
    names, variables = [a.name for a in network.automata], [name for name, _ in network.variables]
    for (places, values), sent in states_of(network).items():
        locations = dict(zip(names, places))
        if locations["obj"] == "idle":
            told = holds(broken, scenario, locations, dict(zip(variables, values)))
            assert ("" in sent) >= told
            moves = Arena(network, 1, idle_moves=True).situation((places, values)).moves
            assert any(move.moves[0].edge.target == "lose" and not move.controllable for move in moves) is told


def _inside(location: str, places: Tuple[str, ...]) -> bool:
    """At one of these places, or on a way between two of them, by the text of a location."""
    at = location.split("_")
    named = at[1::2] if at[0] == "going" else at[-1:]
    return set(named) <= set(places)


@given(
    st.sampled_from([("place hall", ("hall",)), ("place shop", ("shop",)), ("place shop, yard", ("shop", "yard")),
                     ("place yard, hall, shop", ("yard", "hall", "shop")), ("way shop to hall", ("hall", "shop"))]),
    st.integers(0, 3),
    st.sampled_from([("robot", "anna bert"), ("agent", "anna bert cleo dora"), ("of bert, dora", "bert dora")]),
)  # fmt: skip
@settings(max_examples=40)
def test_room_is_exceeded_exactly_where_too_many_are_there(
    where: Tuple[str, Tuple[str, ...]], most: int, who: Tuple[str, str]
) -> None:
    of = who[0] if most == 1 or "of" in who[0] else who[0] + "s"
    network = translate(parse(SCENARIO + f"objective: {where[0]} holds {most} {of}\n", "x.pur"))
    names = [a.name for a in network.automata]
    for places, values in states_of(network):
        locations = dict(zip(names, places))
        if locations["obj"] == "idle":
            there = [name for name in who[1].split() if _inside(str(locations[name]), where[1])]
            if where[0].startswith("way"):
                there = [name for name in there if str(locations[name]).startswith("going")]
            moves = Arena(network, 1, idle_moves=True).situation((places, values)).moves
            lost = any(move.moves[0].edge.target == "lose" and not move.controllable for move in moves)
            assert lost is (len(there) > most)


def test_a_place_of_never_with_is_the_only_one_that_counts() -> None:
    text = SCENARIO + "objective: anna never_with dora at shop\n"
    (edge,) = translate(parse(text, "x.pur")).automaton("obj").edges
    assert [sorted((test.variable, test.value) for test in clause) for clause in edge.guard.integers] == [
        [("Panna", -22), ("Panna", 2)], [("Pdora", -22), ("Pdora", 2)]
    ]  # fmt: skip


def test_networks_without_conditions_have_no_more_variables() -> None:
    plain = translate(parse(SCENARIO, "x.pur"))
    assert not any(name.startswith("W") for name, _ in plain.variables)
    at_place = translate(parse(with_only_if({"open": "anna at shop"}), "x.pur"))
    assert at_place.variables == plain.variables
    telling = translate(parse(with_only_if({"open": "anna doing clean"}), "x.pur"))
    assert telling.variables == (*plain.variables, ("Wanna", 0))
    assert translate(parse(with_only_if({"open": "bert doing carry"}), "x.pur")).variables == plain.variables


def test_a_way_that_an_agent_alone_can_never_take_has_no_edge() -> None:
    network = translate(parse(with_only_if({"way": "anna on_way"}), "x.pur"))
    sent = {edge.sync.channel for edge in network.automaton("anna").edges if edge.sync}
    assert "anna_hall2shop" not in sent and "anna_shop2yard" in sent
    assert "bert_shop2hall" in {edge.sync.channel for edge in network.automaton("bert").edges if edge.sync}


@given(CONDITIONS)
@settings(max_examples=10)
def test_the_network_survives_uppaals_format(condition: Condition) -> None:
    network = translate(parse(with_only_if({"open": condition_text(condition), "way": "light is_true"}), "x.pur"))
    read = read_network(write_network(network, OBJECTIVE), "TGA.xml")
    assert (read.automata, read.variables) == (network.automata, network.variables)
