"""The text of a scenario from a floor plan: places, ways, what dispensers and ingestors are for, robots, a patrol."""

from __future__ import annotations

import math
from collections import Counter
from itertools import combinations
from typing import AbstractSet, Dict, FrozenSet, Iterator, List, Mapping, Optional, Sequence, Set, Tuple, TypeVar

from pursue_gen.diagnostics import usage_error
from pursue_gen.language.formatter import format_text
from pursue_gen.language.names import proposal
from pursue_gen.language.similar import closest
from pursue_gen.tools.importing.building import Building
from pursue_gen.tools.importing.plan import FloorPlan, Node, RobotStart, Stop, Track, mutex_of

Key = TypeVar("Key")

_TASKS = {"pickup_dispenser": "pick_up_at", "dropoff_ingestor": "drop_off_at"}
"""Properties of vertices at which robots do something, and what it is called."""
_NO_VISITS = ("is_charger", "lift_cabin")
"""Places with these properties are not visited by the patrol that is written."""

_HANDLING = "30 s"
"""How long an action at a dispenser or an ingestor takes, until people write what it is. Not measured."""
_OPENS = "10 s"
"""Within which time a door opens, until people write what it is. Not measured."""
_COMES, _RIDES = "40 s", "10 s to 20 s"
"""Within which time a lift comes, and how long it then takes to another level, until people write it. Not measured."""
_STRAIGHT = 0.1
"""Metres by which a cabin may be elsewhere on another level, and counts as one that goes straight up. Not measured."""
_BEFORE = 2.8
"""Metres from the middle of a cabin to the place before its door, or four fifths of the way where that is less. Not
measured."""


def chosen(plan: FloorPlan, names: Optional[str]) -> Sequence[RobotStart]:
    """The robots of these names, with commas between; all of them for None. Raises PursueError."""
    if names is None:
        return plan.robots
    known = {robot.name: robot for robot in plan.robots}
    wanted = [name.strip() for name in names.split(",") if name.strip()]
    wrong = [name for name in wanted if name not in known]
    if wrong or not wanted:
        meant = closest(wrong[0], tuple(known)) if wrong else None
        hint = f"did you mean {meant}?" if meant else f"there are: {', '.join(known)}"
        raise usage_error(f"the building has no robot {wrong[0]}" if wrong else "--robots names no robot", hint)
    return [known[name] for name in dict.fromkeys(wanted)]


def scenario_text(
    building: Building,
    plan: FloorPlan,
    robots: Sequence[RobotStart],
    speeds: Mapping[str, float],
    file: str,
    traffic: bool = False,
) -> str:
    """The scenario, laid out; `speeds`: robot → metres per second; `file` is its name in messages; `traffic`: places
    and ways hold one robot each."""
    return _Writer(building, plan, robots, speeds, traffic).text(file)


class _Writer:
    """Gives everything its name, and writes the statements."""

    def __init__(
        self,
        building: Building,
        plan: FloorPlan,
        robots: Sequence[RobotStart],
        speeds: Mapping[str, float],
        traffic: bool,
    ) -> None:
        self._building, self._robots, self._speeds, self._traffic = building, robots, speeds, traffic
        self._used = frozenset(graph for robot in robots for graph in robot.graphs)
        self._tracks = [track for track in plan.tracks if track.graphs & self._used]
        ends = {node for track in self._tracks for node in (track.start, track.end)} | {robot.node for robot in robots}
        self._stops = [stop for stop in plan.stops if stop.node in ends]
        lifts = {name: [node for node in some if node in ends] for name, some in plan.lifts.items()}
        self._lifts = {name: some for name, some in lifts.items() if len(some) > 1}
        self._before = {node: self._in_front(node) for some in self._lifts.values() for node in some}
        self._taken: Set[str] = set()
        self._shown = dict(told_apart({stop.node: self._title(stop) for stop in self._stops}))
        self._places: Dict[Node, str] = {node: self._name(title) for node, title in self._shown.items()}
        passed = {door for track in self._tracks for door in track.doors}
        titles = {node: door.name or "door" for node, door in plan.doors.items() if node in passed}
        self._doors = {node: (plan.doors[node], title, self._name(title)) for node, title in told_apart(titles)}
        self._called = {name: self._name(name) for name in self._lifts}
        self._agents = {robot.name: self._name(robot.name) for robot in robots}
        self._groups = self._named_groups()
        self._reached = {robot.name: self._from(robot) for robot in robots}
        self._tasks = self._named_tasks()

    def text(self, file: str) -> str:
        """All of it."""
        parts = [self._head(), ["unit second"], self._poi_lines(), self._door_lines(), self._lift_lines()]
        parts += [self._group_lines(), self._way_lines()]
        parts += [self._ride_lines(), self._event_lines(), self._agent_lines(), self._slow_lines(), self._objectives()]
        return format_text("\n\n".join("\n".join(part) for part in parts if part) + "\n", file)

    def _title(self, stop: Stop) -> str:
        """What people call the place: its name, with the level where several levels have it; else lift or number."""
        level, number = stop.node
        name = stop.vertex.name
        if not name:
            name = stop.lift or f"v{number}"
            several = len(self._building.levels) > 1
        else:
            several = sum(one.vertex.name == name for one in self._stops) > 1
        return f"{name}_{level}" if several else name

    def _name(self, title: str) -> str:
        name = proposal(title, self._taken)
        self._taken.add(name)
        return name

    def _named_groups(self) -> Dict[FrozenSet[str], str]:
        """Those who drive on one graph → the name of their group; nothing where all drive on it, or one robot."""
        found: Dict[FrozenSet[str], str] = {}
        for graph in sorted(self._used):
            some = frozenset(robot.name for robot in self._robots if graph in robot.graphs)
            if 1 < len(some) < len(self._robots) and some not in found:
                found[some] = self._name(f"fleet{graph}")
        return found

    def _from(self, robot: RobotStart) -> Set[Node]:
        """Where the robot can come from where it stands."""
        ways: Dict[Node, List[Node]] = {}
        for track in self._tracks:
            for way in (track, track.turned()):
                ways.setdefault(way.start, []).extend([way.end] if way.there & robot.graphs else [])
        for cabins in self._lifts.values():
            for node in cabins:
                ways.setdefault(node, []).extend(cabins)
        found, waiting = {robot.node}, [robot.node]
        while waiting:
            new = set(ways.get(waiting.pop(), ())) - found
            found |= new
            waiting += new
        return found

    def _named_tasks(self) -> Dict[str, Node]:
        """Event → where it happens."""
        found: Dict[str, Node] = {}
        for stop in self._stops:
            for key, what in _TASKS.items():
                if stop.vertex.properties.get(key):
                    found[self._name(f"{what}_{self._places[stop.node]}")] = stop.node
        return found

    def _head(self) -> List[str]:
        lines = [
            f"// {one_line(self._building.name)}, from Open-RMF's traffic editor. Metres and seconds.",
            "// Say what is wanted below (docs/language.md); durations are first guesses.",
        ]
        used = {stop.node[0] for stop in self._stops}
        levels = [level for level in self._building.levels if level.name in used]
        if len(levels) > 1:  # as the file of levels has them
            known = ", ".join(f"{one_line(level.name)} {level.elevation:g}" for level in levels)
            lines.append(f"// Levels and their elevations, for maps of them (docs/survey.md): {known}.")
        return lines

    def _poi_lines(self) -> List[str]:
        lines = []
        for stop in self._stops:
            name, title = self._places[stop.node], self._shown[stop.node]
            x, y, _ = self._before.get(stop.node, (stop.x, stop.y, 0.0))
            lines.append(f'poi "{name}"{label_text(title, name)} //[{_metres(x, y, stop.z)}, 0, 0, 0, 1]')
        return lines

    def _in_front(self, cabin: Node) -> Tuple[float, float, float]:
        """Where the place before the door of a cabin is, on its first way, and how many metres from its middle."""
        where = {stop.node: (stop.x, stop.y) for stop in self._stops}
        first = next((each for each in self._tracks if cabin in (each.start, each.end)), None)
        x, y = where[cabin]
        if first is None:
            return x, y, 0.0
        far_x, far_y = where[first.end if first.start == cabin else first.start]
        distance = math.dist((x, y), (far_x, far_y)) or 1.0
        share = min(_BEFORE / distance, 0.8)
        return x + share * (far_x - x), y + share * (far_y - y), share * distance

    def _lift_lines(self) -> List[str]:
        """The lifts, and what Open-RMF calls their floors."""
        lines = []
        stops = {stop.node: stop for stop in self._stops}
        for lift, nodes in self._lifts.items():
            name, floors = self._called[lift], [self._places[node] for node in nodes]
            poses = [_metres(stops[node].x, stops[node].y, stops[node].z) for node in nodes]
            middle = [(stops[node].x, stops[node].y) for node in nodes]
            beside = [math.dist(each, middle[0]) > _STRAIGHT for each in middle]
            more = "".join(f" {floors[k]} [{poses[k]}, 0, 0, 0, 1]" for k, is_beside in enumerate(beside) if is_beside)
            called = ", ".join(f"{floor}: {one_line(node[0])}" for floor, node in zip(floors, nodes))
            lines += [
                f"// For door_settings: {name}: {{adapter: rmf, name: {one_line(lift)}, floors: {{{called}}}}}",
                f'lift "{name}"{label_text(lift, name)} at {", ".join(floors)} comes within {_COMES} takes {_RIDES}'
                f" //[{poses[0]}, 0, 0, 0, 1]{more}",
            ]
        return lines

    def _door_lines(self) -> List[str]:
        lines = []
        for door, title, name in self._doors.values():
            turned = math.sin(door.yaw / 2), math.cos(door.yaw / 2)
            turn = ", ".join(f"{round(value, 4) + 0.0:g}" for value in turned)
            pose = _metres(door.x, door.y, door.z)
            lines.append(f'door "{name}"{label_text(title, name)} opens within {_OPENS} //[{pose}, 0, 0, {turn}]')
        return lines

    def _group_lines(self) -> List[str]:
        return [f'group "{group}": {", ".join(self._agents_of(some))}' for some, group in self._groups.items()]

    def _agents_of(self, names: AbstractSet[str]) -> List[str]:
        return [self._agents[robot.name] for robot in self._robots if robot.name in names]

    def _way_lines(self) -> List[str]:
        return [line for track in self._tracks for line in self._ways(track)]

    def _ways(self, track: Track) -> Iterator[str]:
        """A statement for those who drive in both directions, and for those who drive in one."""
        there, back = (
            frozenset(robot.name for robot in self._robots if robot.graphs & graphs)
            for graphs in (track.there, track.back)
        )
        before = sum(self._before.get(node, (0.0, 0.0, 0.0))[2] for node in (track.start, track.end))
        metres = max(math.floor((track.metres - before) * 10 + 0.5), 1) / 10
        doors = f" through {', '.join(self._doors[door][2] for door in track.doors)}" if track.doors else ""
        for some, way, one_way in (
            (there & back, track, ""),
            (there - back, track, " one_way"),
            (back - there, track.turned(), " one_way"),
        ):
            if some:
                ends = f"connect {self._places[way.start]} and {self._places[way.end]} distance {metres:g}"
                yield f"{ends}{one_way}{doors}{self._for(some)}"

    def _for(self, some: FrozenSet[str]) -> str:
        """For whom a way is, where it is not for all."""
        if len(some) == len(self._robots):
            return ""
        return f" for {self._groups.get(some) or ', '.join(self._agents_of(some))}"

    def _ride_lines(self) -> List[str]:
        """The ways by lift: what is driven into the cabin, and out of it."""
        return [
            f"connect {self._places[low]} and {self._places[high]} distance {metres:g} by {self._called[lift]}"
            for lift, nodes in self._lifts.items()
            for low, high in combinations(nodes, 2)
            for metres in [max(round(self._before[low][2] + self._before[high][2], 1), 0.1)]
        ]

    def _slow_lines(self) -> List[str]:
        """How long robots take that may not drive as fast as they can."""
        lines: List[str] = []
        for track in self._tracks:
            for robot in self._robots:
                speed = self._speeds[robot.name]
                for way in (track, track.turned()) if track.is_limited(speed) else ():
                    if way.there & robot.graphs:
                        start, end = self._places[way.start], self._places[way.end]
                        seconds = max(round(way.seconds(speed), 1), 0.1)
                        lines.append(f"travel {self._agents[robot.name]} from {start} to {end} takes {seconds:g} s")
        return lines

    def _mutex_lines(self) -> List[str]:
        """What one robot may have of the places and ways of a group, alone."""
        members: Dict[str, List[Tuple[str, str]]] = {}  # how each is written alone, and in a condition
        for stop in self._stops:
            place = self._places[stop.node]
            members.setdefault(mutex_of(stop.vertex.properties), []).append((f"place {place}", f"at {place}"))
        for track in self._tracks:
            a, b = self._places[track.start], self._places[track.end]
            members.setdefault(track.mutex, []).append((f"way {a} to {b}", f"between {a} and {b}"))
        members.pop("", None)
        lines: List[str] = []
        for group, some in members.items() if len(self._robots) > 1 else ():
            alone = [f"objective: {each} holds 1 robot // mutex {one_line(group)}" for each, _ in some]
            lines += alone if not self._traffic else []
            pairs = ((one, other) for (_, one), (_, other) in combinations(some, 2))
            lines += [f"objective: avoid any robot {one} and any robot {other}" for one, other in pairs]
        return lines

    def _event_lines(self) -> List[str]:
        tasks = self._tasks.items()
        return [f'event "{name}" location {self._places[node]} duration {_HANDLING}' for name, node in tasks]

    def _agent_lines(self) -> List[str]:
        lines = []
        for robot in self._robots:
            able = [name for name, node in self._tasks.items() if node in self._reached[robot.name]]
            doing = f" can_do {', '.join(able)}" if able else ""
            name, place, speed = self._agents[robot.name], self._places[robot.node], self._speeds[robot.name]
            label = label_text(robot.name, name)
            line = f'agent "{name}"{label} controllable speed {speed:g} location {place}{doing}'
            lines.append(f"{line} // {one_line(robot.type)}" if robot.type else line)
        return lines

    def _objectives(self) -> List[str]:
        """What makes the scenario one that can be solved: each place that people have named is visited."""
        alone = self._traffic and len(self._robots) > 1
        lines = [f"objective: every {room} holds 1 robot" for room in ("place", "way") if alone]
        lines += self._mutex_lines()
        patrols: Dict[FrozenSet[str], List[str]] = {}
        for stop in self._stops:
            able = frozenset(name for name, reached in self._reached.items() if stop.node in reached)
            if stop.vertex.name and able and not any(map(stop.vertex.properties.get, _NO_VISITS)):
                patrols.setdefault(able, []).append(self._places[stop.node])
        if not patrols:  # what is asked of a place has to stand somewhere
            patrols = {frozenset({robot.name}): [self._places[robot.node]] for robot in self._robots[:1]}
        return lines + [f"objective: patrol {', '.join(some)} by {self._by(who)}" for who, some in patrols.items()]

    def _by(self, some: FrozenSet[str]) -> str:
        """Any of these robots."""
        if len(some) == len(self._robots):
            return "any robot"
        group = self._groups.get(some)
        return f"any of {group}" if group else " or ".join(self._agents_of(some))


def told_apart(titles: Mapping[Key, str]) -> Iterator[Tuple[Key, str]]:
    """The titles, with a number behind what another place is called, too."""
    seen: Counter[str] = Counter()
    for node, title in titles.items():
        seen[title] += 1
        yield node, title if seen[title] == 1 else f"{title} {seen[title]}"


def label_text(title: str, name: str) -> str:
    """The label of what people call by a title that is not its name."""
    return f' label "{one_line(title)}"' if title != name else ""


def _metres(*values: float) -> str:
    """Coordinates as poses have them."""
    return ", ".join(f"{round(value, 2) + 0.0:.2f}" for value in values)  # no -0.00


def one_line(text: str) -> str:
    """The text as a label and a comment can hold it: what a building calls something never becomes a statement."""
    return "".join(letter for letter in text if letter.isprintable() and letter not in '"\\')
