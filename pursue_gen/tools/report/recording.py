"""The steps of one mission: from a bag, from a journal, or from a simulation; and what changes in it beside where
agents are: conditions, turns, counts, states, deadlines, assumptions."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Dict, Iterable, List, Mapping, Optional, Tuple

from pursue_gen.language import network_names as names
from pursue_gen.language.conditions import Condition, condition_text
from pursue_gen.language.network_names import has_happened
from pursue_gen.language.objectives.base import Breaks
from pursue_gen.language.scenario import Scenario
from pursue_gen.tga.network import Network
from pursue_gen.tools.simulation.meaning import holds
from pursue_gen.tools.simulation.mission import SimulatedMission
from pursue_gen.tools.simulation.runs import Case
from pursue_gen.tools.simulation.stage import Stage, stage_of
from pursue_gen.vocabulary.statuses import statuses
from pursue_runtime.sentences import in_words
from pursue_runtime.state import ENDED, HOLDING, LOST, RUNNING, STOPPED, WAITING, WON, SystemState


@dataclass(frozen=True)
class Step:
    """A state that the mission came to, `at` time units since its start; by an event of an agent ("": something else).

    `locations` and `values` are those of the network's automata and variables; `plan` counts the plans in force.
    """

    at: float
    locations: Mapping[str, str]
    values: Mapping[str, int]
    agent: str = ""
    event: str = ""
    status: str = RUNNING
    reason: str = ""
    plan: int = 0
    lost: Tuple[str, ...] = ()


@dataclass(frozen=True)
class Recording:
    """A mission: `steps` by time, the first at 0; it was recorded until `end` (time units). `source`: where from."""

    scenario: Scenario
    network: Network
    steps: Tuple[Step, ...]
    end: float
    source: str

    @property
    def status(self) -> str:
        """The status at the end."""
        return self.steps[-1].status if self.steps else WAITING

    @property
    def agents(self) -> Tuple[str, ...]:
        """The agents, in order of declaration."""
        return tuple(agent.name for agent in self.scenario.agents)


@dataclass(frozen=True)
class Stay:
    """A value that lasted: from `start` to `end` (time units); `over`: it ended before the recording did."""

    start: float
    end: float
    what: str
    over: bool = True


STATUS_TEXTS = {WON: "goal reached", LOST: "lost", STOPPED: "stopped", HOLDING: "holding"}


def ending_text(recording: Recording) -> str:
    """How the mission ended, in a word or two."""
    return status_text(recording, recording.status) or "end of the recording"


def status_text(recording: Recording, status: str) -> str:
    """A status of the mission, in a word or two; "" where it goes on, or has not begun."""
    if status == WON and not recording.scenario.reach:
        return "ended, all was kept"
    return STATUS_TEXTS.get(status, "")


def stays(recording: Recording, automaton: str) -> Tuple[Stay, ...]:
    """The locations of an automaton, in order of time."""
    return lasting(recording, ((step.at, step.locations.get(automaton, "")) for step in recording.steps))


def lasting(recording: Recording, changes: Iterable[Tuple[float, str]]) -> Tuple[Stay, ...]:
    """The values and how long each lasted, from `changes` (time, value from then on); equal ones are joined."""
    found: List[Stay] = []
    for at, what in changes:
        if found and found[-1].what == what:
            continue
        if found:
            found[-1] = replace(found[-1], end=at, over=True)
        found.append(Stay(at, recording.end, what, False))
    return tuple(stay for stay in found if stay.end > stay.start or stay is found[-1])


# Where recordings come from -------------------------------------------------------------------------------------------


def from_states(
    states: Iterable[SystemState], scenario: Scenario, network: Network, source: str, until: float = 0.0
) -> Optional[Recording]:
    """The mission with these published states; its end is at least `until` (time units). None where it has not started.
    """
    steps: List[Step] = []
    started: Optional[float] = None
    seen: Dict[int, str] = {}
    for state in sorted(states, key=lambda state: state.seq):
        if state.status == WAITING or seen.get(state.seq) == state.status:
            continue
        led_by = ("", "") if state.seq in seen else (state.agent, state.event)  # won once all is acknowledged
        seen[state.seq] = state.status
        started = state.stamp if started is None else started
        at = max((state.stamp - started) / state.unit, steps[-1].at if steps else 0.0)
        reason = in_words(state.reason, scenario.shown)
        locations = {name: network.places.get((name, there), there) for name, there in state.locations.items()}
        steps.append(Step(at, locations, state.values, *led_by, state.status, reason, state.plan, state.lost))
    if not steps:
        return None
    end = steps[-1].at if steps[-1].status in ENDED else max(steps[-1].at, until)
    return Recording(scenario, network, tuple(steps), end, source)


def simulated(case: Case, seed: int, stage: Optional[Stage] = None) -> Recording:
    """One simulated mission, on this stage: the same as `simulation.runs` plays with this seed."""
    stage = stage or stage_of(case.scenario, case.won, case.options)
    mission = SimulatedMission(stage, case.settings, seed, case.worst_times())
    until, source = mission.run().time, f"simulated mission {seed}"
    found = from_states(mission.recorder.states, case.scenario, case.won.network, source, until)
    assert found is not None, "a simulated mission starts at once"
    return found


def conditions(scenario: Scenario) -> Dict[str, Condition]:
    """The conditions of a scenario by their texts, each once, in its order."""
    found: Dict[str, Condition] = {}
    for condition, _ in scenario.conditions():
        found.setdefault(condition_text(condition), condition)
    return found


def holding(recording: Recording, condition: Condition) -> Tuple[Stay, ...]:
    """When a condition held."""
    changes = ((step.at, str(_holds(recording, condition, step))) for step in recording.steps)
    return tuple(stay for stay in lasting(recording, changes) if stay.what == "True")


def pauses(scenario: Scenario) -> Dict[str, Breaks]:
    """The objectives that want a pause, by the name of a lane."""
    found = [(how, how.last, how.too_soon) for how in (each.breaks for each in scenario.safety)]
    return {f"pause: {last.shown} → {then.shown}": how for how, last, then in found if last and then}


def paused(recording: Recording, how: Breaks) -> Tuple[Tuple[Stay, float], ...]:
    """When an event had to wait until its pause was over, each with the end of the pause."""
    ended = next(has_happened(each) for each in recording.scenario.events if how.last and each.name == how.last.name)
    starts = [step.at for step in recording.steps if step.event == ended]
    found: List[Tuple[Stay, float]] = []
    for start, later in zip(starts, [*starts[1:], float("inf")]):
        until = start + float(how.pause)
        end = min(until, later, recording.end)
        found.append((Stay(start, end, ended, end < recording.end), until))
    return tuple(found)


def broken(recording: Recording) -> Tuple[Tuple[str, Stay], ...]:
    """The assumptions that were broken, in words, and since when."""
    found: List[Tuple[str, Stay]] = []
    for number, assumption in enumerate(recording.scenario.assumed, start=1):
        variable = names.assumption(number)
        changes = ((step.at, str(step.values.get(variable, 1))) for step in recording.steps)
        found += [(assumption.clause, stay) for stay in lasting(recording, changes) if stay.what == "0"]
    return tuple(found)


def changes(recording: Recording) -> Tuple[str, ...]:
    """For each step what it has changed, as in `bag of bot: next: unload`; "" where that is nothing."""
    shown = [_texts(recording, step) for step in recording.steps]
    found = []
    for before, now in zip([{}, *shown], shown):
        found.append("; ".join(f"{label}: {text}" for label, text in now.items() if before.get(label) != text))
    return tuple(found)


def _texts(recording: Recording, step: Step) -> Dict[str, str]:
    """label → what that is at."""
    texts = {}
    for status in statuses(recording.scenario, recording.network):
        value = status.text(step.locations, step.values)
        if value is not None:
            texts[status.label] = value
    for text, condition in conditions(recording.scenario).items():
        texts[text] = "holds" if _holds(recording, condition, step) else "does not hold"
    return texts


def _holds(recording: Recording, condition: Condition, step: Step) -> bool:
    """True if the condition holds in a state; False also where the state is not one of this scenario."""
    try:
        return holds(condition, recording.scenario, step.locations, step.values)
    except KeyError:
        return False
