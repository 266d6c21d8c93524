"""`agent "name" …`: somebody who does something."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar, Mapping, Optional, Tuple

from pursue_gen.diagnostics import NOWHERE, Span
from pursue_gen.language.numbers import Number
from pursue_gen.language.refs import Ref
from pursue_gen.language.statements.base import StatementKind, behind, joined, label_text, names_text
from pursue_gen.language.tokens import bare
from pursue_gen.language.tree_reader import TreeReader
from pursue_gen.language.word import Form, Word

SIZE = ("radius", "tolerance", "inflation")
"""The words of a robot's size, in the order in which they stand, which is that of the fields of `RobotSize`."""


@dataclass(frozen=True)
class Agent(StatementKind):
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

    listed_in: ClassVar[str] = "agents"
    words: ClassVar[Tuple[Word, ...]] = (
        Word("agent", "Somebody who does something: a robot, a person, a thing with a will of its own."),
        Word(
            "human",
            "An ally who follows instructions, but has no robot: the user interface tells the person what to do.",
            True,
        ),
        Word(
            "controllable",
            "The program decides what this agent does. Without it, the agent does as it likes, also the worst.",
        ),
        Word("mobile", "It moves, and needs so many units of time for a unit of distance. A larger number is slower."),
        Word("radius", "Metres from the middle of the robot to its farthest part: what it needs to turn.", True),
        Word("tolerance", "Metres by which the robot stops beside its goal, at most (xy_goal_tolerance).", True),
        Word("inflation", "Metres around obstacles that the robot's planners avoid (inflation_radius).", True),
        Word("can_do", "The events that it does.", may_break=True),
        Word("reacts_to", "The collaborative events in which it is the partner.", may_break=True),
    )
    grammar: ClassVar[str] = (
        'agent: "agent" NAME [LABEL NAME] [HUMAN] [CONTROLLABLE] ["mobile" NUMBER] _size "location" ref'
        ' ["can_do" refs] ["reacts_to" refs]\n'
        '_size: ["radius" NUMBER] ["tolerance" NUMBER] ["inflation" NUMBER]'
    )
    form: ClassVar[str] = (
        'agent "bot" human controllable mobile 3 location a can_do e1, e2 reacts_to e3 (location is required; '
        'behind the name: label "Porter 1"; before location, of a robot: radius 0.2 tolerance 0.1 inflation 0.5)'
    )
    forms: ClassVar[Tuple[Form, ...]] = (
        Form("a robot", 'agent "{=bot}" controllable mobile {=1} location {POI} can_do {event}'),
        Form("somebody who does as they like", 'agent "{=visitor}" mobile {=1} location {POI} can_do {event}'),
        Form("a person who helps", 'agent "{=helper}" human controllable mobile {=1} location {POI} can_do {event}'),
    )
    declares: ClassVar[str] = "agent"
    shortest: ClassVar[str] = 'agent "{name}" location {place}'
    refers_to: ClassVar[Mapping[str, str]] = {"location": "POI", "can_do": "event", "reacts_to": "event"}
    used: ClassVar[Mapping[str, str]] = {"location": "POI", "can_do": "event", "reacts_to": "event"}
    parts: ClassVar[Tuple[str, ...]] = (
        "AGENT", "LABEL", "HUMAN", "CONTROLLABLE", "MOBILE", "RADIUS", "TOLERANCE", "INFLATION", "LOCATION", "CAN_DO",
        "REACTS_TO",
    )  # fmt: skip

    @classmethod
    def read(cls, reader: TreeReader, *children: Any, **at: Any) -> Agent:
        name, _, label, human, controllable, *numbers, location, can, reacts = children
        mobile, radius, tolerance, inflation = map(reader.number_or_none, numbers)
        return cls(
            name=bare(name),
            human=human is not None,
            controllable=controllable is not None,
            mobile=mobile,
            location=reader.ref(location),
            can_do=reader.refs(can),
            reacts_to=reader.refs(reacts),
            span=reader.at(name),
            label=reader.label(label),
            radius=radius,
            tolerance=tolerance,
            inflation=inflation,
        )

    @property
    def shown(self) -> str:
        """What people read."""
        return self.label or self.name

    @property
    def is_robot(self) -> bool:
        """True for an agent that gets a controller of its own."""
        return self.controllable and not self.human

    @property
    def text(self) -> str:
        return joined(
            f'agent "{self.name}"',
            label_text(self.label),
            self.human and "human",
            self.controllable and "controllable",
            *(behind(word, getattr(self, word)) for word in ("mobile", *SIZE)),
            f"location {self.location.name}",
            behind("can_do", names_text(self.can_do)),
            behind("reacts_to", names_text(self.reacts_to)),
        )
