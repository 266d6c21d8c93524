"""The parts of a scenario but its objectives and assumptions, each with its place in the text."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Optional, Tuple, Union

from pursue_gen.diagnostics import NOWHERE, Span
from pursue_gen.language.conditions import Condition
from pursue_gen.language.numbers import Number, exact
from pursue_gen.language.refs import Ref


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
    pose: Optional[Pose] = None
    span: Span = NOWHERE
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
    span: Span = NOWHERE
    ends: Tuple[Span, Span] = (NOWHERE, NOWHERE)
    one_way: bool = False
    only_if: Optional[Condition] = None

    @property
    def directions(self) -> Tuple[Tuple[str, str], ...]:
        """From and to, for each direction in which it can be taken; the declared one first."""
        return ((self.a, self.b),) if self.one_way else ((self.a, self.b), (self.b, self.a))


Window = Tuple[Number, Number]
"""Something ends later than the first time and at the second one at the latest (time units from its start)."""


def window_of(low: Number, high: Optional[Number]) -> Window:
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
    collaborative: bool = False
    location: Optional[Ref] = None
    duration: Optional[Number] = None
    span: Span = NOWHERE
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
        return None if self.duration is None else window_of(self.duration, self.latest)


@dataclass(frozen=True)
class Sequence:
    """`first before second` in a rule."""

    first: RuleBody
    second: RuleBody
    span: Span = NOWHERE


@dataclass(frozen=True)
class Choice:
    """`first or second` in a rule."""

    first: RuleBody
    second: RuleBody
    span: Span = NOWHERE


@dataclass(frozen=True)
class Both:
    """`first and second` in a rule: in any order, and while the other one goes on."""

    first: RuleBody
    second: RuleBody
    span: Span = NOWHERE


RuleBody = Union[Ref, Sequence, Choice, Both]


@dataclass(frozen=True)
class Rule:
    """A cyclic order of events: each event that a rule names may happen only when it is its turn.

    `each`: every robot ("robot"), or every agent ("agent"), that can do one of its events has its own turn; "": all
    have one turn.
    """

    name: str
    body: RuleBody
    span: Span = NOWHERE
    each: str = ""


@dataclass(frozen=True)
class State:
    """A Boolean that events set and reset."""

    name: str
    initially: bool
    true_if: Tuple[Ref, ...] = ()
    false_if: Tuple[Ref, ...] = ()
    span: Span = NOWHERE


@dataclass(frozen=True)
class Dependency:
    """`event` may happen only while `state` has `value`."""

    event: Ref
    state: Ref
    value: bool
    span: Span = NOWHERE


@dataclass(frozen=True)
class Agent:
    """A robot (controllable), a human ally (controllable and human) or an uncontrollable agent.

    `mobile` is the time units per unit of distance (the inverse of its speed), None: it never moves. `label`: what
    people read; None: the name. `radius`, `tolerance`, `inflation`: of a robot, in metres, as `workspace.robot_size`
    has them; None: not said.
    """

    name: str
    location: Ref
    human: bool = False
    controllable: bool = False
    mobile: Optional[Number] = None
    can_do: Tuple[Ref, ...] = ()
    reacts_to: Tuple[Ref, ...] = ()
    span: Span = NOWHERE
    label: Optional[str] = None
    radius: Optional[Number] = None
    tolerance: Optional[Number] = None
    inflation: Optional[Number] = None

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
    latest: Optional[Number] = None
    span: Span = NOWHERE

    @property
    def way(self) -> Tuple[str, str]:
        """From where to where."""
        return self.a.name, self.b.name

    @property
    def window(self) -> Window:
        """Between which times the agent arrives."""
        return window_of(self.earliest, self.latest)


@dataclass(frozen=True)
class Battery:
    """The battery of a robot, full at the start: it holds `capacity`, and a robot that is on its way or at work uses
    `uses` per time unit. At work at `dock` it uses nothing, and `recharges` as much per time unit (None, 0: nowhere).
    """

    agent: Ref
    capacity: int
    uses: Number
    recharges: Number = 0
    dock: Optional[Ref] = None
    span: Span = NOWHERE
