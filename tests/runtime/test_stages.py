"""Strategies whose blocks name different automata: what was decided stands for controllers as long as for the observer.

Both are compared with a plain reference: what a block decided in state k stands in state n if the block holds in all
states from k to n, and no automaton that it names has reset its clock in between.
"""

from __future__ import annotations

from itertools import product
from typing import Any, Dict, List, Mapping, NamedTuple, Sequence, Tuple

from hypothesis import given
from hypothesis import strategies as st

from pursue_runtime.controller.scheduler import CommandScheduler
from pursue_runtime.model import Model
from pursue_runtime.observer.mission import Mission
from pursue_runtime.state import RUNNING, SystemState
from pursue_runtime.strategy import StateTable, Strategy, read_cover

ROBOTS, GUESTS = ("bot1", "bot2"), ("guest1", "guest2")
AGENTS = (*ROBOTS, *GUESTS)
PARTS: List[List[Tuple[str, ...]]] = [[ROBOTS], [("bot1",), ("bot2",)], [("bot1",)]]
"""Who may be commanded by the parts of a stage: one for both robots, one for each, one for the first alone."""
STAGES = ("first", "second", "third")


def walker(name: str) -> Dict[str, Any]:
    """An agent that goes to and fro, sets a switch, waves (its clock starts again), nods (nothing changes), and calls:
    the next agent starts its clock again."""
    clock, calls = f"C{name}", AGENTS[AGENTS.index(name) - 1]
    free = {"sync": "send", "controllable": False}
    edges: List[Dict[str, Any]] = [
        {"from": "a", "to": "b", "word": f"{name}_goes", "set": {f"P{name}": 2}, "reset": [clock], **free},
        {"from": "b", "to": "a", "word": f"{name}_returns", "set": {f"P{name}": 1}, "reset": [clock], **free},
    ]
    for here in "ab":
        edges += [
            {"from": here, "to": here, "word": f"{name}_switches", "set": {"Slight": 1}, **free},
            {"from": here, "to": here, "word": f"{name}_waves", "reset": [clock], **free},
            {"from": here, "to": here, "word": f"{name}_nods", **free},
            {"from": here, "to": here, "word": f"{name}_calls", **free},
            {"from": here, "to": here, "word": f"{calls}_calls", "reset": [clock], **free, "sync": "receive"},
        ]
    return {"name": name, "kind": "agent", "initial": "a", "locations": {"a": [], "b": []}, "edges": edges}


def model() -> Model:
    """Four such agents; a rule whose location is the stage; a state that counts who puts the light out."""
    ways = [(STAGES[0], STAGES[1]), (STAGES[1], STAGES[2]), (STAGES[2], STAGES[0])]
    onward = [{"from": x, "to": y, "word": "next", "sync": "send", "controllable": False} for x, y in ways]
    dark = [{"from": x, "to": x, "word": "dark", "sync": "send", "set": {"Slight": 0}, "controllable": False}
            for x in STAGES]
    rule = {"name": "rule", "kind": "rule", "initial": STAGES[0], "locations": {stage: [] for stage in STAGES},
            "edges": [*onward, *dark]}
    goal = {"name": "reachObj", "kind": "reach", "initial": "unlocked", "locations": {"unlocked": [], "win": []},
            "edges": []}
    positions = {f"P{name}": 1 for name in AGENTS}
    return Model({
        "format": 1, "scenario": "stages", "clocks": [*(f"C{name}" for name in AGENTS), "Creach"],
        "variables": {**positions, "Slight": 0}, "automata": [*map(walker, AGENTS), rule, goal],
        "objective": {"kind": "reach", "goal": ["reachObj", "win"], "bad": None},
    })  # fmt: skip


MODEL = model()
WORDS = sorted({(a.name, e.word) for a in MODEL.automata for e in a.edges if e.sync == "send"})


class Block(NamedTuple):
    """What holds in one state: who is commanded ("": nobody), as soon as the clock has that value."""

    state: Mapping[str, Any]
    agent: str
    clock: str
    opens: int


@st.composite
def strategies_of_stages(draw: st.DrawFn) -> List[Block]:
    """Blocks of up to three stages, each with a part for each robot or one for both.

    Those of a part name its place of the rule and the same others; no part names the robot of another one.
    """
    blocks: List[Block] = []
    for stage in STAGES:
        for robots in draw(st.sampled_from(PARTS)):
            agents = sorted(draw(st.sets(st.sampled_from(robots))) | draw(st.sets(st.sampled_from(GUESTS))))
            light = draw(st.booleans())
            for places in product("ab", repeat=len(agents)):
                for value in (0, 1) if light else (None,):
                    if draw(st.integers(0, 5)) == 0:
                        continue  # not covered
                    state: Dict[str, Any] = {"rule": stage, **dict(zip(agents, places))}
                    if value is not None:
                        state["Slight"] = value
                    agent = draw(st.sampled_from(["", *sorted(set(agents) & set(robots))]))
                    clock = draw(st.sampled_from(agents)) if agents else "reach"
                    blocks.append(Block(state, agent, f"C{clock}", draw(st.integers(1, 6))))
    return blocks


def part_for(controller: str, blocks: Sequence[Block]) -> Strategy:
    """The blocks in which this controller has a command."""
    return Strategy({
        "commands_agents": [controller], "reaction": 0.1, "strategy": [
            {"state": block.state, "commands": [
                {"do": f"{controller}_goes", "agent": controller, "from": "a", "to": "b",
                 "when": [f"{block.opens} <= {block.clock}"]}]}
            for block in blocks if block.agent == controller],
    })  # fmt: skip


class Recorded(NamedTuple):
    """A state that the observer has published, and the clocks that were reset on the way to it."""

    state: SystemState
    resets: Tuple[str, ...]


def holds(block: Block, state: SystemState) -> bool:
    everything: Dict[str, Any] = {**state.locations, **state.values}
    return all(everything[name] == part for name, part in block.state.items())


def stands(block: Block, states: Sequence[Recorded]) -> bool:
    """The reference: what the block decided in the first of these states stands in the last one."""
    clocks = {f"C{name}" for name in block.state}
    return all(holds(block, one.state) for one in states) and all(clocks.isdisjoint(one.resets) for one in states[1:])


@given(
    strategies_of_stages(),
    st.lists(st.tuples(st.sampled_from(WORDS), st.sampled_from([0.25, 1.0, 3.5])), min_size=1, max_size=12),
)
def test_a_decision_stands_for_controllers_as_long_as_for_the_observer(
    blocks: List[Block], happens: List[Tuple[Tuple[str, str], float]]
) -> None:
    cover = read_cover({"cover": [{"state": block.state, "wait": ["always"]} for block in blocks]})
    observer = Mission(MODEL, cover, lambda level, text: None, on_uncovered="warn")
    controllers = {name: CommandScheduler(part_for(name, blocks), name) for name in ROBOTS}
    now = 100.0
    recorded = [Recorded(observer.on_word("_start_", now)[0], ())]
    for controller in controllers.values():
        controller.on_state(recorded[0].state, now)
    for (agent, event), delay in happens:
        now += delay
        moves = MODEL.joint_move(observer.position(now), event, agent)
        for state in observer.on_word(f"{agent}:{event}", now):
            assert moves is not None and state.status == RUNNING
            recorded.append(Recorded(state, tuple(clock for _, edge in moves for clock in edge.resets)))
            for controller in controllers.values():
                controller.on_state(state, now)
        holding = [block for block in blocks if holds(block, recorded[-1].state)]
        for name, controller in controllers.items():
            mine = [block for block in holding if name in block.state] or holding
            for k, one in enumerate(recorded):
                last = one is recorded[-1]
                expected = last or (bool(mine) and all(stands(block, recorded[k:]) for block in mine))
                assert is_taken(observer, name, one.state.seq, now) is expected
            commands = [block for block in holding if block.agent == name]
            assert len(commands) < 2
            moments = [moment(block, recorded) for block in commands]
            assert controller.next_wakeup()[0] == (moments[0] if moments else None)


def moment(block: Block, recorded: Sequence[Recorded]) -> float:
    """When the command of a block that holds in the last of these states is due, by the first in which it stands."""
    first = next(one.state for k, one in enumerate(recorded) if stands(block, recorded[k:]))
    return first.stamp + max(0.0, block.opens - first.clocks[block.clock])


def is_taken(observer: Mission, agent: str, seq: int, now: float) -> bool:
    """True unless a command for this number is stale; no agent can do what it names, so that nothing happens."""
    before = observer.counts["stale"]
    observer.on_word(f"{agent}:nothing@{seq}", now)
    return observer.counts["stale"] == before


NAMES = ("u", "v", "w", "x", "y")


@given(
    st.lists(st.dictionaries(st.sampled_from(NAMES), st.sampled_from("ab"), max_size=4), max_size=12),
    st.lists(st.fixed_dictionaries({name: st.sampled_from("ab") for name in NAMES}), min_size=1, max_size=5),
)
def test_whatever_entries_name_all_that_apply_are_found(
    entries: List[Dict[str, str]], states: List[Dict[str, str]]
) -> None:
    table = StateTable(((entry, number) for number, entry in enumerate(entries)))
    assert len(table) == len({tuple(sorted(entry.items())) for entry in entries})
    for locations in states:
        state = SystemState(1, 0.0, locations, {}, {})
        expected = [number for number, entry in enumerate(entries) if entry.items() <= locations.items()]
        assert sorted(table.find(state)) == expected
        assert table.names_in(state) == {name for number in expected for name in entries[number]}
