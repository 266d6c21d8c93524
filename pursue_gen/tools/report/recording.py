"""The steps of one mission: from a bag, from a journal, or from a simulation."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Dict, Iterable, List, Mapping, Optional, Tuple

from pursue_gen.language.scenario import Scenario
from pursue_gen.tga.network import Network
from pursue_gen.tools.simulation.mission import SimulatedMission
from pursue_gen.tools.simulation.runs import Case
from pursue_gen.tools.simulation.stage import Stage, stage_of
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
