"""Arguments and options that several commands have, declared once."""

from __future__ import annotations

import functools
import inspect
import math
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, Callable, Dict, List, Mapping, Optional, Sequence, get_type_hints

import typer

from pursue_gen.diagnostics import usage_error

if TYPE_CHECKING:
    from pursue_gen.solving.request import SolveRequest


WORDS: Mapping[str, Sequence[str]] = {
    "ends": ("reported", "controllable"),
    "controllers": ("distributed", "centralized", "general"),
    "solver": ("verifytga",),
    "optimize": ("time", "none"),
    "opponent": ("random", "worst", "still", "mixed"),
    "side": ("world", "robots"),
    "kind": ("reach", "respond", "avoid", "never-with", "catch", "patrol"),
}
"""What may stand behind the options that take one of some words, by the names of their parameters."""


def choice(name: str, default: Optional[str], help: str, *names: str) -> Any:
    """An option that takes one of the WORDS of this parameter."""
    words = WORDS[name]

    def check(value: Optional[str]) -> Optional[str]:
        if value is not None and value not in words:
            raise typer.BadParameter(f"{value!r} is not one of {', '.join(map(repr, words))}.")
        return value

    return typer.Option(
        default, *names, metavar=f"<{'|'.join(words)}>", callback=check, autocompletion=lambda: list(words), help=help
    )


def _seconds(text: Optional[str]) -> Optional[float]:
    """The limit on time as a number, 0 for none; None if it is not given."""
    if text is None:
        return None
    try:
        seconds = 0.0 if text == "none" else float(text)
    except ValueError:
        seconds = math.nan
    if not 0 <= seconds < math.inf:
        raise typer.BadParameter(f"'{text}'; expected a number of seconds such as 60, or none")
    return seconds


def _spot_distance(metres: float) -> float:
    """The distance, if robots can stand so far apart."""
    if metres != 0 and not 0.01 <= metres <= 100:
        raise typer.BadParameter(f"{metres:g} metres; expected 0, or 0.01 to 100, such as 0.8")
    return metres


SCENARIO = typer.Argument(..., metavar="SCENARIO", help="A scenario in PuRSUE-ML, by convention *.pur.")
GAME = "SCENARIO | TGA.xml TCTL.q"
EXPLAIN = typer.Option(
    True,
    "--explain/--no-explain",
    help="Where the objective cannot be met: look for what would change that; where a limit is hit: for what makes the "
    "scenario so large.",
)
MARGIN = typer.Option(
    False,
    "--margin",
    help="Find the margin however long it takes, and the game's: the largest reaction for which it can be won at all.",
)
JSON = typer.Option(False, "--json", help="Print JSON on stdout.")
KEY = typer.Option(
    None, "--key", metavar="NAME|PATH", help="Sign with this key; with the only one there is by default."
)
DEFAULT_DISTANCE = 0.8
"""SPOT_DISTANCE of workspace.spots, which takes long to import."""
SPOT_DISTANCE = typer.Option(
    DEFAULT_DISTANCE,
    metavar="METRES",
    help="How far apart robots stand at one place, side by side, unless the scenario has a pose for each (0: all at "
    "the place's pose).",
    callback=_spot_distance,
)
ROBOT = typer.Option(
    [],
    "--robot",
    metavar="[ROBOT=]METRES|YAML",
    help="The radius of all robots, or of this one, or parameters of their costmaps and planners: footprint, "
    "inflation_radius, xy_goal_tolerance; goes before what the scenario says; repeatable.",
)
KEYS = typer.Option(
    None, "--keys", metavar="DIR", help="Where the keys are; ~/.config/pursue/keys by default (XDG_CONFIG_HOME)."
)


class _Request:
    """The options that make a SolveRequest."""

    controllers: str = choice("controllers", "distributed", "As for ws.")
    reach_obj: str = typer.Option(
        "dedicated",
        metavar="dedicated|all|ROBOT",
        help="Who gets the objective's commands: a controller of their own, all, or a robot's.",
    )
    ends: Optional[str] = choice(
        "ends",
        None,
        "Who controls the end of a controlled agent's movement or action: reported (the robot tells when it is done; "
        "the default) or controllable (the plan decides it: the original's game, and UPPAAL-TIGA's).",
    )
    reaction: Optional[str] = typer.Option(
        None, metavar="UNITS", help="How late a command may take effect, in time units: 0.1 (the default), 1/20, 0 …"
    )
    slack: List[str] = typer.Option(
        [],
        metavar="[AGENT=]UNITS",
        help="A robot, or with AGENT= this one, may end so much later than the model; repeatable.",
    )
    plan: Optional[Path] = typer.Option(
        None, metavar="FILE", help="Use this plan (UPPAAL-TIGA's format) instead of solving."
    )
    solver: Optional[str] = choice(
        "solver",
        None,
        "verifytga: UPPAAL-TIGA's, where you have it, instead of the built-in one; its strategy is proven, too.",
    )
    verifytga: Optional[Path] = typer.Option(None, metavar="PATH", help="Where that program is, if not on PATH.")
    optimize: Optional[str] = choice(
        "optimize",
        None,
        "time: look for the strategy with the least worst-case time to the goal, for some two minutes or as --limit "
        "says; none: take the first strategy. By default: a quick one that takes little work.",
    )
    within: Optional[str] = typer.Option(
        None,
        metavar="UNITS",
        help="Can the goal be reached within so many time units? A strategy that does, or status 4.",
    )
    whole: bool = typer.Option(
        False,
        "--whole",
        help="An experiment: solve the whole game in one piece, agents and rules included that cannot matter.",
    )
    limit: Optional[str] = typer.Option(
        None,
        metavar="SECONDS|none",
        help="Give up after so much processor time (none: never); 60 by default.",
        callback=_seconds,
    )
    memory: Optional[int] = typer.Option(
        None,
        metavar="MIB",
        min=0,
        help="Give up when so much memory is in use (0: no limit); by default 1024, or 80 % of what is available.",
    )


class _Places:
    """The options that make `Poses`, in the order of its fields."""

    poses: Optional[Path] = typer.Option(
        None,
        metavar="FILE",
        help="Where the points are on the robots' map: a file like config/poses.yaml of a workspace.",
    )
    computed_poses: bool = typer.Option(
        False, "--computed-poses", help="Points without a pose get a computed one: for simulated robots only."
    )
    spot_distance: float = SPOT_DISTANCE


@dataclass(frozen=True)
class Poses:
    """Where robots are sent: a poses.yaml, whether missing poses are `computed`, metres between robots at one place."""

    file: Optional[Path] = None
    computed: bool = False
    spot_distance: float = DEFAULT_DISTANCE


REQUEST: Any = None
PLACES: Any = None
"""Mark the parameters `request` and `places` of a command, for which `with_request` declares the options."""

MISSION = tuple(name for name in get_type_hints(_Request) if name != "whole")
"""The options of the commands that generate what robots run."""


def with_request(*names: str, **own: Any) -> Callable[[Callable[..., None]], Callable[..., None]]:
    """Declare these options for a command, in the place of its parameter `request`, which gets a SolveRequest of them;
    and those of `Poses` in the place of its parameter `places`, if it has that.

    `own`: declarations of this command that replace the shared ones.
    """
    groups = {"request": (_Request, names), "places": (_Places, tuple(get_type_hints(_Places)))}

    def decorate(command: Callable[..., None]) -> Callable[..., None]:
        @functools.wraps(command)
        def run(**arguments: Any) -> None:
            if "places" in command.__annotations__:
                arguments["places"] = Poses(*(arguments.pop(name) for name in groups["places"][1]))
            values = {name: arguments.pop(name) for name in names}
            command(request=_request(values), **arguments)

        run.__annotations__ = {name: kind for name, kind in command.__annotations__.items() if name not in groups}
        types = get_type_hints(run)
        parameters: List[inspect.Parameter] = []
        for parameter in inspect.signature(command).parameters.values():
            if parameter.name not in groups:
                parameters.append(parameter.replace(annotation=types[parameter.name]))
                continue
            declared, wanted = groups[parameter.name]
            for name in wanted:
                types[name] = get_type_hints(declared)[name]
                default = own.get(name, getattr(declared, name))
                parameters.append(inspect.Parameter(name, parameter.kind, default=default, annotation=types[name]))
        # typer reads both.
        run.__signature__ = inspect.Signature(parameters)  # type: ignore[attr-defined] # only inspect knows it
        run.__annotations__ = types
        return run

    return decorate


def _request(values: Dict[str, Any]) -> SolveRequest:
    """The request of parsed options; limits that are not given are the default ones."""
    from pursue_gen import api

    return api.request(seconds=values.pop("limit", None), **values)


def speeds_of(texts: Sequence[str], robots: Sequence[str]) -> Dict[str, float]:
    """The speed of each robot for which there is one, in metres per second; one of its own goes before that of all.

    Raises PursueError.
    """
    found: Dict[str, float] = {}
    for text in sorted(texts, key=lambda one: "=" in one):
        name, _, number = text.rpartition("=")
        try:
            value = float(number)
        except ValueError:
            value = math.nan
        if not 0.001 <= value <= 1000:
            raise usage_error(f"--speed {text} is no speed", "expected metres per second, such as bot1=0.4")
        found.update({robot: value for robot in ([name] if name else robots)})
    return found
