"""Families of scenarios that grow in one respect, to see what that respect costs.

Each member is a task that somebody could want done: parcels delivered, a thief caught, an office cleaned on call. A
family keeps everything but its parameter as it is; what the members have in common is said in `Family.task`.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Callable, Iterable, Mapping, Sequence, Tuple

Way = Tuple[str, str, int]


@dataclass(frozen=True)
class Family:
    """Scenarios of one kind: `text(size)` is the PuRSUE-ML of a member.

    `grows`: what the size counts ("robots", "POIs", "distance", "actions" or "uncontrollable agents"); `task`: what the
    robots are for, in a sentence; `sizes`: what is measured, `quick`: those of a short run.
    """

    name: str
    grows: str
    task: str
    text: Callable[[int], str]
    sizes: Tuple[int, ...]
    quick: Tuple[int, ...]


def deliver_by_robots(robots: int) -> str:
    """Each robot brings a parcel from the depot to one of three rooms; the first one reports when all are there."""
    rooms = ("room1", "room2", "room3")
    numbers = range(1, robots + 1)
    return statements(
        ("depot", "hub", *rooms),
        [("depot", "hub", 4), *(("hub", room, 3 + 2 * place) for place, room in enumerate(rooms))],
        {
            **{f"load{i}": "location depot duration 2" for i in numbers},
            **{f"unload{i}": f"location {rooms[(i - 1) % 3]} duration 2" for i in numbers},
            "report": "",
        },
        [f"(load{i} before unload{i}) before report" for i in numbers],
        [robot(f"bot{i}", "depot", [f"load{i}", f"unload{i}"] + ["report"] * (i == 1)) for i in numbers],
        "reach_objective: do report after 0",
    )


def catch_by_robots(robots: int) -> str:
    """Officers catch a thief who needs twice their time for every way, in a ring of four rooms."""
    return _chase(_ring(4, [10] * 4), 4, robots)


def clean_by_robots(robots: int) -> str:
    """A clerk calls; within 46 a robot has wiped the office and says so. A robot that has wiped rinses its mop before
    it wipes again."""
    numbers = range(1, robots + 1)
    return statements(
        ("office", "base", "hallway", "washroom"),
        [("office", "hallway", 5), ("base", "hallway", 2), ("washroom", "hallway", 7)],
        {
            **{f"wipe{i}": "location office duration 5" for i in numbers},
            **{f"rinse{i}": "location washroom duration 3" for i in numbers},
            "call": "",
            "pause": "duration 37",
            "clean": "location office",
        },
        [
            "call before pause",
            f"(call before {_bracketed('or', [f'wipe{i}' for i in numbers])}) before clean",
            *(f"wipe{i} before rinse{i}" for i in numbers),
        ],
        [
            *(robot(f"bot{i}", "base", [f"wipe{i}", f"rinse{i}", "clean"]) for i in numbers),
            'agent "clerk" location office can_do call, pause',
        ],
        "objective: if call then clean within 46",
    )


def deliver_by_places(places: int) -> str:
    """A hotel: rooms along a corridor. One robot brings luggage to the last room, another breakfast to the one in the
    middle."""
    corridors = places // 2
    half = (corridors + 1) // 2
    return statements(
        (*(f"corridor{i}" for i in range(1, corridors + 1)), *(f"room{i}" for i in range(1, places - corridors + 1))),
        [
            *((f"corridor{i}", f"corridor{i + 1}", 3) for i in range(1, corridors)),
            *((f"corridor{min(i, corridors)}", f"room{i}", 2) for i in range(1, places - corridors + 1)),
        ],
        {
            "luggage": f"location room{places - corridors} duration 2",
            "breakfast": f"location room{half} duration 2",
            "report": "",
        },
        ["luggage before report", "breakfast before report"],
        [robot("porter", "corridor1", ["luggage", "report"]), robot("waiter", "corridor1", ["breakfast"])],
        "reach_objective: do report after 0",
    )


def catch_by_places(places: int) -> str:
    """An officer catches a thief who needs twice the officer's time for every way, in a ring of rooms."""
    return _chase(_ring(places, [10] * places), places, 1)


def catch_by_distance(distance: int) -> str:
    """An officer catches a thief of half the speed in a ring of four rooms; all ways have this length."""
    return _chase(_ring(4, [distance] * 4), 4, 1)


def catch_by_one_distance(distance: int) -> str:
    """An officer catches a thief of half the speed in a ring of four rooms; one way has this length, the others 10."""
    return _chase(_ring(4, [distance, 10, 10, 10]), 4, 1)


def deliver_by_distance(distance: int) -> str:
    """Two robots work together: one fetches from the store what the other builds in at the site, and they meet in the
    yard. The way from the yard to the store has this length, the one to the site 3."""
    return statements(
        ("yard", "store", "site"),
        [("yard", "store", distance), ("yard", "site", 3)],
        {
            "fetch": "location store duration 2",
            "hand": "collaborative location yard",
            "build": "location site duration 5",
        },
        ["fetch before hand", "hand before build"],
        [robot("carrier", "yard", ["fetch", "hand"]), robot("builder", "site", ["build"], reacts=["hand"])],
        "reach_objective: do build after 0",
    )


def inspect_in_order(actions: int) -> str:
    """Two robots make an inspection round: so many checks in four rooms around a hall, in a fixed order."""
    checks = [f"check{i}" for i in range(1, actions + 1)]
    return _inspection(checks, [_chain("before", [*checks, "report"])])


def inspect_in_any_order(actions: int) -> str:
    """The same checks, in any order."""
    checks = [f"check{i}" for i in range(1, actions + 1)]
    return _inspection(checks, [f"{check} before report" for check in checks])


def hand_to_visitors(visitors: int) -> str:
    """A robot hands a leaflet to each of the visitors, who walk about in three rooms at half its speed."""
    numbers = range(1, visitors + 1)
    rooms = ("room1", "room2", "room3")
    return statements(
        rooms,
        [("room1", "room2", 5), ("room2", "room3", 5), ("room3", "room1", 5)],
        {**{f"hand{i}": "collaborative" for i in numbers}, "report": ""},
        [f"hand{i} before report" for i in numbers],
        [
            robot("bot", "room1", [*(f"hand{i}" for i in numbers), "report"]),
            *(f'agent "visitor{i}" mobile 2 location {rooms[i % 3]} reacts_to hand{i}' for i in numbers),
        ],
        "reach_objective: do report after 0",
    )


def pass_bystanders(bystanders: int) -> str:
    """The two robots of the delivery, among people who walk about in the rooms and have no part in the task."""
    people = [f'agent "person{i}" mobile 3 location hub' for i in range(1, bystanders + 1)]
    return deliver_by_robots(2).replace("reach_objective", "\n".join([*people, "reach_objective"]))


FAMILIES: Tuple[Family, ...] = tuple(
    Family(name, grows, " ".join((text.__doc__ or "").split()), text, sizes, quick)
    for name, grows, text, sizes, quick in (
        ("delivery", "robots", deliver_by_robots, (1, 2, 3, 4, 6, 10, 20), (1, 2)),
        ("chase", "robots", catch_by_robots, (1, 2, 3, 4, 6, 10, 20), (1, 2)),
        ("cleaning", "robots", clean_by_robots, (1, 2, 3, 4, 6, 10, 20), (1,)),
        ("hotel", "POIs", deliver_by_places, (4, 8, 16, 32, 64, 100, 150), (4, 8)),
        ("ring", "POIs", catch_by_places, (4, 8, 16, 32, 64, 100, 150), (4, 8)),
        ("all ways", "distance", catch_by_distance, (1, 2, 5, 10, 20, 50, 100), (1, 10)),
        ("one way", "distance", catch_by_one_distance, (1, 2, 5, 10, 20, 50, 100), (1, 20)),
        ("building site", "distance", deliver_by_distance, (1, 2, 5, 10, 20, 50, 100), (1, 100)),
        ("round in order", "actions", inspect_in_order, (1, 2, 4, 8, 12, 20, 30), (1, 2)),
        ("round in any order", "actions", inspect_in_any_order, (1, 2, 4, 8, 12, 20, 30), (1, 2)),
        ("visitors", "uncontrollable agents", hand_to_visitors, (1, 2, 3, 4, 5, 6), (1, 2)),
        ("bystanders", "uncontrollable agents", pass_bystanders, (0, 1, 2, 5, 10, 20, 50), (0, 1)),
    )
)


def statements(
    places: Iterable[str],
    ways: Iterable[Way],
    events: Mapping[str, str],
    rules: Sequence[str],
    agents: Iterable[str],
    objective: str,
) -> str:
    """The statements in the order of the language."""
    lines = [f'poi "{place}"' for place in places]
    lines += [f"connect {one} and {other} distance {distance}" for one, other, distance in ways]
    lines += [f'event "{event}" {what}'.rstrip() for event, what in events.items()]
    lines += [f'rule "rule{number}": {rule}' for number, rule in enumerate(rules, 1)]
    return "\n".join([*lines, *agents, objective, ""])


def robot(name: str, place: str, can_do: Sequence[str], reacts: Sequence[str] = ()) -> str:
    """A robot that needs one unit of time per unit of distance."""
    reaction = f" reacts_to {', '.join(reacts)}" if reacts else ""
    return f'agent "{name}" controllable mobile 1 location {place} can_do {", ".join(can_do)}{reaction}'


def _chain(word: str, parts: Sequence[str]) -> str:
    """`a before (b before c)`; of one part that part."""
    return parts[0] if len(parts) == 1 else f"{parts[0]} {word} {_bracketed(word, parts[1:])}"


def _bracketed(word: str, parts: Sequence[str]) -> str:
    """The same in brackets, where it has more than one part."""
    return _chain(word, parts) if len(parts) == 1 else f"({_chain(word, parts)})"


def _ring(places: int, distances: Sequence[int]) -> Tuple[Way, ...]:
    return tuple((f"p{i + 1}", f"p{(i + 1) % places + 1}", distance) for i, distance in enumerate(distances))


def _chase(ways: Sequence[Way], places: int, officers: int) -> str:
    """Officers start in the first place, the thief in the one opposite."""
    return statements(
        (f"p{i}" for i in range(1, places + 1)),
        ways,
        {"catch": "collaborative"},
        (),
        [
            *(robot(f"officer{i}", "p1", ["catch"]) for i in range(1, officers + 1)),
            f'agent "thief" mobile 2 location p{places // 2 + 1} reacts_to catch',
        ],
        "reach_objective: do catch after 0",
    )


def _inspection(checks: Sequence[str], rules: Sequence[str]) -> str:
    rooms = ("room1", "room2", "room3", "room4")
    return statements(
        ("hall", *rooms),
        [("hall", room, 2 + place) for place, room in enumerate(rooms)],
        {
            **{check: f"location {rooms[number % 4]} duration 2" for number, check in enumerate(checks)},
            "report": "location hall",
        },
        rules,
        [robot("bot1", "hall", [*checks, "report"]), robot("bot2", "hall", [*checks, "report"])],
        "reach_objective: do report after 0",
    )
