"""Faults that are put into recorded missions, one each: the judge finds every one of them."""

from __future__ import annotations

import functools
from dataclasses import dataclass, replace
from typing import Any, Callable, List, Mapping, Tuple

import pytest

from pursue_gen.language import parse
from pursue_gen.replay.check import check
from pursue_gen.replay.finding import FAULT, NOTE
from pursue_gen.replay.moves import after
from pursue_gen.replay.record import MissionRecord, RecordedWord, RobotOrder, read_word
from pursue_gen.simulation.judge import Judge
from pursue_gen.simulation.meaning import broken_of
from pursue_gen.simulation.promises import Promises
from pursue_gen.simulation.stage import Stage, stage_of
from pursue_gen.solving.rules import DEFAULT
from pursue_gen.solving.solution import solve_scenario
from pursue_gen.workspace import Options
from pursue_runtime.locations import is_under_way
from pursue_runtime.orders import Order
from pursue_runtime.state import SystemState

HALL = """\
poi "desk"
poi "hall"
poi "shelf"
connect desk and hall distance 4
connect hall and shelf distance 4
connect desk and shelf distance 4
event "call" location hall
event "fetch" location shelf duration 2
event "answer" location hall
agent "bot" controllable mobile 1 location desk can_do fetch, answer
agent "guest" mobile 1 location desk can_do call
assume: guest never at shelf
objective: if call then answer within 30
objective: avoid guest at shelf and bot doing fetch
reach_objective: do fetch after 20
"""
"""A robot answers calls, and fetches something while the guest is elsewhere."""

Play = Tuple[Tuple[float, str, str], ...]
"""Moment (time units since the start), word without the number of a state, node."""

LEAVES, ARRIVES, CALLS = (2.0, "guest:guest_desk2hall"), (6.5, "guest_going_desk_to_hall2hall"), (9.0, "guest:call")
UNLOCKED = (20.1, "reachObj:reachObj_going_initial_location2unlocked@")
SETS_OUT, REACHES = (20.2, "bot:bot_desk2shelf@"), (24.5, "bot_going_desk_to_shelf2shelf")
FETCHES, HAS_FETCHED = (25.6, "bot:fetch@"), (27.7, "fetchDONE")
PLAY = (LEAVES, ARRIVES, CALLS, UNLOCKED, SETS_OUT, REACHES, FETCHES, HAS_FETCHED)
"""A mission that is won, as the strategy has it; its last state has the number 9."""


@functools.lru_cache(maxsize=None)
def stage() -> Stage:
    scenario = parse(HALL, "hall.pur", "hall")
    return stage_of(scenario, solve_scenario(scenario, DEFAULT), Options())


@dataclass
class Course:
    """A mission as it was recorded."""

    states: List[SystemState]
    words: List[RecordedWord]
    orders: List[RobotOrder]
    plans: Mapping[int, Any]

    def change(self, first: int, last: int = 99, **values: Any) -> None:
        """Give something else to the states with these numbers; to mappings, what is given is added."""
        for number, state in enumerate(self.states):
            if first <= state.seq <= last:
                new = {k: {**getattr(state, k), **v} if isinstance(v, dict) else v for k, v in values.items()}
                self.states[number] = state._replace(**new)

    def order(self, number: int, **values: Any) -> None:
        """Give something else to an order."""
        self.orders[number] = replace(self.orders[number], **values)

    def hold(self, before: int) -> None:
        """The mission holds from this number on."""
        held = next(state for state in self.states if state.seq == before - 1)
        for number, state in enumerate(self.states):
            if state.seq >= before:
                self.states[number] = state._replace(seq=state.seq + 1)
        self.words = [w if (w.seq or 0) < before - 1 else replace(w, seq=(w.seq or 0) + 1) for w in self.words]
        self.orders = [o if (o.seq or 0) < before else replace(o, seq=(o.seq or 0) + 1) for o in self.orders]
        self.states.append(held._replace(seq=before, status="holding", event="", agent=""))
        self.states.sort(key=lambda state: state.seq)


def course(play: Play) -> Course:
    """The mission that these words make, each of them taken, with the orders that follow from commands."""
    moves, made = stage().game.moves, Course([], [read_word(0.0, "_start_", "UI")], [], {})
    place, zeros = moves.initial, dict.fromkeys(moves.network.clocks, 0.0)
    made.states.append(SystemState(0, 0.0, *place, dict.fromkeys(zeros, 0.0), status="waiting"))
    made.states.append(SystemState(1, 0.0, *place, dict.fromkeys(zeros, 0.0)))
    for seq, (at, text) in enumerate(play, start=2):
        is_command = text.endswith("@")
        agent, _, event = text.rstrip("@").rpartition(":")
        node = f"controller_{agent}" if is_command else "simulator"
        node = "controllerObj" if agent == "reachObj" else node
        broken = place._replace(values={**place.values, "assume1": 0})
        move = next(m for some in (place, broken) for m in moves.of(some, event, agent))
        place = place if move in moves.of(place, event, agent) else broken
        place, resets = after(move, place)
        zeros.update(dict.fromkeys(resets, at))
        clocks = {clock: at - zero for clock, zero in zeros.items()}
        status = "won" if place.locations["reachObj"] == "win" else "running"
        mover, here = move[0][0], place.locations[move[0][0]]
        made.states.append(SystemState(seq, at, *place, clocks, event, mover, status, commanded=is_command))
        made.words.append(read_word(at, f"{text}{seq - 1}" if is_command else text, node))
        if is_command and mover == "bot":
            action = "" if here.startswith("going") else event
            made.orders.append(RobotOrder(at, "bot", node, action=action, seq=seq, location=here))
    return made


# Each fault -----------------------------------------------------------------------------------------------------------

Fault = Tuple[Play, Callable[[Course], Any], bool, str, str]
"""The play, how the course is changed, whether messages may be late in it, and what the judges say: of simulations (""
where it does not find it) and of recordings."""


def unchanged(made: Course) -> None:
    """The fault is in the play."""


def other(place: int, *steps: Any) -> Any:
    """The play with other steps from this place on."""
    return (*PLAY[:place], *steps)


def at(step: Any, moment: float) -> Any:
    """The step at another moment."""
    return (moment, *step[1:])


FAULTS: Mapping[str, Fault] = {
    "a number is skipped": (
        PLAY, lambda m: [m.change(s, s, seq=s + 1) for s in range(9, 3, -1)], False, "follows", "gap"
    ),
    "a state is another one when it is shown again": (
        PLAY, lambda m: m.states.insert(4, m.states[3]._replace(locations=m.states[2].locations)), False,
        "published again", "number",
    ),
    "it does not begin at the beginning": (
        PLAY, lambda m: m.change(0, 1, locations={"guest": "hall"}), False, "not where the network starts", "start"
    ),
    "a robot is somewhere else": (PLAY, lambda m: m.change(7, locations={"bot": "hall"}), False, "is no step", "step"),
    "a change without an event": (
        PLAY, lambda m: m.change(3, 3, event="", agent=""), False, "nothing has happened", "step"
    ),
    "a variable is not set": (PLAY, lambda m: m.change(6, 6, values={"Pbot": 1}), False, "is no step", "step"),
    "a clock is not reset": (PLAY, lambda m: m.change(7, 7, clocks={"Cbot": 4.3}), False, "Cbot is", "clock"),
    "a clock is a little beside": (PLAY, lambda m: m.change(7, 7, clocks={"Cbot": 5e-4}), False, "Cbot is", "clock"),
    "a command that the strategy does not hold": (
        other(4, (20.2, "bot:bot_desk2hall@")), unchanged, True, "does not hold", "command"
    ),
    "a command that was due longer ago than the reaction": (
        other(0, at(UNLOCKED, 20.1), at(LEAVES, 20.15), at(SETS_OUT, 22.0)), unchanged, False, "was not due", "command"
    ),
    "a command that was never due": (
        other(0, at(LEAVES, 20.0), at(UNLOCKED, 22.0), at(SETS_OUT, 22.1)), unchanged, True, "was not due", "command"
    ),
    "a command that its guard forbids": (other(6, at(FETCHES, 24.7)), unchanged, True, "its guard forbids", "early"),
    "a command while the mission holds": (PLAY, lambda m: m.hold(6), True, "the mission was holding", "held"),
    "a plan that was never published": (PLAY, lambda m: m.change(5, plan=3), True, "never published", "plan"),
    "a robot is too early": (other(5, at(REACHES, 23.0)), unchanged, False, "does not allow it", "early"),
    "a robot is too late": (other(5, at(REACHES, 27.0)), unchanged, False, "does not allow it", "late"),
    "somebody breaks an assumption": (
        PLAY, lambda m: m.change(4, values={"assume1": 0}), False, "keeps to", "assumption"
    ),
    "an order for another place": (
        PLAY, lambda m: m.order(0, location="going_desk_to_hall"), True, "not what was last commanded", "order"
    ),
    "an order for something else": (PLAY, lambda m: m.order(1, action="answer"), True, "", "order"),
    "an order that follows from no command": (
        PLAY, lambda m: m.order(0, at=12.0, seq=4), True, "not what was last commanded", "order"
    ),
    "an order after what was ordered is over": (
        PLAY, lambda m: m.orders.insert(1, replace(m.orders[0], at=25.0)), True, "not what was last", "order"
    ),
    "an order that was given before": (
        other(4, (20.2, "bot:bot_desk2hall@"), (24.5, "bot_going_desk_to_hall2hall"), (25.6, "bot:answer@")),
        lambda m: m.orders.append(replace(m.orders[1], at=26.0)), True, "for the second time", "order",
    ),
    "no order": (PLAY, lambda m: m.orders.pop(0), False, "", "untold"),
    "no word": (PLAY, lambda m: m.words.pop(6), True, "", "unsaid"),
    "a command of somebody else": (
        PLAY, lambda m: m.words.append(replace(m.words.pop(5), node="controllerObj")), True, "", "owner"
    ),
    "a goal that is not reached yet": (PLAY, lambda m: m.change(8, status="won"), True, "", "end"),
    "a mission that goes on after its end": (PLAY, lambda m: m.change(8, 8, status="stopped"), True, "", "end"),
    "a deadline that has passed": (
        other(3, (39.5, "bot:bot_desk2hall@"), (43.0, "guest:guest_hall2desk")), unchanged, False,
        "does not allow it", "deadline",
    ),
    "a condition is broken, and the mission goes on": (
        other(7, (25.7, "guest:guest_hall2shelf"), (30.2, "guest_going_hall_to_shelf2shelf"), (31.0, "fetchDONE")),
        unchanged, True, "does not count as lost", "lost",
    ),
    "a mission is lost, and nothing is broken": (
        PLAY, lambda m: m.change(8, locations={"obj2": "lose"}, status="lost"), True, "is not broken there", "lost"
    ),
}  # fmt: skip


def said_in_simulations(made: Course, late: bool) -> List[str]:
    """What the judge of simulations holds against a course."""
    on = stage()
    judge = Judge(on.arena, on.commands, on.solution.objective.bad, on.reaction, late, 0.0, broken_of(on.scenario))
    shown = [(state.stamp, 0, state) for state in made.states]
    newest = 0
    for moment, _, what in sorted([*shown, *((o.at, 1, o) for o in made.orders)], key=lambda each: each[:2]):
        if isinstance(what, SystemState):
            judge.on_state(what, moment)
            newest = what.seq
        else:
            event = next((s.event for s in made.states if s.seq == what.seq), "")
            at_once = not is_under_way(what.location)
            judge.on_order(Order(what.robot, event, what.seq, what.location, at_once), newest, newest, what.again)
    return judge.problems


def said_of_recordings(made: Course, late: bool) -> List[str]:
    """The kinds of what the judge of recordings, and that of objectives, hold against a course."""
    record = MissionRecord(tuple(made.states), tuple(made.words), tuple(made.orders), made.plans, is_exact=True)
    found = check(record, stage().game, 5e-6, float("inf") if late else 0.0).findings
    promises = Promises(stage().scenario, exact=False)
    for state in made.states:
        promises.on_state(state, state.stamp)
    kinds = [finding.kind for finding in found if finding.level == FAULT or (not late and finding.level != NOTE)]
    return kinds + ["lost" for text in promises.problems if "lost" in text]


@pytest.mark.parametrize("late", [False, True])
def test_nothing_is_found_in_a_mission_as_it_should_be(late: bool) -> None:
    assert said_in_simulations(course(PLAY), late) == said_of_recordings(course(PLAY), late) == []


@pytest.mark.parametrize("name", FAULTS)
def test_every_fault_is_found(name: str) -> None:
    play, change, late, in_simulations, of_recordings = FAULTS[name]
    made = course(play)
    change(made)
    said = said_in_simulations(made, late)
    assert any(in_simulations in text for text in said) if in_simulations else not said, said
    assert of_recordings in said_of_recordings(made, late), said_of_recordings(made, late)
