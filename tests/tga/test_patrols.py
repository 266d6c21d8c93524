"""Patrols in the network: an automaton for each place listens to who arrives there and who leaves."""

from __future__ import annotations

import random
from typing import Dict, List

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from pursue_gen.diagnostics import PursueError
from pursue_gen.explanation.ablations import without_objective
from pursue_gen.language import parse
from pursue_gen.language.checks import check
from pursue_gen.language.scenario import Patrol, Scenario
from pursue_gen.solving.rules import Rules, played
from pursue_gen.solving.solution import solve_scenario
from pursue_gen.tga import scenario_objective, translate
from pursue_gen.tga.network import ClockBound, Edge, Guard, Location, Sync, Test
from pursue_gen.tga.uppaal import read_network, write_network
from pursue_gen.workspace.model_file import model_data
from pursue_runtime.model import Model

WATCH = """\
poi "gate"
poi "hall"
poi "vault"
connect gate and hall distance 2
connect hall and vault distance 3
event "rest"
agent "bot1" controllable mobile 1 location gate can_do rest
agent "bot2" controllable mobile 2 location vault can_do rest
objective: {}
"""


def scenario(objective: str) -> Scenario:
    return parse(WATCH.format(objective), "watch.pur", "watch")


def won(objective: str) -> bool:
    try:
        return bool(solve_scenario(scenario(objective), Rules()).strategy.blocks)
    except PursueError as problem:
        assert problem.exit_status == 4
        return False


def test_a_statement_with_several_places_is_several_objectives() -> None:
    safety = scenario("patrol gate, vault every 30 by bot1").safety
    assert all(isinstance(each, Patrol) for each in safety)
    assert [(each.place.name, each.every) for each in safety if isinstance(each, Patrol)] == [
        ("gate", 30), ("vault", 30),
    ]


@pytest.mark.parametrize(("objective", "code"), [
    ("patrol gate, vault every 1 by bot1", "PML143"), ("patrol gate, vault every 30 by bot9", "PML110"),
    ("patrol gate, cellar every 30 by bot1", "PML110"), ("patrol gate, gate every 30 by bot1", "PML220"),
])  # fmt: skip
def test_what_is_wrong_with_a_statement_is_reported_once(objective: str, code: str) -> None:
    assert [finding.code for finding in check(scenario(objective))] == [code]


def test_it_listens_to_arrivals_which_have_a_channel_only_then() -> None:
    network = translate(scenario("patrol gate every 30 by bot1"))
    arrives = "bot1_going_hall_to_gate2gate"
    assert network.automaton("obj").edges == (
        Edge("idle", "atRisk", Guard(), Sync("bot1_gate2hall", False), resets=("Cobj",)),
        Edge("atRisk", "idle", sync=Sync(arrives, False)),
        Edge("atRisk", "lose"),
    )
    assert network.automaton("obj").initial == "idle"
    due = network.automaton("obj").locations[-1]
    assert due == Location("atRisk", (ClockBound("Cobj", "<=", 30),))
    channels = [edge.sync and edge.sync.channel for edge in network.automaton("bot1").edges]
    assert channels.count(arrives) == 1 and channels.count(None) == 3, "the other arrivals are silent"
    plain = translate(scenario("avoid rest"))
    assert arrives not in plain.channels and network.channels == (*plain.channels, arrives)


def test_a_place_where_nobody_starts_is_due_from_the_start() -> None:
    assert translate(scenario("patrol hall every 30 by bot1")).automaton("obj").initial == "atRisk"
    assert translate(scenario("patrol vault every 30 by any robot")).automaton("obj").initial == "idle"


def test_uppaal_reads_it_back() -> None:
    story = scenario("patrol gate, vault every 30 by any robot")
    made = translate(story)
    assert read_network(write_network(made, scenario_objective(story)), "x.xml") == made


@pytest.mark.parametrize(
    ("objective", "can"),
    [
        ("patrol gate, vault every 20 by bot1", True),
        ("patrol gate, vault every 14 by bot1", False),
        ("patrol gate, hall, vault every 20 by bot1", True),
        ("patrol gate every 2 by any robot", True),
        ("patrol hall every 2 by bot2", False),
    ],
)
def test_it_is_won_where_the_way_round_takes_no_longer(objective: str, can: bool) -> None:
    assert won(objective) == can


IN_ORDER = "patrol gate, vault, hall in order every 40 by {}"


def test_in_order_the_places_share_a_variable_that_says_whose_turn_it_is() -> None:
    network = translate(scenario(IN_ORDER.format("bot1")))
    assert ("Pobj", 1) in network.variables, "bot1 starts at the gate: the vault is next"
    comes = Sync("bot1_going_hall_to_vault2vault", False)
    assert Edge("atRisk", "idle", Guard(integers=((Test("Pobj", 1),),)), comes, (("Pobj", 2),)) in network.automaton(
        "obj2"
    ).edges
    last = [edge.assign for edge in network.automaton("obj3").edges if edge.target == "idle"]
    assert last == [(("Pobj", 0),)] * 2, "after the last place it is the first one's turn"
    assert [network.automaton(name).initial for name in ("obj", "obj2", "obj3")] == ["idle", "atRisk", "atRisk"]


@pytest.mark.parametrize(
    ("order", "who", "turn", "idle"),
    [
        ("gate, vault, hall", "any robot", 2, [True, True, False]),
        ("vault, gate", "any robot", 0, [True, True]),
        ("hall, gate, vault", "any robot", 0, [False, False, False]),
        ("vault, gate, hall", "bot2", 1, [True, False, False]),
    ],
)
def test_who_stands_at_the_first_places_has_visited_them(order: str, who: str, turn: int, idle: List[bool]) -> None:
    network = translate(scenario(f"patrol {order} in order every 40 by {who}"))
    assert dict(network.variables)["Pobj"] == turn
    watching = [automaton for automaton in network.automata if automaton.name.startswith("obj")]
    assert [automaton.initial == "idle" for automaton in watching] == idle


def test_in_order_is_won_where_a_round_takes_no_longer() -> None:
    """On a line of three rooms the way there and back visits all in any order that begins with it."""
    assert won("patrol gate, hall, vault in order every 20 by bot1")
    assert not won("patrol gate, vault, hall in order every 12 by bot1")
    assert not won("patrol hall, gate, vault in order every 12 by bot1")


def test_lesser_scenarios_keep_or_lose_a_patrol_in_order_as_a_whole() -> None:
    story = scenario("patrol gate, hall in order every 40 by bot1\nobjective: avoid rest")
    assert [len(statement) for statement in story.statements] == [2, 1]
    fewer = without_objective(story, story.safety[1])
    assert fewer is not None and [each.text for each in fewer.safety] == ["avoid rest"]
    assert without_objective(scenario("patrol gate, hall in order every 40 by bot1"), story.safety[0]) is None


@given(st.integers(0, 10**6), st.sampled_from(["bot1", "any robot"]), st.permutations(["gate", "hall", "vault"]))
@settings(max_examples=30)
def test_the_turn_goes_round_with_the_arrivals(seed: int, who: str, order: List[str]) -> None:
    """Random plays: whose turn it is, and what is due, against who came where."""
    story = scenario(f"patrol {', '.join(order)} in order every 1000 by {who}")
    rules = Rules()
    model = Model(model_data(played(translate(story), rules), scenario_objective(story), story, rules.reaction))
    names = [agent.name for agent in story.agents] if who == "any robot" else [who]
    rng, here, turn, visited = random.Random(seed), model.initial(), 0, set()
    while turn < 3 and order[turn] in [here.locations[name] for name in names]:
        visited.add(order[turn])
        turn += 1
    for _ in range(25):
        for number, place in enumerate(order, 1):
            location = here.locations["obj" if number == 1 else f"obj{number}"]
            assert location == ("idle" if place in visited else "atRisk"), (place, here)
        assert here.values["Pobj"] == turn % 3
        able = [word for word in model.possible(here, timed=False) if not word.startswith("obj") and word != "rest"]
        moves = model.joint_move(here, rng.choice(able), timed=False)
        assert moves is not None
        before, here = here, model.after(moves, here)
        for name in names:
            place = here.locations[name]
            if place != before.locations[name] and place == order[turn % 3]:
                visited.add(place)
                turn += 1
        visited &= {here.locations[name] for name in names}


@given(st.integers(0, 10**6), st.sampled_from(["bot1", "bot2", "any robot"]), st.sampled_from(["gate", "hall"]))
def test_the_deadline_runs_exactly_while_nobody_of_them_is_there(seed: int, who: str, place: str) -> None:
    """Random plays: the automaton's location and clock against where the robots are."""
    story = scenario(f"patrol {place} every 1000 by {who}")
    rules = Rules()
    model = Model(model_data(played(translate(story), rules), scenario_objective(story), story, rules.reaction))
    names = [agent.name for agent in story.agents] if who == "any robot" else [who]
    rng, here, now, left = random.Random(seed), model.initial(), 0.0, 0.0
    there = any(here.locations[name] == place for name in names)
    for _ in range(30):
        assert here.locations["obj"] == ("idle" if there else "atRisk")
        assert there or here.clocks["Cobj"] == pytest.approx(now - left)
        delay = rng.choice((0.3, 1.1, 2.0))
        aged = here.aged(delay)
        words: Dict[str, List[str]] = {}
        for word in model.possible(aged, timed=True):
            words.setdefault(word, []).append(word)
        able = [word for word in words if not word.startswith("obj") and word != "rest"]
        stays = model.automaton("bot1").invariants, model.automaton("bot2").invariants
        late = any(
            aged.clocks[bound.left] > bound.bound
            for bounds, name in zip(stays, ("bot1", "bot2"))
            for bound in bounds[here.locations[name]]
        )
        if late:
            break
        here, now = aged, now + delay
        if not able:
            continue
        moves = model.joint_move(here, rng.choice(able))
        assert moves is not None
        here = model.after(moves, here)
        was, there = there, any(here.locations[name] == place for name in names)
        left = now if was and not there else left


def test_who_is_at_work_at_the_place_is_there() -> None:
    text = WATCH.replace('event "rest"', 'event "rest"\nevent "look" location gate duration 2')
    text = text.replace("location vault can_do rest", "location gate").replace("can_do rest", "can_do look")
    story = parse(text.format("patrol gate every 1000 by any robot"), "watch.pur", "watch")
    model = Model(model_data(played(translate(story), Rules()), scenario_objective(story), story, Rules().reaction))
    here = model.initial()
    for word in ("look", "bot2_gate2hall"):
        moves = model.joint_move(here, word, timed=False)
        assert moves is not None
        here = model.after(moves, here)
    assert here.locations == {"bot1": "doing_look_in_gate", "bot2": "going_gate_to_hall", "obj": "idle"}
