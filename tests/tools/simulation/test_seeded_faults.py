"""Faults that are put into recorded missions, one each: every one of them is found."""

from __future__ import annotations

import functools
from dataclasses import dataclass, replace
from typing import Any, Callable, List, Mapping, Tuple

import pytest

from pursue_gen.language import parse
from pursue_gen.solving.rules import DEFAULT
from pursue_gen.solving.solution import solve_scenario
from pursue_gen.tools.replay.moves import after
from pursue_gen.tools.replay.record import RecordedWord, RobotOrder, read_word
from pursue_gen.tools.simulation.promises import Promises
from pursue_gen.tools.simulation.recorder import Recorder
from pursue_gen.tools.simulation.stage import Stage, stage_of
from pursue_gen.workspace import Options
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

Fault = Tuple[Play, Callable[[Course], Any], bool, str]
"""The play, how the course is changed, whether messages may be late in it, and what is said of it."""


def unchanged(made: Course) -> None:
    """The fault is in the play."""


def other(place: int, *steps: Any) -> Any:
    """The play with other steps from this place on."""
    return (*PLAY[:place], *steps)


def at(step: Any, moment: float) -> Any:
    """The step at another moment."""
    return (moment, *step[1:])


TO_HALL, IN_HALL, ANSWERS = (20.2, "bot:bot_desk2hall@"), (24.5, "bot_going_desk_to_hall2hall"), (25.6, "bot:answer@")

FAULTS: Mapping[str, Fault] = {
    "a number is skipped": (
        PLAY, lambda m: [m.change(s, s, seq=s + 1) for s in range(9, 3, -1)], False, "states after 3 are missing"
    ),
    "a state is another one when it is shown again": (
        PLAY, lambda m: m.states.insert(4, m.states[3]._replace(locations=m.states[2].locations)), False,
        "two different states have number 3",
    ),
    "it does not begin at the beginning": (
        PLAY, lambda m: m.change(0, 1, locations={"guest": "hall"}), False, "this is not where the scenario begins"
    ),
    "it begins later": (PLAY, lambda m: [m.states.pop(0), m.states.pop(0)], True, "the recording begins with state 2"),
    "a robot is somewhere else": (
        PLAY, lambda m: m.change(7, locations={"bot": "hall"}), False, "_desk_to_shelf2shelf by bot is no step"
    ),
    "a change without an event": (
        PLAY, lambda m: m.change(3, 3, event="", agent=""), False, "what happened is no step of the model"
    ),
    "a variable is not set": (PLAY, lambda m: m.change(6, 6, values={"Pbot": 1}), False, "is no step of the model"),
    "a clock is not reset": (PLAY, lambda m: m.change(7, 7, clocks={"Cbot": 4.3}), False, "clocks do not fit"),
    "a clock is a little beside": (PLAY, lambda m: m.change(7, 7, clocks={"Cbot": 5e-4}), False, "clocks do not fit"),
    "a command that the strategy does not hold": (
        other(4, TO_HALL), unchanged, True, "bot_desk2hall by bot is not what the strategy prescribes in state 5"
    ),
    "the same, but nobody has commanded it": (
        other(4, (20.2, "bot:bot_desk2hall")), unchanged, True, "not what the strategy prescribes in state 5"
    ),
    "a command that was due longer ago than the reaction": (
        other(0, at(UNLOCKED, 20.1), at(LEAVES, 20.15), at(SETS_OUT, 22.0)), unchanged, False,
        "bot_desk2shelf by bot is not what the strategy prescribes in state 3",
    ),
    "a command that was never due": (
        other(0, at(LEAVES, 20.0), at(UNLOCKED, 22.0), at(SETS_OUT, 22.1)), unchanged, True,
        "bot_desk2shelf by bot is not what the strategy prescribes in state 3",
    ),
    "a command that its guard forbids": (
        other(6, at(FETCHES, 24.7)), unchanged, True, "fetch by bot comes 0.80 time units early for the model"
    ),
    "a command while the mission holds": (PLAY, lambda m: m.hold(6), True, "was taken while the mission held"),
    "a plan that was never published": (
        PLAY, lambda m: m.change(5, plan=3), True, "plan 3 is not in the recording"
    ),
    "a robot is too early": (other(5, at(REACHES, 23.0)), unchanged, False, "early for the model"),
    "a robot is too late": (other(5, at(REACHES, 27.0)), unchanged, False, "late for the model"),
    "somebody breaks an assumption": (
        PLAY, lambda m: m.change(4, values={"assume1": 0}), False, "an assumption is broken: guest is never"
    ),
    "an order for another place": (
        PLAY, lambda m: m.order(0, location="going_desk_to_hall"), True, "(going_desk_to_hall), and began"
    ),
    "an order for something else": (
        PLAY, lambda m: m.order(1, action="answer"), True, "ordered answer (doing_fetch_in_shelf), and began"
    ),
    "an order that follows from no command": (
        PLAY, lambda m: m.order(0, at=12.0, seq=4), True, "gave bot a goal that follows from no state"
    ),
    "an order after what was ordered is over": (
        PLAY, lambda m: m.orders.insert(1, replace(m.orders[0], at=25.0)), True, "after that was over"
    ),
    "an order that was given before": (
        other(4, TO_HALL, IN_HALL, ANSWERS), lambda m: m.orders.append(replace(m.orders[1], at=26.0)), True,
        "bot is ordered answer for the second time",
    ),
    "no order": (PLAY, lambda m: m.orders.pop(0), False, "bot got no order to begin bot_desk2shelf"),
    "no word": (PLAY, lambda m: m.words.pop(6), True, "no word for bot_going_desk_to_shelf2shelf was recorded"),
    "a command of somebody else": (
        PLAY, lambda m: m.words.append(replace(m.words.pop(5), node="controllerObj")), True, "controllerObj commands"
    ),
    "a goal that is not reached yet": (
        other(7), lambda m: m.change(8, status="won"), True, "its status is won, but reachObj is not win"
    ),
    "a mission that goes on after its end": (
        PLAY, lambda m: m.change(8, 8, status="stopped"), True, "the mission went on after it was stopped"
    ),
    "a deadline that has passed": (
        other(3, at(TO_HALL, 39.05), (43.2, "guest:guest_hall2desk")), unchanged, False, "obj was at its deadline 0.05"
    ),
    "a deadline that has passed, and messages may be late": (
        other(3, at(TO_HALL, 39.5), (43.7, "guest:guest_hall2desk")), unchanged, True, "obj was at its deadline 0.50"
    ),
    "a condition is broken, and the mission goes on": (
        other(7, (25.7, "guest:guest_hall2shelf"), (30.2, "guest_going_hall_to_shelf2shelf"), (31.0, "fetchDONE")),
        unchanged, True, "which does not count as lost",
    ),
    "a mission is lost, and nothing is broken": (
        PLAY, lambda m: m.change(8, locations={"obj2": "lose"}, status="lost"), True, "state 8 counts as lost, but"
    ),
}  # fmt: skip


def said_of(made: Course, late: bool) -> List[str]:
    """What is held against a course: by its scenario's network and strategy, and by its objectives."""
    recorder, promises = Recorder(), Promises(stage().scenario, exact=False)
    recorder.states, recorder.words, recorder.orders = made.states, made.words, made.orders
    for state in made.states:
        promises.on_state(state, state.stamp)
    judged = recorder.judged(stage().game, late, 0.0, made.states[-1].stamp)
    return [*judged.problems, *promises.problems]


@pytest.mark.parametrize("late", [False, True])
def test_nothing_is_found_in_a_mission_as_it_should_be(late: bool) -> None:
    assert said_of(course(PLAY), late) == []


def test_a_deadline_passes_by_itself_whoever_has_said_so_before() -> None:
    made = course((*PLAY[:3], (39.1, "obj_atRisk2lose")))
    assert said_of(made, True) == []
    made.words[-1] = replace(made.words[-1], at=12.0, node="")
    assert said_of(made, True) == []
    made.words.pop()
    assert said_of(made, True) == []


@pytest.mark.parametrize("name", FAULTS)
def test_every_fault_is_found(name: str) -> None:
    play, change, late, said = FAULTS[name]
    made = course(play)
    change(made)
    assert any(said in text for text in said_of(made, late)), said_of(made, late)


def test_an_end_is_not_told_before_the_order_to_begin_has_had_its_time() -> None:
    """A robot that gets no order, because the mission ends first, is no fault."""
    made = course(PLAY[:5])
    made.orders.clear()
    assert said_of(made, False) == []
