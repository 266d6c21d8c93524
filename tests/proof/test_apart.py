"""What a share keeps and does not name: the checker looks at each of these alone, held against the game as a whole."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from typing import Tuple

import pytest
from hypothesis import HealthCheck, assume, event, given, settings
from hypothesis import strategies as st

from pursue_gen.proof.checker import verify
from pursue_gen.proof.shares import shares_of
from pursue_gen.solving.rules import Rules
from pursue_gen.synthesis.strategy import Block, Constraint, Strategy, with_automata_of
from pursue_gen.tga.network import Automaton, ClockBound, Edge, Guard, Network, Objective
from tests.choices import member_of
from tests.patrols import corridor, small_patrols, tours_of
from tests.proof.test_stages import of_the_whole

LATE, NOW = Rules().reaction, Fraction(0)
MANY = 20_000
TEXT = corridor(6, 2, " every 60")


def reason(network: Network, objective: Objective, strategy: Strategy) -> str:
    """Why the checker refuses the strategy; "" if it does not."""
    report = verify(network, objective, strategy, LATE)
    return "" if report.ok else report.reason


def with_deadline(network: Network, name: str, period: int) -> Network:
    """The network with another deadline for this objective."""
    automaton = network.automaton(name)
    places = (
        replace(place, invariant=tuple(ClockBound(b.clock, b.op, period) for b in place.invariant))
        for place in automaton.locations
    )
    return changed(network, replace(automaton, locations=tuple(places)))


def changed(network: Network, automaton: Automaton) -> Network:
    return replace(network, automata=tuple(automaton if a.name == automaton.name else a for a in network.automata))


def test_each_place_has_a_game_of_its_own_beside_the_robot_and_its_tour() -> None:
    network, objective, strategy = tours_of(TEXT)
    parts = list(shares_of(with_automata_of(network, strategy), objective, strategy))
    assert [part.fault for part in parts] == [""] * 6
    named = [{automaton.name for automaton in part.game.automata} - {"_hidden"} for part in parts]
    assert sorted(map(sorted, named)) == sorted(
        sorted((robot, f"{robot}_tour", f"obj{n}" if n else "obj"))
        for robot, numbers in (("bot1", ("", 2, 3)), ("bot2", (4, 5, 6)))
        for n in numbers
    )
    assert all({place[0] for place in part.objective.bad} <= names for part, names in zip(parts, named))


def test_a_deadline_that_is_shorter_than_the_way_around_is_missed() -> None:
    network, objective, strategy = tours_of(TEXT)
    assert reason(network, objective, strategy) == ""
    assert reason(with_deadline(network, "obj2", 50), objective, strategy) != ""
    assert reason(with_deadline(network, "obj2", 70), objective, strategy) == ""


def test_who_is_kept_by_no_share_is_found() -> None:
    network, objective, strategy = tours_of(TEXT)
    fewer = tuple(tuple(place for place in share if place != ("obj2", "lose")) for share in strategy.shares)
    assert "obj2" in reason(network, objective, replace(strategy, shares=fewer))


def with_block(strategy: Strategy, number: int, block: Block) -> Strategy:
    return replace(strategy, blocks=tuple(block if n == number else b for n, b in enumerate(strategy.blocks)))


def first_command(strategy: Strategy) -> Tuple[int, Block]:
    return next((n, block) for n, block in enumerate(strategy.blocks) if block.commands)


def test_a_command_that_something_may_follow_is_refused() -> None:
    """A command on its way is not stale when a place changes of which the strategy does not speak."""
    network, objective, strategy = tours_of(TEXT)
    number, block = first_command(strategy)
    later = (Constraint(None, "Cbot1", Fraction(-3, 2), True),)
    assert "not the last word" in reason(
        network, objective, with_block(strategy, number, replace(block, wait=(*block.wait, later)))
    )
    other = replace(block.commands[0], zones=((Constraint(None, "Cbot1", Fraction(-2), True),),))
    both = replace(block, commands=(*block.commands, other))
    assert "not the last word" in reason(network, objective, with_block(strategy, number, both))


def test_clocks_of_what_it_does_not_name_are_not_compared() -> None:
    network, objective, strategy = tours_of(TEXT)
    number, block = first_command(strategy)
    told = replace(block, wait=((*block.wait[0], Constraint("Cobj", None, Fraction(99), False)),))
    assert "compares clocks" in reason(network, objective, with_block(strategy, number, told))


@pytest.mark.parametrize("what", ["sends", "sets", "takes over"])
def test_what_does_more_than_watch_is_refused(what: str) -> None:
    network, objective, strategy = tours_of(TEXT)
    watching = network.automaton("obj2")
    idle = next(edge for edge in watching.edges if edge.source == "idle")
    if what == "takes over":
        edges = tuple(replace(e, controllable=False) if e is idle else e for e in watching.edges)
    else:
        extra = Edge("idle", "idle", sync=idle.sync, assign=(("Pbot1", 3),))
        if what == "sends":
            assert idle.sync is not None
            extra = Edge("idle", "idle", Guard(), replace(idle.sync, sends=True), controllable=False)
        edges = (*watching.edges, extra)
    assert reason(changed(network, replace(watching, edges=edges)), objective, strategy) != ""


def whole(network: Network, strategy: Strategy) -> Tuple[Network, Strategy]:
    """The network with the strategy's automata, and the strategy with blocks that name everything."""
    network = with_automata_of(network, strategy)
    own = of_the_whole(network, strategy)
    return network, replace(own, watchers=strategy.watchers, tours=strategy.tours)


@st.composite
def damaged(draw: st.DrawFn, strategy: Strategy) -> Strategy:
    """The strategy with other zones in a block, another block's advice, a block less, or a share that keeps less."""
    number = draw(st.integers(0, len(strategy.blocks) - 1))
    block, other = strategy.blocks[number], draw(member_of(strategy.blocks))
    always = tuple(replace(command, zones=((),)) for command in block.commands)
    open_ended = tuple(replace(c, zones=tuple(zone[:1] for zone in c.zones)) for c in block.commands)
    new = draw(
        st.sampled_from(
            [
                replace(block, wait=()),
                replace(block, wait=((),)),
                replace(block, commands=()),
                replace(block, commands=always),
                replace(block, commands=open_ended),
                replace(block, wait=other.wait, commands=other.commands),
            ]
        )
    )
    shares = strategy.shares
    if draw(st.booleans()):
        k = draw(st.integers(0, len(shares) - 1))
        gone = draw(member_of(shares[k]))
        shares = tuple(tuple(p for p in share if n != k or p != gone) for n, share in enumerate(shares))
    return replace(with_block(strategy, number, new), shares=shares)


@settings(max_examples=40, deadline=None, suppress_health_check=list(HealthCheck))
@given(data=st.data(), text=small_patrols())
def test_what_passes_wins_the_game_as_a_whole(data: st.DataObject, text: str) -> None:
    """Also with shorter deadlines, and where the strategy was changed. In blocks that name everything a robot's command
    is stale when another robot moves, so of two robots commands take effect at once."""
    try:
        network, objective, strategy = tours_of(text)
    except AssertionError:
        assume(False)
        raise
    for _ in range(data.draw(st.integers(0, 2))):
        strategy = data.draw(damaged(strategy))
    for name, _ in objective.bad:
        if data.draw(st.integers(0, 3)) == 0:
            network = with_deadline(network, name, data.draw(st.integers(5, 40)))
    reaction = NOW if "bot2" in text else data.draw(member_of([NOW, LATE]))
    passes = verify(network, objective, strategy, reaction).ok
    event(f"{'passes' if passes else 'refused'} with reaction {reaction}")
    if passes:
        report = verify(*whole_game(network, objective, strategy), reaction, limit=MANY)
        event("too large to judge" if report.reason.startswith("limit") else "judged")
        assert report.ok or report.reason.startswith("limit"), (report.reason, report.play)


def whole_game(network: Network, objective: Objective, strategy: Strategy) -> Tuple[Network, Objective, Strategy]:
    network, own = whole(network, strategy)
    return network, objective, own
