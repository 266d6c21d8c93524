"""Families of ordinary work: calls, passing each other, a warehouse, patrols, a home, a factory, a museum.

Each member is a story as a user would write it. They grow in how many there are of something; most of their promises
hardly touch each other.
"""

from __future__ import annotations

from itertools import combinations
from typing import Iterable, List, Sequence, Tuple

from benchmarks.families import Family, Way, robot, statements

_TURN = 15
"""Time units in which a robot goes from one room of the ward to another and answers there."""


def call_one_robot(callers: int) -> str:
    """Rooms around a hall, with a patient in each who may ring at any time; a robot answers each within what a round of
    all of them takes."""
    return _ward(callers, 1, (callers + 1) * _TURN)


def call_five_robots(callers: int) -> str:
    """The same ward with five robots, each of which can answer everybody."""
    return _ward(callers, 5, (-(-callers // 5) + 2) * _TURN)


def _ward(callers: int, robots: int, within: int) -> str:
    numbers = range(1, callers + 1)
    answers = [f"answer{n}" for n in numbers]
    return statements(
        ("hall", *(f"room{n}" for n in numbers)),
        [("hall", f"room{n}", 3) for n in numbers],
        {**{f"ring{n}": "" for n in numbers}, **{f"answer{n}": f"location room{n} duration 2" for n in numbers}},
        [f"ring{n} before answer{n}" for n in numbers],
        [
            *(robot(f"bot{n}", "hall", answers) for n in range(1, robots + 1)),
            *(f'agent "patient{n}" location room{n} can_do ring{n}' for n in numbers),
        ],
        _promises(f"if ring{n} then answer{n} within {within}" for n in numbers),
    )


def pass_in_a_corridor(robots: int) -> str:
    """Robots in the rooms of a corridor have work at its other end, the first one in the last room and so on; no two
    are ever at one place, or meet on a way. One room more than robots is free."""
    rooms = range(1, robots + 2)
    ways: List[Way] = [(f"hall{n}", f"hall{n + 1}", 3) for n in rooms[:-1]]
    return _changing_places(
        [*(f"hall{n}" for n in rooms), *(f"room{n}" for n in rooms)],
        [*ways, *((f"hall{n}", f"room{n}", 2) for n in rooms)],
        [(f"room{n}", f"room{robots + 1 - n}") for n in range(1, robots + 1)],
    )


def pass_in_a_square(robots: int) -> str:
    """Robots on the floor of a hall, four places wide and four deep, have work in the opposite place; no two are ever
    at one place, or meet on a way."""
    places = [f"x{column}y{row}" for row in range(4) for column in range(4)]
    ways: List[Way] = [(f"x{c}y{r}", f"x{c + 1}y{r}", 5) for r in range(4) for c in range(3)]
    ways += [(f"x{c}y{r}", f"x{c}y{r + 1}", 5) for r in range(3) for c in range(4)]
    return _changing_places(places, ways, [(places[n], places[15 - n]) for n in _around(robots)])


def _around(robots: int) -> Sequence[int]:
    """Every second place of the edge first, so that opposite robots are there in pairs."""
    return (0, 15, 3, 12, 2, 13, 4, 11, 1, 14, 7, 8)[:robots]


def _changing_places(places: Sequence[str], ways: Sequence[Way], trips: Sequence[Tuple[str, str]]) -> str:
    numbers = range(1, len(trips) + 1)
    works = [f"work{n}" for n in numbers]
    apart = _promises(f"bot{one} never_with bot{other}" for one, other in combinations(numbers, 2))
    return statements(
        places,
        ways,
        {work: f"location {trips[n][1]} duration 4" for n, work in enumerate(works)},
        (),
        [robot(f"bot{n}", trips[n - 1][0], [f"work{n}"]) for n in numbers],
        "\n".join([apart, *(f"reach_objective: do {work}" for work in works)]),
    )


def warehouse(robots: int) -> str:
    """Three customers order, at times that nobody knows; what they order is fetched from its rack, behind an aisle that
    holds one robot, and handed out at the gate within 120."""
    goods = ("bolts", "boards", "paint")
    numbers = range(1, robots + 1)
    deeds = [deed for good in goods for deed in (f"fetch_{good}", f"hand_out_{good}")]
    return statements(
        ("gate", "yard", "aisle", "back", *(f"rack_{good}" for good in goods), *(f"bay{n}" for n in numbers)),
        [
            ("gate", "yard", 3),
            ("yard", "aisle", 4),
            ("aisle", "back", 4),
            *(("back", f"rack_{good}", 2 + n) for n, good in enumerate(goods)),
            *(("yard", f"bay{n}", 2) for n in numbers),
        ],
        {
            **{f"order_{good}": "" for good in goods},
            **{f"fetch_{good}": f"location rack_{good} duration 3" for good in goods},
            **{f"hand_out_{good}": "location gate duration 2" for good in goods},
        },
        [f"fetch_{good} before hand_out_{good}" for good in goods],
        [
            *(robot(f"bot{n}", f"bay{n}", deeds) for n in numbers),
            *(f'agent "customer_of_{good}" location gate can_do order_{good}' for good in goods),
        ],
        _promises(
            [
                *(f"if order_{good} then hand_out_{good} within 120" for good in goods),
                *(f"bot{one} never_with bot{other} at aisle" for one, other in combinations(numbers, 2)),
            ]
        ),
    )


def patrol_with_a_period(places: int) -> str:
    """Guards look into all rooms of a corridor, each again within the period: two guards up to 12 places, three up to
    40, then four. Each starts where its part of the corridor begins."""
    guards = _guards(places)
    part = -(-places // (2 * guards))
    # To the end of the part and back, with each room on the way, and half as much again.
    return _building(places, f" every {part * (2 * (3 + 2) + 2 * (2 + 2)) * 3 // 2}")


def patrol_without_a_period(places: int) -> str:
    """The same, with the least period to be found."""
    return _building(places, "")


def _guards(places: int) -> int:
    return 2 if places <= 12 else 3 if places <= 40 else 4


def _building(places: int, every: str) -> str:
    rooms = range(1, places // 2 + 1)
    guards = _guards(places)
    part = -(-len(rooms) // guards)
    return statements(
        [*(f"hall{n}" for n in rooms), *(f"room{n}" for n in rooms)],
        [*((f"hall{n}", f"hall{n + 1}", 3) for n in rooms[:-1]), *((f"hall{n}", f"room{n}", 2) for n in rooms)],
        {},
        (),
        [f'agent "guard{n + 1}" controllable mobile 1 location hall{n * part + 1}' for n in range(guards)],
        f"objective: patrol {', '.join(f'room{n}' for n in rooms)}{every} by any robot",
    )


def care_home(robots: int) -> str:
    """A home of six rooms: a robot looks into each again and again, and comes when one of two residents rings. The
    robots run on batteries, and charge at their dock."""
    numbers = range(1, robots + 1)
    rooms = [f"room{n}" for n in range(1, 7)]
    batteries = [f'battery "bot{n}" capacity 150 uses 1 per unit recharges 5 per unit at dock{n}' for n in numbers]
    return statements(
        ("hall", *(f"dock{n}" for n in numbers), *rooms),
        [*(("hall", f"dock{n}", 4) for n in numbers), *(("hall", room, 4) for room in rooms)],
        {
            "ring1": "",
            "ring6": "",
            "visit1": "location room1 duration 4",
            "visit6": "location room6 duration 4",
            **{f"charge{n}": f"location dock{n} duration 10" for n in numbers},
        },
        (),
        [
            *(robot(f"bot{n}", f"dock{n}", ["visit1", "visit6", f"charge{n}"]) for n in numbers),
            'agent "resident1" location room1 can_do ring1',
            'agent "resident6" location room6 can_do ring6',
            *batteries,
        ],
        _promises(
            [
                f"patrol {', '.join(rooms)} every 300 by any robot",
                "if ring1 then visit1 within 120",
                "if ring6 then visit6 within 120",
            ]
        ),
    )


def factory(machines: int) -> str:
    """A cart that holds two boxes of parts brings them from the store to machines, each of which runs out of parts at
    times that nobody knows and has to get more in time."""
    numbers = range(1, machines + 1)
    slots = ("left", "right")
    fills = {slot: [f"fill{n}_{slot}" for n in numbers] for slot in slots}
    states = [f'state "empty{n}": initially false, true_if run_out{n} false_if fill{n}_left, fill{n}_right'
              for n in numbers]  # fmt: skip
    return statements(
        ("store", "lane", *(f"machine{n}" for n in numbers)),
        [("store", "lane", 5), *(("lane", f"machine{n}", 2 + n) for n in numbers)],
        {
            **{f"run_out{n}": f"only_if empty{n} is_false" for n in numbers},
            **{f"load_{slot}": "location store duration 3" for slot in slots},
            **{f"fill{n}_{slot}": f"location machine{n} duration 2" for slot in slots for n in numbers},
        },
        [f"load_{slot} before {_either(fills[slot])}" for slot in slots],
        [
            *states,
            robot("cart", "store", [*(f"load_{slot}" for slot in slots), *fills["left"], *fills["right"]]),
            *(f'agent "press{n}" location machine{n} can_do run_out{n}' for n in numbers),
        ],
        _promises(f"if empty{n} is_true then empty{n} is_false within {50 * (machines + 1)}" for n in numbers),
    )


def escort(labs: int) -> str:
    """A visitor walks about in a corridor of labs; an escort is with the visitor soon after each arrival, in each lab a
    robot shows what is done there, and nobody enters the clean room while the visitor is in it."""
    numbers = range(1, labs + 1)
    return statements(
        (*(f"lab{n}" for n in numbers), "clean_room"),
        [*((f"lab{n}", f"lab{n + 1}", 6) for n in numbers[:-1]), (f"lab{labs}", "clean_room", 4)],
        {f"show{n}": f"location lab{n} duration 3" for n in numbers},
        (),
        [
            'agent "escort" controllable mobile 1 location lab1',
            *(f'agent "demonstrator{n}" controllable location lab{n} can_do show{n}' for n in numbers),
            'agent "visitor" mobile 3 location lab1',
        ],
        _promises(
            [
                *(f"if visitor at lab{n} then escort at lab{n} within 20" for n in numbers),
                *(f"if visitor at lab{n} then show{n} within 15" for n in numbers),
                "avoid any robot at clean_room and visitor at clean_room",
            ]
        ),
    )


def buildings_apart(buildings: int) -> str:
    """Buildings with a robot, a caller and five places each; nothing that happens in one matters in another."""
    numbers = range(1, buildings + 1)
    names = ("dock", "hall", "office", "store", "desk")
    ways: List[Way] = []
    for n in numbers:
        ways += [(f"dock{n}", f"hall{n}", 3), (f"hall{n}", f"office{n}", 4)]
        ways += [(f"hall{n}", f"store{n}", 5), (f"hall{n}", f"desk{n}", 2)]
    return statements(
        [f"{name}{n}" for n in numbers for name in names],
        ways,
        {
            **{f"call{n}": "" for n in numbers},
            **{f"fetch{n}": f"location store{n} duration 3" for n in numbers},
            **{f"bring{n}": f"location office{n} duration 2" for n in numbers},
        },
        [f"fetch{n} before bring{n}" for n in numbers],
        [
            *(robot(f"bot{n}", f"dock{n}", [f"fetch{n}", f"bring{n}"]) for n in numbers),
            *(f'agent "clerk{n}" location office{n} can_do call{n}' for n in numbers),
        ],
        _promises(f"if call{n} then bring{n} within {70 + 5 * n}" for n in numbers),
    )


def errands_beside_a_visitor(places: int) -> str:
    """A visitor walks about in a house; one robot takes a parcel from the door to the last room, another waters the
    plants in the first two, and neither is in the narrow hall's end while the visitor is."""
    rooms = [f"room{n}" for n in range(1, places - 2)]
    return statements(
        ("door", "hall", "end", *rooms),
        [("door", "hall", 4), ("hall", "end", 3), *((("hall", "end")[n % 2], room, 3) for n, room in enumerate(rooms))],
        {
            "take": "location door duration 2",
            "leave": f"location {rooms[-1]} duration 2",
            **{f"water_{room}": f"location {room} duration 3" for room in rooms[:2]},
        },
        ["take before leave"],
        [
            robot("porter", "door", ["take", "leave"]),
            robot("gardener", "hall", [f"water_{room}" for room in rooms[:2]]),
            f'agent "visitor" mobile 3 location {rooms[0]}',
        ],
        "objective: avoid any robot at end and visitor at end\n"
        f"reach_objective: do leave and {' and '.join(f'water_{room}' for room in rooms[:2])}",
    )


def mop_beside_calls(rooms: int) -> str:
    """One robot mops rooms around a hall, one after the other; two others answer who rings at the gate and who calls
    from the first room, and one of all sees to the store."""
    numbers = range(1, rooms + 1)
    mops = [f"mop{n}" for n in numbers]
    return statements(
        ("gate", "hall", "store", *(f"room{n}" for n in numbers)),
        [("gate", "hall", 6), ("hall", "store", 4), *(("hall", f"room{n}", 4 + n) for n in numbers)],
        {
            **{"ring": "location gate", "open": "location gate duration 5"},
            **{"call": "location room1", "help": "location room1 duration 10"},
            **{mop: f"location room{n} duration 150" for n, mop in zip(numbers, mops)},
        },
        [],
        [
            robot("mopper", "store", mops),
            *(robot(name, "hall", ["open", "help"]) for name in ("porter", "nurse")),
            'agent "visitor" location gate can_do ring',
            'agent "patient" location room1 can_do call',
        ],
        "assume: visitor waits 60 between ring\nassume: patient waits 90 between call\n"
        + _promises(("if ring then open within 30", "if call then help within 40"))
        + "\nobjective: patrol store every 600 by any robot"
        + "".join(f"\nreach_objective: do {mop}" for mop in mops),
    )


ORDINARY: Tuple[Family, ...] = tuple(
    Family(name, grows, " ".join((text.__doc__ or "").split()), text, sizes, sizes[:1])
    for name, grows, text, sizes in (
        ("callers", "callers", call_one_robot, (3, 4, 6, 8)),
        ("callers, five robots", "callers", call_five_robots, (30,)),
        ("corridor", "robots", pass_in_a_corridor, (4, 8, 20, 30)),
        ("square", "robots", pass_in_a_square, (8,)),
        ("warehouse", "robots", warehouse, (4,)),
        ("patrol, period given", "POIs", patrol_with_a_period, (12, 40, 140)),
        ("patrol, period to be found", "POIs", patrol_without_a_period, (12, 40, 140)),
        ("errands beside a visitor", "POIs", errands_beside_a_visitor, (6, 9)),
        ("care home", "robots", care_home, (1, 2)),
        ("factory", "machines", factory, (3,)),
        ("escort", "labs", escort, (3,)),
        ("buildings apart", "buildings", buildings_apart, (1, 2, 4)),
        ("rooms to mop beside calls", "rooms", mop_beside_calls, (2, 4, 6)),
    )
)


def _promises(promises: Iterable[str]) -> str:
    """Objectives of these promises, a line each."""
    return "\n".join(f"objective: {promise}" for promise in promises)


def _either(events: Sequence[str]) -> str:
    """`(a or (b or c))`; of one event that event."""
    return events[0] if len(events) == 1 else f"({events[0]} or {_either(events[1:])})"
