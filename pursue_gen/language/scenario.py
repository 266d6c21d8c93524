"""The value of the language stage: a scenario, as its author wrote it, each part with its place in the text."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import Collection, Dict, Iterator, Optional, Tuple, Union

from pursue_gen.diagnostics import Span
from pursue_gen.language.conditions import Condition, Not, Who
from pursue_gen.language.numbers import Number, exact


@dataclass(frozen=True)
class Pose:
    """A pose in frame `map`: position in metres, orientation as a unit quaternion, in the order of geometry_msgs."""

    x: float
    y: float
    z: float
    qx: float
    qy: float
    qz: float
    qw: float


@dataclass(frozen=True)
class Ref:
    """A name where it is used (not declared), with the label of what it stands for; "": it has none."""

    name: str
    span: Span
    label: str = ""

    @property
    def shown(self) -> str:
        """What people read."""
        return self.label or self.name


@dataclass(frozen=True)
class Spot:
    """Where one robot stands at a place, instead of at the place's pose."""

    robot: Ref
    pose: Pose


@dataclass(frozen=True)
class Poi:
    """A point of interest; `pose` is None where the author gave none or left the thesis's placeholder.

    `spots` are the poses that single robots have there, each robot once. `label`: what people read; None: the name.
    """

    name: str
    pose: Optional[Pose]
    span: Span
    spots: Tuple[Spot, ...] = ()
    label: Optional[str] = None

    @property
    def shown(self) -> str:
        """What people read."""
        return self.label or self.name


@dataclass(frozen=True)
class Connection:
    """A way between two POIs; `distance` is in distance units, more than 0.

    `ends` are the places in the text where it names them. `one_way`: from `a` to `b` only, else in both directions.
    Agents set off only while `only_if` holds (None: always).
    """

    a: str
    b: str
    distance: Number
    span: Span
    ends: Tuple[Span, Span]
    one_way: bool = False
    only_if: Optional[Condition] = None

    @property
    def directions(self) -> Tuple[Tuple[str, str], ...]:
        """From and to, for each direction in which it can be taken; the declared one first."""
        return ((self.a, self.b),) if self.one_way else ((self.a, self.b), (self.b, self.a))


Window = Tuple[Number, Number]
"""Something ends later than the first time and at the second one at the latest (time units from its start)."""


def _window(low: Number, high: Optional[Number]) -> Window:
    """The window of something for which the author wrote one number or two: one alone leaves one time unit."""
    return low, exact(low + 1) if high is None else high


@dataclass(frozen=True)
class Event:
    """Something that agents do. `duration` is in time units, None: instantaneous; `location` None: anywhere.

    It ends later than `duration`, and at `latest` at the latest; None: within one time unit more. `at_most`: so often
    it can happen in all; None: as often as one likes.
    `together`: whoever takes part in a collaborative event is busy until it ends; else only the one who does it.
    `only_if`: what has to hold when it begins; None: nothing. `label`: what people read; None: the name.
    """

    name: str
    collaborative: bool
    location: Optional[Ref]
    duration: Optional[Number]
    span: Span
    together: bool = False
    latest: Optional[Number] = None
    at_most: Optional[int] = None
    only_if: Optional[Condition] = None
    label: Optional[str] = None

    @property
    def shown(self) -> str:
        """What people read."""
        return self.label or self.name

    @property
    def is_shared(self) -> bool:
        """True for an event that lasts for its partners as well."""
        return self.together and self.collaborative and self.duration is not None

    @property
    def window(self) -> Optional[Window]:
        """Between which times it ends; None for an event that is instantaneous."""
        return None if self.duration is None else _window(self.duration, self.latest)


@dataclass(frozen=True)
class Sequence:
    """`first before second` in a rule."""

    first: RuleBody
    second: RuleBody
    span: Span


@dataclass(frozen=True)
class Choice:
    """`first or second` in a rule."""

    first: RuleBody
    second: RuleBody
    span: Span


@dataclass(frozen=True)
class Both:
    """`first and second` in a rule: in any order, and while the other one goes on."""

    first: RuleBody
    second: RuleBody
    span: Span


RuleBody = Union[Ref, Sequence, Choice, Both]


@dataclass(frozen=True)
class Rule:
    """A cyclic order of events: each event that a rule names may happen only when it is its turn.

    `each`: every robot ("robot"), or every agent ("agent"), that can do one of its events has its own turn; "": all
    have one turn.
    """

    name: str
    body: RuleBody
    span: Span
    each: str = ""


@dataclass(frozen=True)
class State:
    """A Boolean that events set and reset."""

    name: str
    initially: bool
    true_if: Tuple[Ref, ...]
    false_if: Tuple[Ref, ...]
    span: Span


@dataclass(frozen=True)
class Dependency:
    """`event` may happen only while `state` has `value`."""

    event: Ref
    state: Ref
    value: bool
    span: Span


@dataclass(frozen=True)
class Agent:
    """A robot (controllable), a human ally (controllable and human) or an uncontrollable agent.

    `mobile` is the time units per unit of distance (the inverse of its speed), None: it never moves. `label`: what
    people read; None: the name.
    """

    name: str
    human: bool
    controllable: bool
    mobile: Optional[Number]
    location: Ref
    can_do: Tuple[Ref, ...]
    reacts_to: Tuple[Ref, ...]
    span: Span
    label: Optional[str] = None

    @property
    def shown(self) -> str:
        """What people read."""
        return self.label or self.name

    @property
    def is_robot(self) -> bool:
        """True for an agent that gets a controller of its own."""
        return self.controllable and not self.human


@dataclass(frozen=True)
class Travel:
    """How long an agent takes from `a` to `b`, in place of what distance and speed say: more than `earliest` time units
    and at most `latest`; None: one more than that.
    """

    agent: Ref
    a: Ref
    b: Ref
    earliest: Number
    latest: Optional[Number]
    span: Span

    @property
    def way(self) -> Tuple[str, str]:
        """From where to where."""
        return self.a.name, self.b.name

    @property
    def window(self) -> Window:
        """Between which times the agent arrives."""
        return _window(self.earliest, self.latest)


@dataclass(frozen=True)
class Battery:
    """The battery of a robot, full at the start: it holds `capacity`, and a robot that is on its way or at work uses
    `uses` per time unit. At work at `dock` it uses nothing, and `recharges` as much per time unit (None, 0: nowhere).
    """

    agent: Ref
    capacity: int
    uses: Number
    recharges: Number
    dock: Optional[Ref]
    span: Span


@dataclass(frozen=True)
class Respond:
    """`if trigger then response within deadline` (time units): events, or conditions.

    A condition has to be answered when it comes to hold, and at the start where it holds; it answers as soon as it
    holds.
    """

    trigger: Union[Ref, Condition]
    response: Union[Ref, Condition]
    deadline: Number
    span: Span
    optional: int = 0

    @property
    def conditions(self) -> Tuple[Condition, ...]:
        """Those of the two that are conditions."""
        return tuple(what for what in (self.trigger, self.response) if not isinstance(what, Ref))

    @property
    def events(self) -> Tuple[Ref, ...]:
        """Those of the two that are events."""
        return tuple(what for what in (self.trigger, self.response) if isinstance(what, Ref))


@dataclass(frozen=True)
class Avoid:
    """`avoid event`."""

    event: Ref
    span: Span
    optional: int = 0


@dataclass(frozen=True)
class NeverWith:
    """`first never_with second`: two agents that never share a POI nor a connection; with `place` not this POI."""

    first: Ref
    second: Ref
    span: Span
    place: Optional[Ref] = None
    optional: int = 0


@dataclass(frozen=True)
class Always:
    """`always condition`, or with `holds` False `avoid condition`: it holds at every moment, or at none."""

    condition: Condition
    holds: bool
    span: Span
    optional: int = 0

    @property
    def broken_if(self) -> Condition:
        """The condition with which the objective is lost."""
        return Not(self.condition) if self.holds else self.condition


@dataclass(frozen=True)
class Patrol:
    """`patrol place every T by who`: it is at the place again so many time units after it left, or after the start.

    `who`: an agent, or any robot: then one of them. A statement with several places is several of these.
    `every`: in time units; None: the least that can be promised is to be found by solving (`solving.periods`). Then
    `least` says that nothing below it can be promised.
    `order`: the places of the statement, where each counts in its turn only (`in order`); () where all count always.
    """

    place: Ref
    every: Optional[Number]
    who: Who
    span: Span
    order: Tuple[str, ...] = ()
    least: Optional[int] = None
    optional: int = 0

    @property
    def period(self) -> Number:
        """The time units from one visit to the next; they are known from solving on."""
        assert self.every is not None, "the period of a patrol has to be found first"
        return self.every


Safety = Union[Respond, Avoid, NeverWith, Always, Patrol]


@dataclass(frozen=True)
class Reach:
    """`do e1 and e2 after T within D`: each event happens, in any order, later than `after` and at most `within` time
    units from the start (None: without a deadline)."""

    events: Tuple[Ref, ...]
    after: Number
    span: Span
    within: Optional[Number] = None
    optional: int = 0


StatedObjective = Union[Safety, Reach]
"""An objective. `optional`: 0 for one that has to be met; else the number behind `optional`, 1 for what is to be kept
longest."""


@dataclass(frozen=True)
class GivenUp:
    """An optional objective that is not promised. `decided`: it cannot be; False: it was too much work to find out."""

    objective: StatedObjective
    decided: bool = True


@dataclass(frozen=True)
class AtMost:
    """`assume: agent does event at_most times times`: it begins the event no more often."""

    agent: Ref
    event: Ref
    times: int
    span: Span


@dataclass(frozen=True)
class Waits:
    """`assume: agent waits time between event`: so many time units from the end of one to the beginning of the next."""

    agent: Ref
    event: Ref
    time: Number
    span: Span


@dataclass(frozen=True)
class Leaves:
    """`assume: agent leaves place within time`: so many time units after it came (or the start) it has set off."""

    agent: Ref
    place: Ref
    time: Number
    span: Span


@dataclass(frozen=True)
class NeverAt:
    """`assume: agent never at place`: it does not set off to that place."""

    agent: Ref
    place: Ref
    span: Span


@dataclass(frozen=True)
class NeverHolds:
    """`assume: not (condition)`: nobody makes it hold, nor sets off where it could hold on arrival.

    It is about agents that are not controlled alone.
    """

    condition: Condition
    span: Span


AboutOne = Union[AtMost, Waits, Leaves, NeverAt]
"""An assumption about one agent."""

Assumption = Union[AtMost, Waits, Leaves, NeverAt, NeverHolds]
"""What agents that are not controlled are assumed to do, or not to do."""


@dataclass(frozen=True)
class Scenario:
    """A whole scenario. `name` is the file's stem, `text` the source; parts are in the order of their declaration.

    All of `safety` has to hold until all of `reach` is reached; for ever where there is none. `given_up` are optional
    objectives that are in neither of them: what is not promised together with the rest.
    """

    name: str
    file: str
    text: str
    pois: Tuple[Poi, ...]
    connections: Tuple[Connection, ...]
    events: Tuple[Event, ...]
    rules: Tuple[Rule, ...]
    states: Tuple[State, ...]
    dependencies: Tuple[Dependency, ...]
    agents: Tuple[Agent, ...]
    safety: Tuple[Safety, ...]
    reach: Tuple[Reach, ...]
    travels: Tuple[Travel, ...] = ()
    assumptions: Tuple[Assumption, ...] = ()
    given_up: Tuple[GivenUp, ...] = ()
    batteries: Tuple[Battery, ...] = ()

    @property
    def optional(self) -> Tuple[int, ...]:
        """The numbers behind `optional` among its objectives, the one that is to be kept longest first."""
        return tuple(sorted({objective.optional for objective in self.objectives} - {0}))

    def giving_up(self, numbers: Collection[int], decided: bool = True) -> Scenario:
        """The scenario with these of its optional objectives given up; `decided` as for GivenUp."""
        given_up = (GivenUp(each, decided) for each in self.objectives if each.optional in numbers)
        return replace(
            self,
            safety=tuple(each for each in self.safety if each.optional not in numbers),
            reach=tuple(each for each in self.reach if each.optional not in numbers),
            given_up=tuple(sorted((*self.given_up, *given_up), key=lambda each: each.objective.optional)),
        )

    @property
    def objectives(self) -> Tuple[StatedObjective, ...]:
        """All objectives: those that always hold, then those that are reached once."""
        return (*self.safety, *self.reach)

    @cached_property
    def labels(self) -> Dict[str, str]:
        """Name → what people read instead, of all places, events and agents with a label."""
        parts: Tuple[Union[Poi, Event, Agent], ...] = (*self.pois, *self.events, *self.agents)
        return {part.name: part.label for part in reversed(parts) if part.label}

    def shown(self, name: str) -> str:
        """What people read for a name: its label, or the name itself."""
        return self.labels.get(name, name)

    def bound_by(self, rule: Rule) -> Tuple[Agent, ...]:
        """The agents that have a turn of their own in a rule for each of them; none where all have one turn."""

        def names(body: RuleBody) -> Iterator[str]:
            if isinstance(body, Ref):
                yield body.name
            else:
                yield from names(body.first)
                yield from names(body.second)

        named = set(names(rule.body)) if rule.each else set()
        able = (agent for agent in self.agents if any(ref.name in named for ref in agent.can_do))
        return tuple(agent for agent in able if agent.is_robot or rule.each == "agent")

    @property
    def statements(self) -> Tuple[Tuple[StatedObjective, ...], ...]:
        """All objectives, those in one part that have a meaning together only: the places of a patrol in order."""
        found: Dict[object, Tuple[StatedObjective, ...]] = {}
        for number, each in enumerate(self.objectives):
            key = each.span if isinstance(each, Patrol) and each.order else number
            found[key] = (*found.get(key, ()), each)
        return tuple(found.values())

    def on_patrol(self, patrol: Patrol) -> Tuple[Agent, ...]:
        """The agents of whom one has to be at the place."""
        who = patrol.who.agent
        return tuple(agent for agent in self.agents if (agent.is_robot if who is None else agent.name == who.name))

    def movements(self, agent: Agent) -> Dict[Tuple[str, str], Window]:
        """From and to of each movement that the agent can make, and between which times it arrives."""
        if agent.mobile is None:
            return {}
        own = {travel.way: travel.window for travel in self.travels if travel.agent.name == agent.name}
        return {
            way: own.get(way) or _window(exact(connection.distance * agent.mobile), None)
            for connection in self.connections
            for way in connection.directions
        }
