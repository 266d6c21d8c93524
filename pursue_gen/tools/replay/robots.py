"""The orders to robots, against what they do according to the states; and what the robots' side has acknowledged of
what they were ordered to do at once, as it counts for the goal."""

from __future__ import annotations

import bisect
import math
from typing import AbstractSet, Dict, Iterable, List, Mapping, Optional, Sequence, Set, Tuple

from pursue_gen.drawing.layout import poses
from pursue_gen.language.network_names import going
from pursue_gen.language.scenario import Scenario
from pursue_gen.language.symbols import UNDER_WAY, Role, role_of
from pursue_gen.tools.replay.finding import FAULT, NOTE, UNRECORDED, WORLD, Finding
from pursue_gen.tools.replay.game import Game
from pursue_gen.tools.replay.orders import Orders
from pursue_gen.tools.replay.record import MissionRecord, RobotOrder
from pursue_gen.workspace.map_spots import SPARE_REACH
from pursue_runtime.event_words import ORDERED
from pursue_runtime.locations import breaks_off
from pursue_runtime.orders import parse_orders
from pursue_runtime.state import ENDED, WON, SystemState

LATE = 2.0
"""Seconds by which an order may be received after its activity is over: messages take time, and robots may be quick."""
EARLY = 0.25
"""Seconds by which the recorder's clock may be behind the observer's: another machine, a step of simulated time."""
CUT = 0.5
"""Seconds before the end of the recording of a mission that had not ended in which an order may be missing."""
NEAR = 0.011  # metres: computed poses are rounded to centimetres

Point = Tuple[float, float, float]

Done = Tuple[SystemState, SystemState, str, bool]
"""The state before a step and after it, its mover, and whether it was a command."""

Activity = Tuple[SystemState, float, str, str]
"""The state in which it begins, its end as nodes may know of it (seconds), the robot, where it goes ("" for an
action)."""


def check_robots(
    record: MissionRecord, game: Game, steps: Sequence[Done], orders: Mapping[int, Orders], lateness: float = 0.0
) -> List[Finding]:
    """Orders without a state that begins them, orders that were never sent, goals that lead elsewhere.

    An order is on its way for the reaction, and `lateness` (time units) more. A goal of a node that is no controller is
    of the world: a person has sent the robot elsewhere (rviz), and it is taken back.
    """
    robots = [agent.name for agent in game.scenario.agents if agent.is_robot]
    activities = _activities(steps, robots, record)
    with_goals = {order.robot for order in record.orders if order.goal is not None}
    where = {robot: _places(game.scenario, robot) for robot in robots if robot in with_goals}
    ways: Dict[str, str] = {going(x.name, y.name): y.name for x in game.scenario.pois for y in game.scenario.pois}
    diary = _ActivityIndex(activities)
    uncommanded = _uncommanded(game.scenario, steps, record)
    found: List[Finding] = []
    ordered: Set[int] = set()
    controllers = {node for plan in orders.values() for nodes in plan.owners.values() for node in nodes}
    places: Dict[str, Dict[str, Point]] = {robot: {} for robot in robots}
    for order in record.orders:
        if order.is_goal and order.node and controllers and order.node not in controllers:
            text = f"{order.node} sent {order.robot} elsewhere"
            found.append(Finding(WORLD, "sent", _number_at(record, order.at), text))
            continue
        place = diary.activity(order)
        if place is None and (_returns(record, order) if order.is_goal else _joins(record, game.scenario, order)):
            continue
        if place is None:
            what = "a goal" if order.is_goal else f"the action {order.action}"
            seq = _number_at(record, order.at)
            text = f"{order.node or 'an unknown node'} gave {order.robot} {what} that follows from no state"
            found.append(Finding(FAULT, "order", seq, text))
            continue
        again = place in ordered
        ordered.add(place)
        state, _, robot, location = activities[place]
        wrong = _wrong(order, activities[place], again) if record.is_exact else ""
        if wrong:
            found.append(Finding(FAULT, "order", state.seq, f"{robot} is ordered {order.action or location} {wrong}"))
        if state.seq in uncommanded:
            text = f"{robot} was ordered to begin {state.event}, which the strategy did not command"
            found.append(Finding(FAULT, "order", state.seq, text))
        owners = orders[state.plan].owners.get(robot) if state.plan in orders else None
        if owners and order.node and order.node not in owners:
            text = f"{order.node} commands {robot}, which is for {' or '.join(sorted(owners))}"
            found.append(Finding(FAULT, "owner", state.seq, text))
        if order.goal is not None and location in ways:
            problem = _elsewhere(order.goal, ways[location], again, places[robot], where[robot])
            found += [Finding(FAULT, "goal", state.seq, f"{robot} is sent {problem}")] if problem else []
    if not record.problems:
        commanded = {state.seq for _, state, _, is_command in steps if is_command}
        receipts = receipts_in(record, controllers)
        for place, (state, _, robot, _) in enumerate(activities):
            way = lateness + (orders[state.plan].reaction if state.plan in orders else 0.0)
            if place not in ordered and state.seq in commanded and not _is_on_its_way(record, state, way):
                found.append(_untold(record, activities[place], (robot, state.seq) in receipts))
        found += without_receipt(record, _at_once(activities, commanded), receipts)
    return found


def _is_on_its_way(record: MissionRecord, state: SystemState, way: float) -> bool:
    """True if the order that follows from a state may come after the end of the record, so many time units later."""
    last = record.exact_until or max([record.states[-1].stamp, *(order.at for order in record.orders)])
    if record.is_exact:
        return state.stamp + way * state.unit >= last
    return record.states[-1].status not in ENDED and state.stamp + CUT >= last


def _wrong(order: RobotOrder, activity: Activity, again: bool) -> str:
    """What is wrong with an order of which everything is known; "" where nothing is."""
    state, end, robot, location = activity
    if order.location != state.locations[robot] or order.action not in ("", state.event):
        return f"({order.location}), and began {state.event} ({state.locations[robot]})"
    if order.again:
        return ""
    if end > state.stamp and order.at > end:
        return "after that was over"
    return "for the second time" if again and not location else ""


def _untold(record: MissionRecord, activity: Activity, has_receipt: bool) -> Finding:
    """What is to say of an activity without a recorded order: nobody was ordered, unless the robot's side has
    acknowledged it."""
    state, _, robot, location = activity
    if has_receipt:
        text = f"the order to begin {state.event} was not recorded, but {robot}'s side has acknowledged it"
        return Finding(NOTE, "acknowledged", state.seq, text)
    text = f"{robot} got no order to begin {state.event} ({location or 'an action'})"
    return Finding(UNRECORDED if state.stamp <= record.whole_from else FAULT, "untold", state.seq, text)


def _at_once(activities: Sequence[Activity], commanded: AbstractSet[int]) -> List[Tuple[str, SystemState]]:
    """Return the robots that were commanded to do something at once, and the states that follow from it."""
    return [
        (robot, state) for state, end, robot, location in activities
        if not location and end == state.stamp and state.agent == robot and state.seq in commanded
    ]


def _uncommanded(scenario: Scenario, steps: Sequence[Done], record: MissionRecord) -> Set[int]:
    """The numbers of the states to which a word without a number led, of a controllable agent: nobody is ordered to do
    that."""
    controllable = {agent.name for agent in scenario.agents if agent.controllable}
    reported = {word.event for word in record.words if word.seq is None}
    return {
        state.seq
        for _, state, mover, is_command in steps
        if mover in controllable and not is_command and not state.commanded and state.event in reported
    }


def _activities(steps: Sequence[Done], robots: Sequence[str], record: MissionRecord) -> List[Activity]:
    """What robots began, and until when (the next step of the robot); of a recorder that came late, also what was under
    way then."""
    begun: List[Activity] = []
    open_: Dict[str, int] = {}
    if record.is_late:
        first = record.states[0]
        for robot in robots:
            there = first.locations[robot]
            if role_of(there) in UNDER_WAY:
                open_[robot] = len(begun)
                begun.append((first, float("inf"), robot, there if role_of(there) is Role.WAY else ""))
            elif first.agent == robot:
                begun.append((first, first.stamp, robot, ""))
    for before, state, mover, _ in steps:
        for robot in robots:
            here, there = before.locations[robot], state.locations[robot]
            if there == here:
                if mover == robot:  # something that takes no time, also under way to a place
                    begun.append((state, state.stamp, robot, ""))
                continue
            if robot in open_:
                place = open_.pop(robot)
                begun[place] = (begun[place][0], record.known_from(state), robot, begun[place][3])
            if mover == robot and breaks_off(here, state.event):
                begun.append((state, state.stamp, robot, ""))
            if role_of(there) is Role.WAY:
                open_[robot] = len(begun)
                begun.append((state, float("inf"), robot, there))
            elif role_of(there) is Role.WORK and (mover == robot or robot not in state.lost):
                open_[robot] = len(begun)
                begun.append((state, float("inf"), robot, ""))
    return begun


class _ActivityIndex:
    """The activities of each robot by their beginnings, goals and actions apart."""

    def __init__(self, activities: Sequence[Activity]) -> None:
        self._activities = activities
        self._places: Dict[Tuple[str, bool], List[Tuple[float, int]]] = {}
        for place, (state, _, robot, location) in enumerate(activities):
            self._places.setdefault((robot, bool(location)), []).append((state.stamp, place))

    def activity(self, order: RobotOrder) -> Optional[int]:
        """Which activity the order is for: of those of its kind that go on, the one that begins nearest to it."""
        places = self._places.get((order.robot, order.is_goal), [])
        if order.seq is not None:
            return next((place for _, place in places if self._activities[place][0].seq == order.seq), None)
        number = bisect.bisect(places, (order.at + EARLY, len(self._activities)))
        fitting = [
            (abs(order.at - begins), place)
            for begins, place in places[max(0, number - 2) : number]
            if order.at <= self._activities[place][1] + LATE
        ]
        return min(fitting)[1] if fitting else None


def _places(scenario: Scenario, robot: str) -> Dict[str, Point]:
    """The points that are known for a robot: its own poses, else those of the places.

    Where it stands beside another robot is for the workspace to say; that is never at the pose of another place.
    """
    found = {name: (pose.x, pose.y, pose.z) for name, pose in poses(scenario)[0].items()}
    own = {poi.name: s.pose for poi in scenario.pois for s in poi.spots if s.robot.name == robot}
    return {**found, **{name: (pose.x, pose.y, pose.z) for name, pose in own.items()}}


def _elsewhere(goal: Point, poi: str, again: bool, places: Dict[str, Point], where: Mapping[str, Point]) -> str:
    """Where a goal leads that should lead to the POI; "" where it may be right: poses are the workspace's. One that is
    sent `again` may be for the robot's spare pose, near its own one."""
    known = places.setdefault(poi, goal)
    if again and _far(goal, known) and math.dist(goal, known) <= SPARE_REACH + NEAR:
        known = places.setdefault(f"{poi} (spare)", goal)
    if _far(goal, known):
        return f"to ({goal[0]:.2f}, {goal[1]:.2f}), and {poi} was at ({known[0]:.2f}, {known[1]:.2f}) before"
    others = [name for name, place in where.items() if not _far(goal, place)]
    return f"to {others[0]} on its way to {poi}" if others and poi not in others else ""


def _far(one: Point, other: Point) -> bool:
    return any(not abs(a - b) <= NEAR for a, b in zip(one, other))


def _returns(record: MissionRecord, order: RobotOrder) -> bool:
    """True if a state had the robot return to its place about when it got the goal."""
    ends = [*(record.known_from(state) for state in record.states[1:]), float("inf")]
    return any(
        order.robot in state.returning and state.stamp - EARLY <= order.at <= end + LATE
        for state, end in zip(record.states, ends)
    )


def _joins(record: MissionRecord, scenario: Scenario, order: RobotOrder) -> bool:
    """True if another agent had begun the event, as a collaborative one to which the robot reacts."""
    reacts = any(a.name == order.robot and order.action in {ref.name for ref in a.reacts_to} for a in scenario.agents)
    return reacts and any(
        order.seq in (None, state.seq) and state.event == order.action and state.agent != order.robot
        and state.stamp - EARLY <= order.at
        for state in record.states
    )


def _number_at(record: MissionRecord, at: float) -> int:
    earlier = [state.seq for state in record.states if state.stamp <= at]
    return earlier[-1] if earlier else record.states[0].seq


Receipt = Tuple[str, int]
"""A robot, and the number of the state that its order follows from."""


def receipts_in(record: MissionRecord, controllers: AbstractSet[str]) -> Set[Receipt]:
    """Return which orders were acknowledged, by other nodes than those that give them."""
    return {
        (word.agent, word.seq)
        for word in record.words
        if word.event == ORDERED and word.seq is not None and word.node not in controllers
    }


def without_receipt(
    record: MissionRecord, at_once: Iterable[Tuple[str, SystemState]], receipts: AbstractSet[Receipt]
) -> List[Finding]:
    """Return a finding for each order of a won mission that was to be acknowledged, and was not.

    `at_once`: robots, and the states that follow from what they were commanded to do at once. Actions without numbers,
    which a robot gets where `orders` is not numbered, are acknowledged by nobody; neither are those of a recording
    whose states have no orders, which is older.
    """
    orders = [(state, order) for state in record.states for order in parse_orders(state.orders)]
    if not orders or not any(state.status == WON for state in record.states):
        return []
    plain = {(order.robot, order.action) for order in record.orders if order.action and order.seq is None}
    wanted = {(robot, state.seq): (state, state.event) for robot, state in at_once}
    for state, order in orders:
        if order.at_once:
            wanted.setdefault((order.agent, order.seq), (state, order.event))
    found: List[Finding] = []
    for (robot, seq), (state, event) in sorted(wanted.items(), key=lambda entry: entry[0]):
        if (robot, seq) not in receipts and (robot, event) not in plain:
            level = UNRECORDED if state.stamp <= record.whole_from else FAULT
            text = f"the mission was won, but {robot}'s side has not acknowledged {event}"
            found.append(Finding(level, "unacknowledged", seq, text))
    return found
