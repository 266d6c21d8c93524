"""Observer and controllers against a random world, without ROS: what the solver has won is won at run time too.

Robots end what they begin anywhere in the model's window; commands arrive anywhere within the reaction; agents that
nobody controls do what they like whenever they may.
"""

from __future__ import annotations

import random
from fractions import Fraction
from pathlib import Path
from typing import Any, Dict, List, Optional, Tuple

import pytest
import yaml
from node_modules import controller_core, library, model, observer_core

from pursue_gen.language import load
from pursue_gen.partition import partition, strategy_file
from pursue_gen.synthesis.solve import solve
from pursue_gen.tga import ends_reported, scenario_objective, translate
from pursue_gen.workspace.model_file import render

THESIS = Path(__file__).resolve().parents[2] / "scenarios" / "thesis"
REACTION = Fraction(1, 10)
LIMIT = 5000


class World:
    """Everything that happens is at a moment; the earliest is next."""

    def __init__(self, files: Dict[str, Any], seed: int) -> None:
        self.draw = random.Random(seed)
        self.model = model.Model(files["model"])
        self.warnings: List[str] = []
        cover = library.read_cover(files["cover"])
        self.mission = observer_core.Mission(self.model, cover, self.log, tolerance=0.01)
        self.players = [controller_core.Player(library.Strategy(data)) for data in files["strategies"]]
        self.now = 1000.0
        self.words: List[Tuple[float, str]] = []
        self.orders: List[Any] = []

    def log(self, level: str, message: str) -> None:
        if level != "info":
            self.warnings.append(message)

    def hear(self, word: str) -> None:
        for state in self.mission.hear(word, self.now):
            self.see(state)

    def see(self, state: Any) -> None:
        for player in self.players:
            self.orders += player.see(state, self.now)
        self.words = [(moment, word) for moment, word in self.words if "@" in word]
        position = self.mission.position(self.now)
        for automaton in self.model.automata:
            for moment, word in [self.what_it_does(automaton, position)]:
                if word:
                    self.words.append((moment, word))

    def what_it_does(self, automaton: Any, position: Any) -> Tuple[float, Optional[str]]:
        """When it ends what it does, or (if nobody controls it) begins something."""
        place = position.locations[automaton.name]
        edges = [e for e in automaton.edges_from(place) if not e.controllable and e.sync != "receive"]
        edges = [e for e in edges if e.allowed(position.values)]
        if not edges or automaton.kind == "safety":
            return 0.0, None
        edge = self.draw.choice(edges)
        clocks = position.clocks
        low = max([0.0, *(-c.bound - clocks[c.right] for c in edge.when)])
        high = min([low + 20.0, *(c.bound - clocks[c.left] for c in automaton.invariants[place])])
        return self.now + low + (high - low) * (0.001 + 0.998 * self.draw.random()), f"{automaton.name}:{edge.word}"

    def step(self) -> None:
        moments = [(moment, lambda w=word: self.hear(w)) for moment, word in self.words]
        for player in self.players:
            if player.wake()[0] is not None:
                moments.append((player.wake()[0], lambda p=player: self.speak(p)))
        deadline = self.mission.next_moment(self.now)
        if deadline is not None:
            moments.append((deadline, lambda: [self.see(state) for state in self.mission.tick(self.now)]))
        assert moments, "nothing will ever happen again"
        self.now, act = min(moments, key=lambda entry: entry[0])
        self.words = [(moment, word) for moment, word in self.words if moment > self.now]
        act()

    def speak(self, player: Any) -> None:
        word = player.ring(self.now)
        if word:
            self.words.append((self.now + float(REACTION) / 2 * self.draw.random(), library.format_word(word)))


@pytest.fixture(scope="module", params=["scenario_1", "scenario_2", "scenario_3", "scenario_4", "catch_the_thief"])
def files(request: pytest.FixtureRequest) -> Dict[str, Any]:
    scenario = load(THESIS / f"{request.param}.pur")
    network, objective = ends_reported(translate(scenario), {}), scenario_objective(scenario)
    strategy = solve(network, objective, REACTION).strategy
    assert strategy is not None
    subs = partition(strategy, network, scenario.agents)
    texts = [strategy_file.render(sub, scenario.name, "0", REACTION) for sub in subs]
    return {
        "model": yaml.safe_load(render(network, objective, scenario, "0")),
        "cover": yaml.load(strategy_file.render_cover(strategy, scenario.name, "0"), yaml.CSafeLoader),
        "strategies": [yaml.load(text, yaml.CSafeLoader) for text in texts],
        "robots": {agent.name for agent in scenario.agents if agent.is_robot},
    }


@pytest.mark.parametrize("seed", range(5))
def test_what_is_won_is_won(files: Dict[str, Any], seed: int) -> None:
    world = World(files, seed)
    world.hear("_start_")
    for _ in range(LIMIT):
        if world.mission.status != "running":
            break
        world.step()
    assert world.mission.status == "won", (world.mission.reason, world.warnings[-3:])
    assert not world.warnings
    assert world.mission.counts["uncovered"] == world.mission.counts["impossible"] == 0
    assert {order.agent for order in world.orders} <= files["robots"] | {"reachObj"}
    assert any(order.target.startswith("going_") for order in world.orders)
