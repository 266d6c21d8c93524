"""Where each lift is sent, and for whom it is open at which floor. Times are seconds of ROS time.

A robot that is on a way by a lift waits for it at the floor where it sets off, says on `pursue/aboard` when it is in
the cabin, and then waits there for the floor to which it rides.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any, Dict, Iterator, List, Mapping, NamedTuple, Optional, Set, Tuple

from pursue_runtime.data import DataError
from pursue_runtime.doors.keeper import SETTLE, Asking, Keeper
from pursue_runtime.doors.opened import Opened
from pursue_runtime.state import SystemState

ABOARD = "pursue/aboard"
"""The topic on which it is said that a robot is in the cabin, as `bot1:aboard#12` (`event_words`)."""
IS_ABOARD = "aboard"

NOWHERE = ""
"""What a lift is asked that nobody needs, and where one is that is at no floor, or closed."""

Rides = Mapping[str, Mapping[str, Tuple[str, str]]]
"""Agent → the locations of the agent in which it needs a lift → the floor from which it rides, and to which."""


class LiftData(NamedTuple):
    """What ui.yaml says of a lift: the time units in which it comes, and in which it then is at another floor, both at
    the latest; its floors from the lowest one up."""

    within: float
    takes: float
    floors: Tuple[str, ...]
    rides: Rides


def gate_at(lift: str, floor: str) -> str:
    """Return what the door of a lift at a floor is called on `pursue/doors`: no name has a blank."""
    return f"{lift} at {floor}"


def read_lifts(settings: Mapping[str, Any]) -> Dict[str, LiftData]:
    """Return the lifts in the content of ui.yaml. Raises DataError."""
    lifts = settings.get("lifts", {})
    if not isinstance(lifts, dict):
        raise DataError("ui.yaml: expected lifts: and a line for each lift")
    return {str(name): _read(str(name), lift) for name, lift in lifts.items()}


def _read(name: str, lift: Any) -> LiftData:
    data: Mapping[str, Any] = lift if isinstance(lift, dict) else {}
    floors, rides = data.get("floors"), data.get("rides")
    is_sound = all(isinstance(data.get(key), (int, float)) for key in ("within", "takes"))
    is_sound = is_sound and isinstance(floors, list) and isinstance(rides, dict)
    if floors is None or rides is None or not (is_sound and all(_are_rides(ways, floors) for ways in rides.values())):
        raise DataError(f"ui.yaml: expected within:, takes:, floors: and rides: of the lift {name}, got {lift!r}")
    found = {str(agent): {str(at): (a, b) for at, (a, b) in ways.items()} for agent, ways in rides.items()}
    return LiftData(float(data["within"]), float(data["takes"]), tuple(map(str, floors)), found)


def _are_rides(ways: object, floors: List[Any]) -> bool:
    return isinstance(ways, dict) and all(
        isinstance(ends, list) and len(ends) == 2 and all(end in floors for end in ends) for ends in ways.values()
    )


@dataclass
class _Ride:
    """Somebody on a way by a lift, since the state with this number. `entered`: the door was open for it at the floor
    where it is to pass it next, so that it may be in it."""

    location: str
    ends: Tuple[str, str]
    since: int
    aboard: bool = False
    entered: bool = False

    @property
    def floor(self) -> str:
        """Return the floor at which it is to pass the door next."""
        return self.ends[self.aboard]


@dataclass
class _Lift(Asking):
    """A lift, and who is on a way by it, in the order in which they set off."""

    rides: Dict[str, _Ride] = field(default_factory=dict)

    @property
    def target(self) -> str:
        """Return the floor to which it is to go: it stays where somebody may be in its door; who is in it comes before
        who waits for it."""
        in_door = [ride for ride in self.rides.values() if ride.entered]
        aboard = [ride for ride in self.rides.values() if ride.aboard]
        return next((ride.floor for ride in (*in_door, *aboard, *self.rides.values())), NOWHERE)


class LiftKeeper(Keeper):
    """Has each lift come to who waits for it, and go to where who is in it rides; it is left alone otherwise.

    Its door counts as open for somebody at a floor when it reports that after it was asked to come there. It is never
    sent away from there before who was let in is aboard, or who was let out has arrived, also if the mission is over,
    or holds.
    """

    def __init__(self, lifts: Mapping[str, LiftData]) -> None:
        self._data = lifts
        self._lifts = {name: _Lift() for name in lifts}
        super().__init__(self._lifts)

    def on_state(self, state: SystemState, now: float) -> None:
        """Take a state of the mission."""
        is_first = state.mission != self._mission
        self._mission, self._seq = state.mission, state.seq
        for name, lift in self._lifts.items():
            data = self._data[name]
            lift.settle = min(SETTLE, min(data.within, data.takes) * state.unit / 2)
            here = {agent: state.locations.get(agent, "") for agent in data.rides}
            lift.rides = {a: ride for a, ride in lift.rides.items() if here[a] == ride.location and not is_first}
            for agent, ways in data.rides.items():
                if agent not in lift.rides and here[agent] in ways:  # what it reported to a keeper before this counts
                    lift.rides[agent] = _Ride(here[agent], ways[here[agent]], 0 if is_first else state.seq)
            if lift.rides or lift.asked is not None or state.seq > 0:
                lift.ask(lift.target, now)

    def on_aboard(self, agent: str, as_of: Optional[int], now: float) -> None:
        """Take that somebody is in the cabin, as of a state with this number; None: of any."""
        for lift in self._lifts.values():
            ride = lift.rides.get(agent)
            if ride is not None and not ride.aboard and (as_of is None or as_of >= ride.since):
                ride.aboard, ride.entered = True, False
                lift.ask(lift.target, now)

    def opened(self, now: float) -> Opened:
        """Return for whom which lift is open at which floor now; whoever is named may be in its door from then on."""
        gates: Dict[str, Set[str]] = {}
        for name, lift in self._lifts.items():
            for agent, ride in lift.rides.items() if lift.is_open(now) else ():
                if ride.floor == lift.asked:
                    ride.entered = True
                    gates.setdefault(gate_at(name, ride.floor), set()).add(agent)
        return Opened(self._mission, self._seq, {gate: frozenset(agents) for gate, agents in gates.items()})

    def late(self, now: float, unit: float) -> Iterator[str]:
        """Return what should be there by now, as in `lift1 at hall0`. `unit`: the seconds of a time unit."""
        for name, seconds in self.waited_for(now).items():
            lift, data = self._lifts[name], self._data[name]
            if seconds > (data.takes if any(ride.aboard for ride in lift.rides.values()) else data.within) * unit:
                yield gate_at(name, str(lift.asked))
