"""How each robot is connected to its controller: the parameters of the node that concern robots."""

from __future__ import annotations

import math
import re
from typing import Any, Mapping, NamedTuple, Tuple

from pursue_runtime.data import DataError

GOALS, ENDS, ON_STOP = ("simple", "action"), ("words", "result", "pose", "tf"), ("finish", "cancel")
ORDERS = ("numbered", "plain", "person")
NAVIGATION = {"move_base": "move_base", "move_base_flex": "move_base_flex/move_base"}
"""What drives a robot, and the action that takes its goals, in the robot's namespace."""

POSITIONS = {"pose": ("pose",), "tf": ("tf",), "none": ()}
"""The sources of positions by `~position`: amcl_pose, tf, or none."""

DEFAULT_POSITIONS = {"words": (), "result": ("pose", "tf"), "pose": ("pose",), "tf": ("tf",)}
"""The sources of positions by `~ends`, with `~position` auto; tf counts for `result` where tf2_ros is installed."""


_NAMESPACE = re.compile(r"(/?[A-Za-z]\w*(/\w+)*)?", re.ASCII)
"""Of a robot's nodes; "": they run in none."""


class Settings(NamedTuple):
    """How one robot is connected. Each is a parameter of the node, or of one robot: `~ends`, `~bot1/ends`."""

    goals: str = "simple"
    ends: str = "words"
    on_stop: str = "finish"
    orders: str = "numbered"
    retries: int = 2
    retry_delay: float = 1.0
    end_tolerance: float = 0.4
    end_yaw_tolerance: float = 0.75
    end_settle: float = 0.5
    still_distance: float = 0.05
    still_angle: float = 0.1
    position: str = "auto"
    clock_skew: float = 0.5
    map_frame: str = "map"
    base_frame: str = "{namespace}/base_link"
    namespace: str = "{robot}"
    navigation: str = "move_base"
    simulated: bool = False

    def topic(self, name: str) -> str:
        """Return the name of a topic of the robot; without a namespace its nodes run where ours do."""
        return f"{self.namespace}/{name}" if self.namespace else name

    @property
    def action(self) -> str:
        """Return the name of the action that takes its goals."""
        return self.topic(NAVIGATION[self.navigation])

    @property
    def uses_results(self) -> bool:
        """Return True if results of move_base are used."""
        return self.goals == "action" or self.ends == "result"

    @property
    def ends_by_position(self) -> bool:
        """Return True if the controller finds from the position that the robot has arrived."""
        return self.ends in ("pose", "tf")

    @property
    def sources(self) -> Tuple[str, ...]:
        """Return where the robot's position is read: amcl_pose ("pose"), tf ("tf")."""
        return DEFAULT_POSITIONS[self.ends] if self.position == "auto" else POSITIONS[self.position]

    @property
    def believes_words(self) -> bool:
        """Return True if nothing but the words on pursue/events shows where the robot is."""
        return self.ends == "words" and not self.sources


def read_settings(robot: str, given: Mapping[str, Any]) -> Settings:
    """The robot's settings among the node's parameters; those in the group of its name win. Raises DataError."""
    own = given.get(robot, {})
    if not isinstance(own, dict) or set(own) - set(Settings._fields):
        raise DataError(f"~{robot} is {own!r}; expected some of {', '.join(Settings._fields)}")
    values = {**given, **own}
    defaults = Settings()._asdict()
    settings = Settings(**{name: _checked(name, values[name], defaults[name]) for name in defaults if name in values})
    known_values = (
        ("goals", GOALS), ("ends", ENDS), ("on_stop", ON_STOP), ("orders", ORDERS), ("position", ("auto", *POSITIONS)),
        ("navigation", NAVIGATION),
    )  # fmt: skip
    for name, known in known_values:
        if getattr(settings, name) not in known:
            raise DataError(f"~{name} of {robot} is {getattr(settings, name)!r}; expected one of {', '.join(known)}")
    if settings.ends_by_position and settings.position not in ("auto", settings.ends):
        raise DataError(
            f"~position of {robot} is {settings.position!r}, and ~ends is {settings.ends!r}; expected auto or"
            f" {settings.ends}: the position that shows the arrival"
        )
    if settings.simulated and settings.position not in ("auto", "none"):
        raise DataError(f"~position of {robot} is {settings.position!r}, but it is simulated: it has no position")
    if settings.simulated and (settings.goals, settings.ends) != ("simple", "words"):
        raise DataError(
            f"goals:={settings.goals} and ends:={settings.ends} for {robot}, which is simulated: the simulator takes"
            " simple goals and reports ends as words; leave these out, or set simulate:=false for real robots"
        )
    if settings.navigation == "move_base_flex" and settings.goals == "simple":
        raise DataError(
            f"~goals of {robot} is 'simple', but move_base_flex takes no simple goals; expected goals:=action, or"
            " navigation: move_base where its relay (move_base_legacy_relay.py) runs"
        )
    namespace = _namespace(robot, settings, given)
    map_frame, base_frame = (_in_names(each, robot, namespace) for each in (settings.map_frame, settings.base_frame))
    return settings._replace(namespace=namespace, map_frame=map_frame, base_frame=base_frame)


def _namespace(robot: str, settings: Settings, given: Mapping[str, Any]) -> str:
    """The namespace of the robot's nodes, without the slash at its end. Raises DataError where two robots would have
    the same one: each would get the goals of the other."""
    found = settings.namespace.replace("{robot}", robot).rstrip("/")
    if not _NAMESPACE.fullmatch(found):
        raise DataError(f"~namespace of {robot} is {settings.namespace!r}; expected a name such as tb3_0")
    if settings.simulated and found != robot:
        raise DataError(
            f"~namespace of {robot} is {found!r}, but it is simulated, in the namespace {robot}; leave it out, or set"
            " simulate:=false for real robots"
        )
    everybodys = given.get("namespace")
    if isinstance(everybodys, str) and "{robot}" not in everybodys and settings.namespace == everybodys:
        raise DataError(
            f"~namespace is {everybodys!r} for all robots, who would all get the same goals; expected it below the"
            f" robot's name, {robot}: {{namespace: {found or repr(found)}}}"
        )
    for other, own in given.items():
        if other != robot and isinstance(own, dict) and own.get("namespace", other) == found:
            raise DataError(
                f"~namespace of {robot} is {found!r}, and so is that of {other}: both would get the same goals;"
                " expected another one for one of them"
            )
    return found


def _in_names(text: str, robot: str, namespace: str) -> str:
    """A frame with its names in it; tf2 has no frame that begins with a slash."""
    return text.replace("{robot}", robot).replace("{namespace}", namespace).lstrip("/")


def _checked(name: str, value: Any, default: Any) -> Any:
    """The value as the type of its default; numbers are not negative. Raises DataError."""
    kind = type(default)
    if isinstance(value, kind) and kind in (bool, str):
        return value
    number = isinstance(value, (int, float)) and not isinstance(value, bool) and 0 <= value < math.inf
    if number and kind in (int, float) and kind(value) == value:
        return kind(value)
    wanted = {bool: "true or false", str: "a name", int: "a whole number", float: "a number that is not negative"}
    raise DataError(f"~{name} is {value!r}; expected {wanted[kind]}")
