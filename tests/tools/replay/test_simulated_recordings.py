"""Recordings of simulated missions with conditions, own turns, limits and broken assumptions: no step of them is a
fault, and the journal leads to the same states."""

from __future__ import annotations

import functools
import json
from dataclasses import replace
from typing import Any, Dict, List, Optional, Sequence, Tuple

import pytest

from pursue_gen.language import parse
from pursue_gen.solving.rules import DEFAULT, Rules
from pursue_gen.solving.solution import solve_scenario
from pursue_gen.tga.network import Edge, Guard
from pursue_gen.tools.replay.check import Findings, check
from pursue_gen.tools.replay.finding import FAULT, NOTE, WORLD
from pursue_gen.tools.replay.game import Game, Source, game_of
from pursue_gen.tools.replay.journal import Journal, read_journal, reconstruct
from pursue_gen.tools.replay.moves import Moves
from pursue_gen.tools.replay.record import RecordedWord
from pursue_gen.tools.simulation.mission import START, SimulatedMission
from pursue_gen.tools.simulation.outcome import Outcome, Settings
from pursue_gen.tools.simulation.stage import Stage, stage_of
from pursue_gen.workspace import Options
from pursue_runtime.event_words import ORDERED
from pursue_runtime.state import SystemState
from tests.assumptions import AWAY, CAFE, COMES, GOODBYE, IN_ALL, LEAVES, MUSEUM, ONCE, PLANT, STAYS

CARTS = """\
poi "hall"
poi "plane"
connect hall and plane distance 2 for robots only_if gate is_true
event "open" at_most 1 times
event "load" location hall duration 1 only_if no robot at plane
event "unload" location plane
state "gate": initially false, true_if open
rule "bag" for each robot: load before unload
agent "cart1" controllable mobile 1 location hall can_do load, unload
agent "cart2" controllable mobile 1 location hall can_do load, unload, open
objective: avoid cart1 on_way and cart2 on_way
reach_objective: do unload
"""
"""Each cart unloads what it has loaded, and a gate has to be opened before one sets off."""

BOXES = (
    CARTS.replace('rule "bag" for each robot: load before unload\n', 'thing "box"\n')
    .replace("location hall duration 1", "location hall duration 1 takes box")
    .replace("location plane", "location plane gives box")
)
"""The same with things."""


@functools.lru_cache(maxsize=None)
def made(text: str) -> Tuple[Stage, Game]:
    """The stage of a scenario, and the game that its recordings are checked against."""
    scenario = parse(text, "story.pur", "story")
    stage = stage_of(scenario, solve_scenario(scenario, DEFAULT), Options())
    return stage, game_of(Source("story", text, "story.pur", Rules()))


class Recorded(SimulatedMission):
    """A mission that is recorded as on robots: what is missing is not known. `calls`: when others do what."""

    def __init__(self, text: str, seed: int, calls: Sequence[Tuple[float, str]] = ()) -> None:
        stage, self.game = made(text)
        # Words that mean nothing are a fault as well: with it assumptions may be broken.
        super().__init__(stage, Settings("still", ("junk",), until=120.0), seed, None)
        for at, word in calls:
            self.events.schedule(START + at, lambda word=word: self._report_move(word))  # type: ignore[misc]

    def run(self) -> Outcome:
        outcome = super().run()
        end = self.events.now + 0.5
        while (self.events.next_time() or end) < end:  # the last state is on its way to the controllers
            self.events.step()
        return outcome

    def _choose_move(self, state: SystemState) -> None:
        """Others do what is in `calls`, and nothing else."""

    def found(self) -> Findings:
        """What the replay says of it."""
        return check(replace(self.recorder.record(self.events.now), exact_until=None), self.game)

    def journal(self) -> bytes:
        """What the observer has written down."""
        head = json.dumps({"format": 1, "scenario": "story", "unit": 1.0})
        return "".join(f"{line}\n" for line in (head, *self._observer._lines)).encode()


def kinds(findings: Findings, *levels: str) -> List[str]:
    return [finding.kind for finding in findings.findings if finding.level in levels]


def by_number(states: Sequence[SystemState]) -> Dict[int, Any]:
    return {state.seq: (state.discrete(), state.event) for state in states if state.seq}


@pytest.mark.parametrize(("text", "seed"), [(CARTS, 1), (CARTS, 2), (CARTS, 3), (BOXES, 1), (BOXES, 2)])
def test_conditions_own_turns_and_loads_are_steps_of_the_model(text: str, seed: int) -> None:
    mission = Recorded(text, seed)
    assert mission.run().end == "goal"
    found = mission.found()
    assert kinds(found, FAULT, WORLD) == [] and found.won, found.findings
    assert {"open", "load", "unload"} <= {step.state.event for step in found.steps}


def acknowledges(word: RecordedWord, event: str, mission: Recorded) -> bool:
    """Return True for the word that acknowledges the order that follows from this event."""
    begun = {state.seq for state in mission.recorder.states if state.event == event}
    return word.event == ORDERED and word.seq in begun


@pytest.mark.parametrize("event", ["load", "unload"])
def test_an_order_that_was_not_recorded_was_given_if_the_robots_side_has_acknowledged_it(event: str) -> None:
    mission = Recorded(CARTS, 1)
    mission.run()
    mission.recorder.orders = [order for order in mission.recorder.orders if order.action != event]
    words = mission.recorder.words
    assert "acknowledged" in kinds(mission.found(), NOTE) and kinds(mission.found(), FAULT) == []
    mission.recorder.words = [word for word in words if not acknowledges(word, event, mission)]
    assert "untold" in kinds(mission.found(), FAULT)
    # who gives orders does not acknowledge them
    doer = next(state.agent for state in mission.recorder.states if state.event == event)
    controller = f"controller_{doer}"
    mission.recorder.words = [replace(w, node=controller) if acknowledges(w, event, mission) else w for w in words]
    assert "untold" in kinds(mission.found(), FAULT)


def test_a_mission_is_not_won_with_an_order_that_nobody_has_acknowledged() -> None:
    mission = Recorded(CARTS, 1)
    mission.run()
    assert mission.recorder.states[-1].status == "won"
    mission.recorder.words = [word for word in mission.recorder.words if not acknowledges(word, "unload", mission)]
    (finding,) = [finding for finding in mission.found().findings if finding.kind == "unacknowledged"]
    assert finding.level == FAULT and finding.text.endswith("'s side has not acknowledged unload")
    mission.recorder.states = [state for state in mission.recorder.states if state.status != "won"]
    assert "unacknowledged" not in kinds(mission.found(), FAULT)  # it was not won yet


def test_an_order_without_a_number_is_acknowledged_by_nobody() -> None:
    mission = Recorded(CARTS, 1)
    mission.run()
    mission.recorder.words = [word for word in mission.recorder.words if not acknowledges(word, "unload", mission)]
    mission.recorder.orders = [replace(order, seq=None) for order in mission.recorder.orders]
    assert "unacknowledged" not in kinds(mission.found(), FAULT)


@pytest.mark.parametrize("text", [CARTS, BOXES])
def test_who_unloads_without_having_loaded_is_a_fault(text: str) -> None:
    mission = Recorded(text, 1)
    mission.run()
    loaded = next(state for state in mission.recorder.states if state.event == "loadDONE").agent
    other = {"cart1": "cart2", "cart2": "cart1"}[loaded]
    last = mission.recorder.states[-1].seq
    mission.recorder.states = [s._replace(agent=other) if s.seq == last else s for s in mission.recorder.states]
    assert "step" in kinds(mission.found(), FAULT)


def test_what_is_done_while_its_condition_does_not_hold_is_a_fault() -> None:
    mission = Recorded(CARTS, 1)
    mission.run()
    opened = next(n for n, state in enumerate(mission.recorder.states) if state.event == "open")
    closed = [state._replace(values={**state.values, "Sgate": 0}) for state in mission.recorder.states]
    mission.recorder.states = [*mission.recorder.states[:opened], *closed[opened:]]
    found = [finding for finding in mission.found().findings if finding.kind == "step"]
    assert any("_hall2plane" in finding.text for finding in found), found


@pytest.mark.parametrize(
    ("text", "calls", "says"),
    [
        (CAFE.format(ONCE), [(1.5, "guest:call"), (3.0, "guest:call"), (9.0, "guest:call")], "call at most once"),
        (CAFE.format(IN_ALL), [(1.5, "guest:call"), (3.0, "guest:call"), (9.0, "guest:call")], "call at most once in"),
        (MUSEUM.format(f"{LEAVES}\n{AWAY}\n{GOODBYE}"), [], "visitor leaves gallery within 30 units"),
        (MUSEUM.format(f"{STAYS}\n{AWAY}\n{GOODBYE}"), [], "visitor stays 5 to 20 units at each place"),
        (MUSEUM.format(f"{STAYS}\n{AWAY}\n{GOODBYE}"), [(2.0, "visitor:visitor_gallery2hall")], "stays 5 to 20"),
        (MUSEUM.format(f"assume: visitor at hall by 30\n{AWAY}\n{GOODBYE}"), [], "visitor is at hall 30 units after"),
        (MUSEUM.format(f"{LEAVES}\n{AWAY}\n{GOODBYE}"), [(2.0, "visitor:visitor_gallery2store")], "never at store"),
        (PLANT.format(COMES), [(2.0, "machine:call")], "mechanic reaches m1 within 20 units after call"),
        (PLANT.format(COMES), [(2.0, "machine:call"), (12.0, "mechanic:eat")], "mechanic reaches m1 within 20 units"),
    ],
)
def test_a_broken_assumption_is_the_worlds_and_no_fault_of_a_node(
    text: str, calls: Sequence[Tuple[float, str]], says: str
) -> None:
    mission = Recorded(text, 1, calls)
    ended = mission.run()
    assert not ended.problems, ended
    found = mission.found()
    assert kinds(found, FAULT) == [], found.findings
    (finding,) = (finding for finding in found.findings if finding.kind == "assumption")
    assert finding.level == WORLD and finding.text.startswith("an assumption is broken: ") and says in finding.text
    assert set(kinds(found, WORLD)) <= {"assumption", "uncovered"} and NOTE in {f.level for f in found.findings}


@pytest.mark.parametrize("calls", [[], [(1.5, "guest:call"), (3.0, "guest:call"), (9.0, "guest:call")]])
def test_the_journal_leads_to_the_same_states(calls: Sequence[Tuple[float, str]]) -> None:
    mission = Recorded(CAFE.format(ONCE), 1, calls)
    mission.run()
    journal = read_journal(mission.journal())
    assert isinstance(journal, Journal) and not journal.problems
    record = reconstruct(journal, Moves(mission.game.network), mission.game.objective)
    assert by_number(record.states) == by_number(mission.recorder.states)
    assert any(state.values["assume1"] == 0 for state in record.states) is bool(calls)


@pytest.mark.parametrize(
    ("text", "calls"),
    [(MUSEUM.format(f"{LEAVES}\n{AWAY}\n{GOODBYE}"), []), (PLANT.format(COMES), [(2.0, "machine:call")])],
)
def test_the_journal_knows_who_has_stayed_too_long(text: str, calls: Sequence[Tuple[float, str]]) -> None:
    mission = Recorded(text, 1, calls)
    mission.run()
    journal = read_journal(mission.journal())
    assert isinstance(journal, Journal)
    record = reconstruct(journal, Moves(mission.game.network), mission.game.objective)
    assert by_number(record.states) == by_number(mission.recorder.states)


BELL = """\
poi "hall"
poi "room"
connect hall and room distance 3
event "ring"
event "answer" location room duration 1
agent "bot" controllable mobile 1 location hall can_do answer
agent "guest" location room can_do ring
objective: if ring then answer within 20
"""


@pytest.mark.parametrize(("later", "expected"), [(19.0, []), (22.0, ["end"])])
def test_a_mission_that_somebody_ends_is_not_won_where_a_deadline_has_passed(later: float, expected: List[str]) -> None:
    mission = Recorded(BELL, 1, [(3.0, "ring")])
    mission.run()
    rung = next(number for number, state in enumerate(mission.recorder.states) if state.event == "ring")
    last = mission.recorder.states[rung]
    ended = {clock: value + later for clock, value in last.clocks.items()}
    won = last._replace(stamp=last.stamp + later * last.unit, clocks=ended, status="won")
    mission.recorder.states[rung + 1 :] = [won]
    assert [each for each in kinds(mission.found(), FAULT) if each == "end"] == expected


ERRANDS = """\
poi "desk"
poi "window"
connect desk and window distance 2
event "call" location window
event "fetch" location desk duration 3
agent "bot" controllable mobile 1 location desk can_do fetch
agent "visitor" mobile 3 location window can_do call
objective: if call then fetch within 12
mission ends after 30
"""


@pytest.mark.parametrize("calls, ends", [((), 30.0), (((28.0, "call"),), 31.0)], ids=["nothing due", "a call"])
def test_an_end_after_a_time_is_that_of_the_scenario(calls: Sequence[Tuple[float, str]], ends: float) -> None:
    mission = Recorded(ERRANDS, 1, calls)
    outcome = mission.run()
    assert outcome.end == "safe" and ends - 0.01 <= outcome.time <= ends + 1.5
    found = mission.found()
    assert kinds(found, FAULT, WORLD) == [] and found.won, found.findings
    assert "kept: if call then fetch within 12" in found.reason
    again = reconstruct(read_journal(mission.journal()), Moves(mission.game.network), mission.game.objective)
    assert by_number(again.states) == by_number(mission.recorder.states) and again.states[-1].status == "won"



@pytest.mark.parametrize(
    "text, calls, finish, says",
    [
        (ERRANDS, (), None, "its status is won 10.00 time units before the mission may end"),
        (ERRANDS.replace("after 30", "after 20"), ((19.0, "call"),), None, "waits for an answer that was due"),
        (ERRANDS.replace("after 30", "after 50"), ((19.0, "call"),), 19.5, "waits for an answer that was due"),
        (ERRANDS.replace("after 30", "after 50"), ((19.0, "call"),), 18.5, ""),
    ],
)
def test_an_end_that_came_too_soon_is_a_fault(
    text: str, calls: Sequence[Tuple[float, str]], finish: Optional[float], says: str
) -> None:
    """The observer ends it after 20 time units, whatever is due."""
    mission = Recorded(text, 1, calls)
    if finish is not None:
        mission.recorder.on_word(START + finish, "Finish!", "UI")
    mission.events.schedule(START + 20.0, lambda: setattr(mission._observer.mission.ending, "is_over", lambda _: True))
    mission.events.schedule(START + 20.0, lambda: mission._observer.call("hear", "Finish!"))
    mission.run()
    found = [finding.text for finding in mission.found().findings if finding.level == FAULT]
    assert [says in text for text in found] == ([True] if says else []), found


def test_two_who_are_where_one_may_be_and_whom_nobody_marks_are_a_fault() -> None:
    mission = Recorded(CARTS, 1)
    mission.run()
    assert kinds(mission.found(), FAULT) == []

    def one_is_enough(edge: Edge) -> List[Edge]:
        return [replace(edge, guard=Guard(integers=edge.guard.integers[:1]))] if edge.target == "lose" else [edge]

    network = mission.game.network.with_each(lambda automaton: automaton.with_each(one_is_enough))
    mission.game = replace(mission.game, network=network)
    found = [finding for finding in mission.found().findings if finding.kind == "broken"]
    assert found and all(finding.level == FAULT for finding in found)
    assert "nobody marked it" in found[0].text
