"""The value of the language stage: a scenario, as its author wrote it, each part with its place in the text."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Optional, Tuple, Union

from pursue_gen.diagnostics import Span


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
    """A name where it is used (not declared)."""

    name: str
    span: Span


@dataclass(frozen=True)
class Spot:
    """Where one robot stands at a place, instead of at the place's pose."""

    robot: Ref
    pose: Pose


@dataclass(frozen=True)
class Poi:
    """A point of interest; `pose` is None where the author gave none or left the thesis's placeholder.

    `spots` are the poses that single robots have there, each robot once.
    """

    name: str
    pose: Optional[Pose]
    span: Span
    spots: Tuple[Spot, ...] = ()


@dataclass(frozen=True)
class Connection:
    """A way between two POIs; `distance` is a natural number of distance units (at least 1).

    `ends` are the places in the text where it names them. `one_way`: from `a` to `b` only, else in both directions.
    """

    a: str
    b: str
    distance: int
    span: Span
    ends: Tuple[Span, Span]
    one_way: bool = False

    @property
    def directions(self) -> Tuple[Tuple[str, str], ...]:
        """From and to, for each direction in which it can be taken; the declared one first."""
        return ((self.a, self.b),) if self.one_way else ((self.a, self.b), (self.b, self.a))


@dataclass(frozen=True)
class Event:
    """Something that agents do. `duration` is in time units, None: instantaneous; `location` None: anywhere.

    `together`: whoever takes part in a collaborative event is busy until it ends; else only the one who does it.
    """

    name: str
    collaborative: bool
    location: Optional[Ref]
    duration: Optional[int]
    span: Span
    together: bool = False

    @property
    def is_shared(self) -> bool:
        """True for an event that lasts for its partners as well."""
        return self.together and self.collaborative and self.duration is not None


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


RuleBody = Union[Ref, Sequence, Choice]


@dataclass(frozen=True)
class Rule:
    """A cyclic order of events: each event that a rule names may happen only when it is its turn."""

    name: str
    body: RuleBody
    span: Span


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

    `mobile` is the time units per unit of distance (the inverse of its speed), None: it never moves.
    """

    name: str
    human: bool
    controllable: bool
    mobile: Optional[int]
    location: Ref
    can_do: Tuple[Ref, ...]
    reacts_to: Tuple[Ref, ...]
    span: Span

    @property
    def is_robot(self) -> bool:
        """True for an agent that gets a controller of its own."""
        return self.controllable and not self.human


@dataclass(frozen=True)
class Respond:
    """`if trigger then response within deadline` (time units)."""

    trigger: Ref
    response: Ref
    deadline: int
    span: Span


@dataclass(frozen=True)
class Avoid:
    """`avoid event`."""

    event: Ref
    span: Span


@dataclass(frozen=True)
class NeverWith:
    """`first never_with second`: two agents that never share a POI nor a connection."""

    first: Ref
    second: Ref
    span: Span


Safety = Union[Respond, Avoid, NeverWith]


@dataclass(frozen=True)
class Reach:
    """`do event after T`: win once the event happens later than `after` time units from the start."""

    event: Ref
    after: int
    span: Span


@dataclass(frozen=True)
class Scenario:
    """A whole scenario. `name` is the file's stem, `text` the source; parts are in the order of their declaration."""

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
    safety: Optional[Safety]
    reach: Optional[Reach]
