"""Random scenarios of a lab's size, by seed: a floor, robots, people who walk and call, and promises to keep.

`python -m benchmarks.lab_scenarios 7` prints one (`--large`: one of the larger size). The same seed gives the same text
on every machine. A deadline is what the promise takes a robot alone, times a factor between TIGHT and GENEROUS, so a
promise that cannot be kept is one that others are in the way of.
"""

from __future__ import annotations

import argparse
import math
from dataclasses import dataclass
from functools import lru_cache
from random import Random
from typing import Callable, Dict, List, Optional, Sequence, Tuple

TIGHT, GENEROUS = 1.2, 3.0
"""The least and the largest factor between what a promise takes and its deadline."""

_REST = 2
"""Time units that each leg takes beside its way: the rest before it, and the window in which it ends."""

_TRIES = 20


@dataclass(frozen=True)
class Size:
    """How much there is of everything in a scenario."""

    places: int
    robots: int
    people: int
    promises: int


SMALL = Size(places=10, robots=3, people=2, promises=4)
LARGE = Size(places=20, robots=5, people=4, promises=8)

LABS: Dict[str, Tuple[Size, float, float]] = {"lab": (SMALL, 10.0, 0.97), "large lab": (LARGE, 30.0, 0.9)}
"""Random lab scenarios: their size, processor seconds after which they are ended, and the part to be decided."""


@dataclass(frozen=True)
class Agent:
    """Somebody on the floor; `mobile`: time units per unit of distance, None for who stays."""

    name: str
    home: str
    mobile: Optional[int]


@dataclass(frozen=True)
class Floor:
    """Where agents are: `halls` and `rooms` are places, a way is two places and their distance."""

    halls: Tuple[str, ...]
    rooms: Tuple[str, ...]
    ways: Tuple[Tuple[str, str, int], ...]

    @property
    def places(self) -> Tuple[str, ...]:
        """All places."""
        return self.halls + self.rooms

    def time(self, agent: Agent, *stops: str) -> int:
        """The time units that an agent needs at most from one stop to the next."""
        times = _times(self, agent.mobile or 1)
        return sum(times[pair] for pair in zip(stops, stops[1:]))


@lru_cache(maxsize=16)
def _times(floor: Floor, mobile: int) -> Dict[Tuple[str, str], int]:
    """The least times between places, of an agent of this speed."""
    never = sum(distance * mobile + _REST for _, _, distance in floor.ways) + 1
    times = {(a, b): 0 if a == b else never for a in floor.places for b in floor.places}
    for a, b, distance in floor.ways:
        times[a, b] = times[b, a] = distance * mobile + _REST
    for via in floor.places:
        for a in floor.places:
            for b in floor.places:
                times[a, b] = min(times[a, b], times[a, via] + times[via, b])
    return times


@dataclass(frozen=True)
class Promise:
    """An objective with what it needs: events, rules, and who can do what (agent, event)."""

    objective: str
    events: Tuple[str, ...] = ()
    rules: Tuple[str, ...] = ()
    abilities: Tuple[Tuple[str, str], ...] = ()


@dataclass(frozen=True)
class Cast:
    """A floor with those who are on it."""

    floor: Floor
    robots: Tuple[Agent, ...]
    people: Tuple[Agent, ...]

    @property
    def walkers(self) -> List[Agent]:
        """The people who walk."""
        return [person for person in self.people if person.mobile]


def lab_scenario(seed: int, size: Size = SMALL) -> str:
    """The PuRSUE-ML of the scenario of this seed."""
    return lab_scenario_with(seed, size)[1]


def lab_scenario_with(seed: int, size: Size) -> Tuple[Cast, str]:
    """The floor of the scenario of this seed with who is on it, and its PuRSUE-ML."""
    draw = Random(f"lab {seed} {size}")
    cast = _cast(draw, size)
    promises: List[Promise] = []
    for number in range(1, size.promises + 1):
        promise = _promise(draw, cast, number)
        for _ in range(_TRIES):
            if promise.objective not in (other.objective for other in promises):
                break
            promise = _promise(draw, cast, number)
        promises.append(promise)
    return cast, _text(cast, promises)


def _cast(draw: Random, size: Size) -> Cast:
    floor = _floor(draw, size.places)
    robots_at = draw.sample(floor.places, size.robots)
    robots = [Agent(f"bot{n}", home, draw.choice((1, 1, 1, 2))) for n, home in enumerate(robots_at, 1)]
    free = [place for place in floor.places if place not in robots_at]
    people = []
    for n in range(1, size.people + 1):
        # The first one walks, of the others every second: somebody has to.
        walks = n == 1 or draw.random() < 0.5
        people.append(Agent(f"person{n}", draw.choice(free), draw.choice((2, 3)) if walks else None))
    return Cast(floor, tuple(robots), tuple(people))


def _floor(draw: Random, places: int) -> Floor:
    """A corridor with rooms on both sides, of which some have a second door; in some the corridor is a ring."""
    halls = tuple(f"hall{n}" for n in range(1, max(1, places * 2 // 5) + 1))
    rooms = tuple(f"room{n}" for n in range(1, places - len(halls) + 1))
    ways = [(a, b, draw.randint(2, 5)) for a, b in zip(halls, halls[1:])]
    doors = {room: draw.choice(halls) for room in rooms}
    ways += [(hall, room, draw.randint(1, 3)) for room, hall in doors.items()]
    if len(halls) > 2 and draw.random() < 0.3:
        ways.append((halls[-1], halls[0], draw.randint(3, 6)))
    for room in draw.sample(rooms, places // 10):
        others = [place for place in (*halls, *rooms) if place not in (room, doors[room])]
        other = draw.choice([place for place in others if doors.get(place) != doors[room]] or others)
        if {room, other} not in [{a, b} for a, b, _ in ways]:
            ways.append((room, other, draw.randint(2, 5)))
    return Floor(halls, rooms, tuple(ways))


# Promises ------------------------------------------------------------------------------------------------------------


def _promise(draw: Random, cast: Cast, number: int) -> Promise:
    kinds = [kind for kind in _KINDS if kind is not _keep_apart or len(cast.robots) > 1]
    return draw.choice(kinds)(draw, cast, number)


def _respond(draw: Random, cast: Cast, number: int) -> Promise:
    """A person calls, and one of one or two robots answers in a room."""
    caller, room = draw.choice(cast.people), draw.choice(cast.floor.rooms)
    able = draw.sample(cast.robots, min(len(cast.robots), draw.choice((1, 1, 1, 2))))
    return _answered(draw, cast, number, caller, room, able)


def _meet(draw: Random, cast: Cast, number: int) -> Promise:
    """Any robot goes where a person calls from, or where one has come to."""
    person = draw.choice(cast.people)
    if not person.mobile:
        return _answered(draw, cast, number, person, person.home, cast.robots)
    place = draw.choice([place for place in cast.floor.places if place != person.home])
    longest = max(cast.floor.time(robot, robot.home, place) for robot in cast.robots)
    within = _deadline(draw, longest)
    return Promise(f"if {person.name} at {place} then any robot at {place} within {within}")


def _answered(draw: Random, cast: Cast, number: int, caller: Agent, place: str, able: Sequence[Agent]) -> Promise:
    lasts = draw.randint(1, 4)
    longest = max(cast.floor.time(robot, robot.home, place) for robot in able) + lasts + _REST
    call, answer = f"call{number}", f"answer{number}"
    return Promise(
        f"if {call} then {answer} within {_deadline(draw, longest)}",
        (f'"{call}"', f'"{answer}" location {place} duration {lasts}'),
        (f"{call} before {answer}",) if draw.random() < 0.5 else (),
        ((caller.name, call), *((robot.name, answer) for robot in able)),
    )


def _deliver(draw: Random, cast: Cast, number: int) -> Promise:
    """A person orders; a robot picks it up in one place and drops it in another."""
    store, room = draw.sample(cast.floor.rooms, 2)
    able = draw.sample(cast.robots, min(len(cast.robots), draw.choice((1, 1, 1, 2))))
    lasts = draw.randint(1, 3), draw.randint(1, 3)
    ways = [cast.floor.time(robot, start, store, room) for robot in able for start in (robot.home, room)]
    order, pick, drop = f"order{number}", f"pick{number}", f"drop{number}"
    within = _deadline(draw, max(ways) + sum(lasts) + 2 * _REST)
    return Promise(
        f"if {order} then {drop} within {within}",
        (
            f'"{order}"',
            f'"{pick}" location {store} duration {lasts[0]}',
            f'"{drop}" location {room} duration {lasts[1]}',
        ),
        (f"{pick} before {drop}",),
        (
            (draw.choice(cast.people).name, order),
            *((robot.name, event) for robot in able for event in (pick, drop)),
        ),
    )


def _patrol(draw: Random, cast: Cast, number: int) -> Promise:
    """Two or three places are visited again and again, by one robot or by whichever."""
    robot = draw.choice(cast.robots)
    stops = draw.sample(cast.floor.places, min(len(cast.floor.places), draw.choice((2, 2, 3))))
    first = cast.floor.time(robot, robot.home, *stops)
    every = _deadline(draw, max(first, cast.floor.time(robot, *stops, stops[0])))
    who = robot.name if draw.random() < 0.5 else "any robot"
    return Promise(f"patrol {', '.join(stops)} every {every} by {who}")


def _keep_apart(draw: Random, cast: Cast, number: int) -> Promise:
    """Two robots are never at one place, or never both in a small room."""
    one, other = draw.sample(cast.robots, 2)
    where = f" at {draw.choice(cast.floor.rooms)}" if draw.random() < 0.4 else ""
    return Promise(f"{one.name} never_with {other.name}{where}")


def _avoid(draw: Random, cast: Cast, number: int) -> Promise:
    """A robot is not where a person walks about, or not in a room while another robot is in a second one."""
    robot, person = draw.choice(cast.robots), draw.choice(cast.walkers)
    if len(cast.robots) > 1 and draw.random() < 0.3:
        other = draw.choice([other for other in cast.robots if other is not robot])
        room, second = draw.sample(cast.floor.rooms, 2)
        if (robot.home, other.home) != (room, second):
            return Promise(f"avoid {robot.name} at {room} and {other.name} at {second}")
    room = draw.choice([place for place in cast.floor.rooms if place != robot.home])
    who = "any robot" if room not in [one.home for one in cast.robots] and draw.random() < 0.5 else robot.name
    return Promise(f"avoid {who} at {room} and {person.name} at {room}")


def _near(draw: Random, cast: Cast, number: int) -> Promise:
    """While a person is in a room, some robot is at a place from which it can help: there in time, if it sets off at
    the start."""
    person = draw.choice(cast.walkers)
    robot = draw.choice(cast.robots)
    places = [place for place in cast.floor.places if place != person.home]
    pairs = [
        (room, near)
        for room in places
        for near in cast.floor.places
        if cast.floor.time(robot, robot.home, near) < cast.floor.time(person, person.home, room)
    ]
    room, near = draw.choice([(a, b) for a, b in pairs if a == b] or pairs)
    who = robot.name if draw.random() < 0.5 else "any robot"
    return Promise(f"always not {person.name} at {room} or {who} at {near}")


_KINDS: Tuple[Callable[[Random, Cast, int], Promise], ...] = (
    _respond,
    _deliver,
    _meet,
    _patrol,
    _keep_apart,
    _avoid,
    _near,
)


def _deadline(draw: Random, longest: int) -> int:
    return math.ceil(max(longest, _REST) * draw.uniform(TIGHT, GENEROUS))


# Text ----------------------------------------------------------------------------------------------------------------


def _text(cast: Cast, promises: Sequence[Promise]) -> str:
    lines = [f'poi "{place}"' for place in cast.floor.places]
    lines += [f"connect {a} and {b} distance {distance}" for a, b, distance in cast.floor.ways]
    lines += [f"event {event}" for promise in promises for event in promise.events]
    rules = [rule for promise in promises for rule in promise.rules]
    lines += [f'rule "rule{number}": {rule}' for number, rule in enumerate(rules, 1)]
    abilities = [ability for promise in promises for ability in promise.abilities]
    lines += [_agent(agent, "controllable ", abilities) for agent in cast.robots]
    lines += [_agent(agent, "", abilities) for agent in cast.people]
    return "\n".join([*lines, *(f"objective: {promise.objective}" for promise in promises), ""])


def _agent(agent: Agent, controllable: str, abilities: Sequence[Tuple[str, str]]) -> str:
    mobile = f"mobile {agent.mobile} " if agent.mobile else ""
    can_do = ", ".join(event for name, event in abilities if name == agent.name)
    return f'agent "{agent.name}" {controllable}{mobile}location {agent.home}' + (f" can_do {can_do}" if can_do else "")


def main(arguments: Optional[Sequence[str]] = None) -> None:
    """Prints the scenario of a seed."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.lab_scenarios", description=lab_scenario.__doc__)
    parser.add_argument("seed", type=int)
    parser.add_argument("--large", action="store_true", help="20 places, 5 robots, 4 people, 8 promises")
    options = parser.parse_args(arguments)
    print(lab_scenario(options.seed, LARGE if options.large else SMALL), end="")


if __name__ == "__main__":
    main()
