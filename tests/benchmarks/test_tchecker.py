"""Networks in TChecker's file format: well-formed by its documentation, and with the same moves; and how it is run.

No TChecker is needed: a small reader knows the documented rules, and programs that are written here stand for it.
"""

from __future__ import annotations

import itertools
import re
import sys
from dataclasses import dataclass, field, replace
from fractions import Fraction
from pathlib import Path
from typing import Any, Dict, FrozenSet, Iterator, List, Optional, Set, Tuple

import pytest
from hypothesis import given

from benchmarks import synthesis
from benchmarks.families import FAMILIES
from benchmarks.measure import Bounds, Case, game_of
from benchmarks.tchecker import TCheckerError, explored, table
from benchmarks.tchecker_file import written
from pursue_gen.language import load, parse
from pursue_gen.synthesis.compile_game import compile_game
from pursue_gen.synthesis.game import Game, JointMove, State, initial_state, is_bad, is_goal, joint_moves
from pursue_gen.tga import scenario_objective, translate
from pursue_gen.tga.network import (
    Automaton,
    ClockBound,
    Constraint,
    Edge,
    Guard,
    Kind,
    Location,
    Network,
    Objective,
    Sync,
    Test,
)
from tests.conftest import thesis_scenario
from tests.synthesis import random_games

pytestmark = pytest.mark.benchmark

# A reader -------------------------------------------------------------------------------------------------------------

_ID = re.compile(r"[A-Za-z_][A-Za-z0-9_.]*")
_TERM = re.compile(r"([A-Za-z_]\w*)(==|!=|<=|>=|<|>)(-?\d+)")
_RESERVED = {"clock", "edge", "event", "int", "location", "process", "sync", "system"}
_KNOWN = {"location": {"initial", "invariant"}, "edge": {"provided", "do"}}

Term = Tuple[str, str, int]


@dataclass(frozen=True)
class TckEdge:
    source: str
    target: str
    event: str
    guard: FrozenSet[Term]
    changes: Tuple[Tuple[str, int], ...]


@dataclass
class Tck:
    """A file that has been read. Fails where a line breaks a rule of the documentation."""

    events: Set[str] = field(default_factory=set)
    clocks: Set[str] = field(default_factory=set)
    ints: Dict[str, Tuple[int, int, int]] = field(default_factory=dict)
    locations: Dict[str, Dict[str, FrozenSet[Term]]] = field(default_factory=dict)
    initial: Dict[str, str] = field(default_factory=dict)
    edges: Dict[str, List[TckEdge]] = field(default_factory=dict)
    syncs: List[List[Tuple[str, str, bool]]] = field(default_factory=list)

    def names(self, texts: List[str]) -> None:
        for text in texts:
            assert _ID.fullmatch(text), text
            assert text not in _RESERVED and not text.lower().startswith("tck"), text

    def terms(self, text: str) -> FrozenSet[Term]:
        found = [_TERM.fullmatch(part) for part in text.split("&&")]
        assert all(found), text
        terms = frozenset((m.group(1), m.group(2), int(m.group(3))) for m in found if m)
        for name, op, _ in terms:
            assert name in self.ints or (name in self.clocks and op != "!="), name
        return terms

    def changes(self, text: str) -> Tuple[Tuple[str, int], ...]:
        changes = tuple((part.split("=")[0], int(part.split("=")[1])) for part in text.split(";"))
        for name, value in changes:
            if name in self.ints:
                least, most, _ = self.ints[name]
                assert least <= value <= most, "an assignment out of the domain cannot be executed"
            else:
                assert name in self.clocks and value == 0
        return changes

    def attributes(self, kind: str, text: str) -> Dict[str, str]:
        if not text:
            return {}
        parts = [part.strip() for part in text.split(":")]
        known = dict(zip(parts[::2], parts[1::2]))
        assert len(parts) == 2 * len(known) and set(known) <= _KNOWN[kind], text
        assert all(" " not in value and "@" not in value for value in known.values()), text
        return known

    def line(self, text: str) -> None:
        matched = re.fullmatch(r"(\w+):([^{}]*)(?:\{([^{}]*)\})?", text)
        assert matched, text
        kind, names, attributes = matched.group(1), matched.group(2).split(":"), matched.group(3) or ""
        getattr(self, f"_{kind}")(names, attributes)

    def _event(self, names: List[str], _: str) -> None:
        (name,) = names
        self.names(names)
        assert name not in self.events
        self.events.add(name)

    def _clock(self, names: List[str], _: str) -> None:
        size, name = names
        self.names([name])
        assert size == "1" and name not in self.clocks
        self.clocks.add(name)

    def _int(self, names: List[str], _: str) -> None:
        size, least, most, first, name = names
        self.names([name])
        assert size == "1" and name not in self.ints and name not in self.clocks
        assert int(least) <= int(first) <= int(most)
        self.ints[name] = (int(least), int(most), int(first))

    def _process(self, names: List[str], _: str) -> None:
        (name,) = names
        self.names(names)
        assert name not in self.locations
        self.locations[name], self.edges[name] = {}, []

    def _location(self, names: List[str], attributes: str) -> None:
        process, name = names
        self.names([name])
        assert name not in self.locations[process]
        known = self.attributes("location", attributes)
        self.locations[process][name] = self.terms(known["invariant"]) if "invariant" in known else frozenset()
        if "initial" in known:
            assert process not in self.initial and known["initial"] == ""
            self.initial[process] = name

    def _edge(self, names: List[str], attributes: str) -> None:
        process, source, target, event = names
        assert {source, target} <= set(self.locations[process]) and event in self.events
        known = self.attributes("edge", attributes)
        guard = self.terms(known["provided"]) if "provided" in known else frozenset()
        changes = self.changes(known["do"]) if "do" in known else ()
        self.edges[process].append(TckEdge(source, target, event, guard, changes))

    def _sync(self, names: List[str], attributes: str) -> None:
        assert not attributes
        parts = [(name.split("@")[0], name.split("@")[1].rstrip("?"), name.endswith("?")) for name in names]
        assert len(parts) >= 2 and len({process for process, _, _ in parts}) == len(parts)
        for process, event, _ in parts:
            assert event in {edge.event for edge in self.edges[process]}, "an event that the process has"
        self.syncs.append(parts)


def read(text: str) -> Tck:
    """The file, if it keeps to the rules."""
    text.encode("ascii")
    first, *lines = text.splitlines()
    assert first == "system:network"
    tck = Tck()
    for line in lines:
        tck.line(line)
    assert set(tck.initial) == set(tck.locations), "each process has an initial location"
    synchronous = {(process, event) for sync in tck.syncs for process, event, _ in sync}
    for process, edges in tck.edges.items():
        for edge in edges:
            if edge.event.startswith("receive_"):
                assert (process, edge.event) in synchronous, "else it would move by itself"
    return tck


Places = Tuple[str, ...]
Values = Dict[str, int]
Step = Tuple[Places, Tuple[Tuple[str, int], ...], FrozenSet[Term], FrozenSet[str]]
"""Where it leads to, with which values, what it needs of clocks, and which it resets."""


def steps(tck: Tck, places: Places, values: Values) -> Iterator[Step]:
    """What the documentation lets happen, whatever the clocks are."""
    processes = list(tck.locations)
    here = dict(zip(processes, places))

    def leaving(process: str, event: str) -> List[TckEdge]:
        return [edge for edge in tck.edges[process] if (edge.source, edge.event) == (here[process], event)]

    synchronous = {(process, event) for sync in tck.syncs for process, event, _ in sync}
    choices: List[List[Tuple[str, TckEdge]]] = []
    for process in processes:
        for edge in tck.edges[process]:
            if edge.source == here[process] and (process, edge.event) not in synchronous:
                choices.append([(process, edge)])
    for sync in tck.syncs:
        options = [[(process, edge) for edge in leaving(process, event)] for process, event, _ in sync]
        if all(edges or weak for edges, (_, _, weak) in zip(options, sync)):
            choices += [list(choice) for choice in itertools.product(*(edges for edges in options if edges))]
    for choice in choices:
        terms = [term for _, edge in choice for term in edge.guard]
        if all(_holds(values[name], op, number) for name, op, number in terms if name in values):
            after, new = dict(here), dict(values)
            for process, edge in choice:
                after[process] = edge.target
                new.update((name, value) for name, value in edge.changes if name in values)
            resets = frozenset(name for _, edge in choice for name, _ in edge.changes if name not in values)
            clocks = frozenset(term for term in terms if term[0] not in values)
            yield tuple(after.values()), tuple(sorted(new.items())), clocks, resets


def _holds(value: int, op: str, number: int) -> bool:
    return value == number if op == "==" else value != number


def as_step(game: Game, move: JointMove) -> Step:
    """A move of the game in the same words."""
    target = move.target
    places = tuple(f"l_{a.locations[k]}" for a, k in zip(game.automata, target.locations))
    values = {f"i_{name}": value for name, value in zip(game.variables, target.values)}
    values["over"] = int(is_goal(game, target) or is_bad(game, target))
    bounds = [bound for k in move.edges for bound in game.origins[k].guard.clocks]
    clocks = frozenset((f"x_{bound.clock}", bound.op, bound.bound) for bound in bounds)
    return places, tuple(sorted(values.items())), clocks, frozenset(f"x_{game.clocks[k - 1]}" for k in move.resets)


def has_the_moves_of(network: Network, objective: Objective, most: int = 2000) -> None:
    """In each discrete state that can be reached, whatever the clocks are, the file has the moves of the game."""
    tck, game = read(written(network, objective)), compile_game(network, objective)
    waiting: List[State] = [initial_state(game)]
    met = set(waiting)
    while waiting and len(met) < most:
        state = waiting.pop()
        places = tuple(f"l_{a.locations[k]}" for a, k in zip(game.automata, state.locations))
        values = {f"i_{name}": value for name, value in zip(game.variables, state.values)}
        ended = is_goal(game, state) or is_bad(game, state)
        moves = () if ended else tuple(joint_moves(game, state))
        assert set(steps(tck, places, {**values, "over": int(ended)})) == {as_step(game, move) for move in moves}
        for move in moves:
            if move.target not in met:
                met.add(move.target)
                waiting.append(move.target)


# The file -------------------------------------------------------------------------------------------------------------

KINDS = (Kind.REACH, Kind.SAFETY, Kind.REACH_WHILE_SAFE)
REACH = Objective(Kind.REACH, goal=(("A", "end"),))


@given(random_games.networks(KINDS))
def test_a_random_network_has_the_same_moves_in_the_file(drawn: Tuple[Network, Objective]) -> None:
    network, objective = drawn
    has_the_moves_of(network, replace(objective, goal=objective.goal[:1]))
    if len(objective.goal) > 1 and objective.kind is not Kind.SAFETY:
        with pytest.raises(ValueError, match="several goals"):
            has_the_moves_of(network, objective)


@pytest.mark.parametrize("family", FAMILIES, ids=lambda family: family.name)
def test_a_scenario_has_the_same_moves_in_the_file(family: Any) -> None:
    scenario = parse(family.text(family.sizes[1]), "member.pur")
    has_the_moves_of(translate(scenario), scenario_objective(scenario), most=300)


def test_a_published_network_has_the_same_moves_in_the_file(reference_dir: Path) -> None:
    cases = {case.name: case for case in synthesis.scenario_cases() if case.group == "reference"}
    for name in ("CT4", "EB3", "WC1"):
        has_the_moves_of(*game_of(cases[name]), most=300)


def network_of(*automata: Automaton, **more: Any) -> Network:
    channels = {edge.sync.channel for a in automata for edge in a.edges if edge.sync is not None}
    return Network(more.pop("clocks", ("x",)), more.pop("variables", (("v", 0),)), tuple(channels), automata, **more)


def automaton(name: str, *edges: Edge, places: str = "start end") -> Automaton:
    return Automaton(name, tuple(Location(place) for place in places.split()), "start", edges)


def test_invariants_initial_locations_clocks_and_first_values_are_written() -> None:
    bounded = Automaton("A", (Location("start", (ClockBound("x", "<=", 3),)), Location("end")), "start", ())
    tck = read(written(network_of(bounded, variables=(("v", -12),)), REACH))
    assert tck.initial == {"p_A": "l_start"} and tck.clocks == {"x_x"}
    assert tck.locations["p_A"] == {"l_start": frozenset({("x_x", "<=", 3)}), "l_end": frozenset()}
    assert tck.ints["i_v"] == (-12, -12, -12)


def test_who_receives_on_a_guard_that_does_not_hold_does_not_hinder_the_broadcast() -> None:
    send = automaton("A", Edge("start", "end", sync=Sync("go", True)))
    guard = Guard(integers=((Test("v", 1), Test("v", 2)), (Test("w", 0),)))
    receive = automaton("B", Edge("start", "end", guard, sync=Sync("go", False)))
    for v, w, moved in ((0, 0, False), (1, 0, True), (2, 0, True), (2, 5, False)):
        network = network_of(send, receive, variables=(("v", v), ("w", w)))
        has_the_moves_of(network, REACH)
        tck = read(written(network, REACH))
        after = [places for places, *_ in steps(tck, ("l_start", "l_start"), {"i_v": v, "i_w": w, "over": 0})]
        assert after == [("l_end", "l_end" if moved else "l_start")]


def test_who_listens_to_nobody_never_moves_by_itself() -> None:
    alone = automaton("A", Edge("start", "end", sync=Sync("go", False)), Edge("start", "end", sync=Sync("go", True)))
    text = written(network_of(alone), REACH)
    assert "receive_go" not in text and "sync:" not in text
    assert text.count("edge:") == 1


def test_the_game_is_over_at_the_goal_and_at_what_is_forbidden() -> None:
    there = automaton("A", Edge("start", "end"), Edge("end", "start"))
    tck = read(written(network_of(there), REACH))
    over = {"i_v": 0, "over": 1}
    assert [values for _, values, *_ in steps(tck, ("l_start",), {"i_v": 0, "over": 0})] == [tuple(over.items())]
    assert list(steps(tck, ("l_end",), over)) == []


@pytest.mark.parametrize(
    ("network", "why"),
    [
        (network_of(automaton("A"), start=(Constraint("x", None, Fraction(1), False),)), "middle of a play"),
        (network_of(automaton("Ä")), "'Ä' is no name"),
        (
            network_of(
                automaton("A", Edge("start", "end", Guard((ClockBound("x", ">", 1),)), Sync("go", False))),
                automaton("B", Edge("start", "end", sync=Sync("go", True))),
            ),
            "guard on clocks",
        ),
    ],
)
def test_what_the_format_does_not_have_is_refused(network: Network, why: str) -> None:
    with pytest.raises(ValueError, match=why):
        written(network, REACH)


# The program ----------------------------------------------------------------------------------------------------------

FIGURES = "MEMORY_MAX_RSS 4116\nREACHABLE false\nRUNNING_TIME_SECONDS 6.1474e-05\nVISITED_STATES 7\n"


def program(folder: Path, code: str, name: str = "tck-reach") -> Path:
    """A program that stands for TChecker's."""
    file = folder / name
    file.write_text(f"#!{sys.executable}\nimport sys, time, signal, os\n{code}\n")
    file.chmod(0o755)
    return file


def test_the_program_gets_a_file_and_its_figures_are_read(tmp_path: Path) -> None:
    code = "assert open(sys.argv[-1]).read() == 'system:network\\n' and sys.argv[1:3] == ['-a', 'covreach']\n"
    found = explored(program(tmp_path, f"{code}print({FIGURES!r})"), "system:network\n", 600)
    assert (found.states, found.seconds) == (7, 6.1474e-05)


@pytest.mark.parametrize(
    ("code", "limit", "why"),
    [
        ("time.sleep(600)", 0.5, "no end within 0.5 s"),
        ("print('line 3: syntax error', file=sys.stderr); sys.exit(1)", 600, "exit status 1: line 3: syntax error"),
        ("sys.exit(2)", 600, "exit status 2: it printed nothing"),
        ("os.kill(os.getpid(), signal.SIGSEGV)", 600, "failed with signal 11"),
        ("print('hello')", 600, "no lines with VISITED_STATES"),
        ("print('VISITED_STATES many\\nRUNNING_TIME_SECONDS 1')", 600, "no lines with VISITED_STATES"),
        ("sys.stdout.buffer.write(bytes(range(256)))", 600, "no lines with VISITED_STATES"),
    ],
)
def test_without_figures_there_is_a_line_that_says_why(tmp_path: Path, code: str, limit: float, why: str) -> None:
    with pytest.raises(TCheckerError, match=why) as problem:
        explored(program(tmp_path, code), "system:network\n", limit)
    assert "\n" not in str(problem.value)


def test_a_file_that_cannot_be_started_is_named(tmp_path: Path) -> None:
    (tmp_path / "empty").write_text("")
    (tmp_path / "empty").chmod(0o755)
    for file in (tmp_path / "missing", tmp_path / "empty"):
        with pytest.raises(TCheckerError, match=f"{file.name} does not start"):
            explored(file, "system:network\n", 600)


@pytest.mark.parametrize("name", ["missing", "."])
def test_the_benchmark_refuses_what_is_no_program(
    tmp_path: Path, name: str, capsys: pytest.CaptureFixture[str]
) -> None:
    with pytest.raises(SystemExit):
        synthesis.main(["--only", "scenario 1", "--tchecker", str(tmp_path / name)])
    assert "--tchecker is the path of TChecker's tck-reach" in capsys.readouterr().err


def test_the_benchmark_has_its_figures_beside_ours(tmp_path: Path) -> None:
    here = ["--out", str(tmp_path), "--no-plots", "--only", "scenario 1", "--tchecker"]
    assert synthesis.main([*here, str(program(tmp_path, f"print({FIGURES!r})"))]) == 0
    page = (tmp_path / "benchmarks.md").read_text()
    assert re.search(r"\| scenario 1 \| won \| 10 \| 7 \|", page)
    assert synthesis.main([*here, str(program(tmp_path, "sys.exit('no such option')"))]) == 0
    page = (tmp_path / "benchmarks.md").read_text()
    assert "tck-reach failed with exit status 1: no such option" in page


def test_in_a_family_it_explores_nothing_larger_than_what_it_did_not_end(tmp_path: Path, monkeypatch: Any) -> None:
    tried: List[Optional[int]] = []

    def late(case: Case, *_: Any) -> Dict[str, Any]:
        tried.append(case.size)
        return {"tchecker_outcome": "no end within 1 s"}

    monkeypatch.setattr(synthesis, "measured", lambda case, _: {"group": "family", "verdict": "won"})
    monkeypatch.setattr(synthesis, "tchecker_figures", late)
    cases = [case for case in synthesis.family_cases(quick=False) if case.name == "ring"]
    rows = list(synthesis.measurements(cases, Bounds(1.0, 100), tmp_path))
    assert tried == [4] and [row.get("tchecker_outcome", "") for row in rows].count("") == len(rows) - 1


def test_without_the_program_the_page_says_so() -> None:
    assert "--tchecker" in table([{"group": "thesis", "name": "scenario 1", "size": None, "game": "ideal"}])


def test_the_quotient_is_of_the_seconds() -> None:
    row = {"group": "thesis", "name": "one", "size": None, "game": "ideal", "verdict": "won", "seconds": 0.5}
    line = table([{**row, "states": 10, "tchecker_states": 3000, "tchecker_seconds": 2.0}]).splitlines()[-1]
    assert [cell.strip() for cell in line.strip("|").split("|")] == ["one", "won", "10", "3,000", "0.500", "2.0", "4.0"]


def test_a_scenario_of_the_thesis_keeps_its_size() -> None:
    scenario = load(thesis_scenario("2"))
    network = translate(scenario)
    tck = read(written(replace(network), scenario_objective(scenario)))
    assert len(tck.locations) == len(network.automata) and len(tck.clocks) == len(network.clocks)
