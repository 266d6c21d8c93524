"""Times that were measured: how long agents were on a way or at work, in recordings of missions or of drives."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Dict, Iterable, Iterator, List, Mapping, Optional, Sequence, Set, Tuple, Union

from pursue_gen.language.lifts import driven
from pursue_gen.language.network_names import agent_clock, going
from pursue_gen.language.scenario import Scenario
from pursue_gen.language.symbols import UNDER_WAY, Role, role_of
from pursue_gen.tools.replay.record import MissionRecord
from pursue_gen.vocabulary.agents import place
from pursue_runtime.drives.report import ARRIVED, Drive
from pursue_runtime.locations import action_of, breaks_off
from pursue_runtime.state import WAITING, SystemState

_SAME = 0.005
"""Seconds between the beginnings that several agents have of what they do together. Not measured."""


@dataclass(frozen=True)
class Way:
    """An agent on its way from `a` to `b`."""

    agent: str
    a: str
    b: str

    def __str__(self) -> str:
        return f"{self.agent} from {self.a} to {self.b}"


@dataclass(frozen=True)
class Work:
    """An event with a duration, whoever does it."""

    event: str

    def __str__(self) -> str:
        return self.event


Measured = Union[Way, Work]


@dataclass(frozen=True)
class Sample:
    """It took so many seconds; `at`: when it began, in seconds since the recording did; `file`: where it was."""

    what: Measured
    seconds: float
    file: str = ""
    at: float = 0.0


@dataclass(frozen=True)
class Unused:
    """What was begun and does not count: `seconds` as far as it went, and why, in words."""

    what: Measured
    seconds: float
    why: str
    file: str = ""


@dataclass(frozen=True)
class Samples:
    """What a recording tells. `unit`: seconds per time unit, None where it does not say; `strangers`: movements and
    events that the scenario does not have, in words; `agents`: all that it names."""

    measured: Tuple[Sample, ...]
    unused: Tuple[Unused, ...] = ()
    unit: Optional[float] = None
    strangers: Tuple[str, ...] = ()
    agents: Tuple[str, ...] = field(default=())
    problems: Tuple[str, ...] = ()


def of_record(record: MissionRecord, scenario: Scenario, file: str = "") -> Samples:
    """The times in a recording: of the mission in it, and of the drives."""
    names = _Names(scenario)
    stays = _Stays(names, file)
    for state in record.states:
        stays.follow(state)
    stays.end()
    begun = min((drive.start for drive in record.drives), default=0.0)
    for drive in record.drives:
        what = names.driven(drive)
        if what is None:
            stays.strangers.add(drive.action or str(Way(drive.robot, drive.a, drive.b)))
        elif drive.outcome == ARRIVED:
            stays.measured.append(Sample(what, names.whole(what, drive.seconds), file, drive.start - begun))
        else:
            why = f"{drive.outcome}{f': {drive.text}' if drive.text else ''}"
            stays.unused.append(Unused(what, drive.seconds, why, file))
    units = {state.unit for state in record.states}
    agents = {drive.robot for drive in record.drives}.union(*(state.locations for state in record.states[:1]))
    return Samples(
        tuple(stays.measured), tuple(stays.unused), max(units, default=None), tuple(sorted(stays.strangers)),
        tuple(sorted(agents)), record.problems,
    )  # fmt: skip


def together(parts: Iterable[Samples]) -> Samples:
    """The times of several recordings. Their units have been compared before."""
    found = list(parts)
    return Samples(
        tuple(each for part in found for each in part.measured),
        tuple(each for part in found for each in part.unused),
        next((part.unit for part in found if part.unit is not None), None),
        tuple(sorted({each for part in found for each in part.strangers})),
        tuple(sorted({each for part in found for each in part.agents})),
        tuple(each for part in found for each in part.problems),
    )


def by_what(samples: Sequence[Sample]) -> Mapping[Measured, Tuple[Sample, ...]]:
    """The samples of each way and of each event."""
    found: Dict[Measured, List[Sample]] = {}
    for sample in samples:
        found.setdefault(sample.what, []).append(sample)
    return {what: tuple(some) for what, some in found.items()}


class _Names:
    """From locations to ways and events of a scenario."""

    def __init__(self, scenario: Scenario) -> None:
        self.scenario = scenario
        self._ways: Dict[Tuple[str, str], Way] = {
            (agent.name, going(*way)): Way(agent.name, *way)
            for agent in scenario.agents
            for way in driven(scenario, agent)
        }
        self.rides = {(each.name, going(*way)) for each in scenario.agents for way in scenario.movements(each)}
        self._events = {event.name: event.split or 1 for event in scenario.events if event.window is not None}

    def whole(self, what: Measured, seconds: float) -> float:
        """How long all of it takes where one part of it, or all of what has none, was measured to take so long."""
        return seconds * self._events[what.event] if isinstance(what, Work) else seconds

    def way(self, agent: str, location: str) -> Optional[Way]:
        """The way that an agent is on there; None where the scenario has none."""
        return self._ways.get((agent, location))

    def driven(self, drive: Drive) -> Optional[Measured]:
        """What a drive measures; None where the scenario has nothing like it."""
        if drive.action:
            return Work(drive.action) if drive.action in self._events else None
        return self.way(drive.robot, going(drive.a, drive.b))

    def what(self, agent: str, location: str) -> Optional[Measured]:
        """What an agent does there; None where the scenario has nothing like it."""
        if role_of(location) is Role.WAY:
            return self.way(agent, location)
        event = action_of(location)
        return Work(event) if event in self._events else None


@dataclass
class _Stay:
    """An agent is under way, or at work, since a moment (seconds); `flaws` say why that is not to count."""

    location: str
    start: float
    leads: bool
    flaws: Set[str]


class _Stays:
    """The movements and actions in the states of a mission, one state after the other.

    When one began is what the agent's clock says, which the observer resets then. So a state that is missing at its
    beginning does no harm, and one at its end is noticed.
    """

    def __init__(self, names: _Names, file: str) -> None:
        self.measured: List[Sample] = []
        self.unused: List[Unused] = []
        self.strangers: Set[str] = set()
        self._names, self._file = names, file
        self._open: Dict[str, _Stay] = {}
        self._before: Optional[SystemState] = None
        self._begun = 0.0
        self._shared: Dict[Measured, float] = {}

    def follow(self, state: SystemState) -> None:
        """Takes the next state."""
        if state.status == WAITING:
            return
        before = self._before
        if before is None:
            self._begun = state.stamp
        is_gap = before is not None and state.seq > before.seq + 1
        for agent, location in state.locations.items():
            stay = self._open.get(agent)
            again = is_gap and stay is not None and _start(agent, state) > stay.start + _SAME
            if stay is not None and (stay.location != location or again):
                self._close(agent, stay, state, is_gap)
                del self._open[agent]
                stay = None
            if stay is None and role_of(location) in UNDER_WAY:
                begun = self._begin(agent, location, state)
                if begun is not None:
                    self._open[agent] = stay = begun
            if stay is not None:
                stay.flaws.update(_flaws(agent, state))
        self._before = state

    def end(self) -> None:
        """The recording is over: what goes on has no end."""
        last = self._before
        if last is None:
            return
        for agent, stay in self._open.items():
            what = self._names.what(agent, stay.location)
            if what is not None and stay.leads:
                why = ", ".join(sorted(stay.flaws)) or "it had not ended when the mission did"
                self.unused.append(Unused(what, last.stamp - stay.start, why, self._file))

    def _begin(self, agent: str, location: str, state: SystemState) -> Optional[_Stay]:
        if agent_clock(agent) not in state.clocks or role_of(location) is Role.SOMEWHERE:
            return None  # no agent, or one of whom it is to be said where it starts
        start, what = _start(agent, state), self._names.what(agent, location)
        if what is None and (agent, location) not in self._names.rides:
            self.strangers.add(f"{agent} {place(self._names.scenario, location)}")
        leads = True
        if isinstance(what, Work):  # several may do it together, and it counts once
            leads = abs(self._shared.get(what, float("-inf")) - start) > _SAME
            self._shared[what] = start
        return _Stay(location, start, leads, set())

    def _close(self, agent: str, stay: _Stay, state: SystemState, is_gap: bool) -> None:
        what = self._names.what(agent, stay.location)
        if what is None or not stay.leads:
            return
        took, here = state.stamp - stay.start, state.locations[agent]
        if is_gap and _start(agent, state) < state.stamp - _SAME:
            stay.flaws.add("the recording lacks its end")
        elif isinstance(what, Way) and here != what.b:
            stay.flaws.add("it turned round")
        elif breaks_off(stay.location, state.event):
            stay.flaws.add("it was broken off")
        if stay.flaws or took <= 0:
            why = ", ".join(sorted(stay.flaws)) or "it took no time"
            self.unused.append(Unused(what, took, why, self._file))
        else:
            self.measured.append(Sample(what, self._names.whole(what, took), self._file, stay.start - self._begun))


def _start(agent: str, state: SystemState) -> float:
    """When the agent began what it does, in seconds; or ended what it did last."""
    return state.stamp - state.clocks.get(agent_clock(agent), 0.0) * state.unit


def _flaws(agent: str, state: SystemState) -> Iterator[str]:
    """Why what an agent does in this state says nothing of how long it takes."""
    for name in ("lost", "held", "displaced"):
        if agent in getattr(state, name):
            yield name
