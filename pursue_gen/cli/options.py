"""Arguments and options that several commands have, declared once."""

from __future__ import annotations

from enum import Enum
from typing import Optional

import typer


def value(choice: Optional[Enum]) -> Optional[str]:
    """The word that was chosen, if any."""
    return None if choice is None else str(choice.value)


class Ends(str, Enum):
    """Who controls the ends of the controlled agents' movements and actions."""

    REPORTED = "reported"
    CONTROLLABLE = "controllable"


class Controllers(str, Enum):
    """How the commands are shared out."""

    DISTRIBUTED = "distributed"
    CENTRALIZED = "centralized"
    GENERAL = "general"


class Engine(str, Enum):
    """Which solver."""

    NATIVE = "native"
    PYTHON = "python"


class Solver(str, Enum):
    """Whose solver, instead of the built-in one."""

    VERIFYTGA = "verifytga"


class Optimize(str, Enum):
    """What the strategy is to have least of."""

    TIME = "time"


SCENARIO = typer.Argument(..., metavar="SCENARIO", help="A scenario in PuRSUE-ML, by convention *.pur.")
GAME = "SCENARIO | TGA.xml TCTL.q"
ENDS = typer.Option(
    None,
    help="Who controls the end of a controlled agent's movement or action: reported (the robot tells when it is done; "
    "the default) or controllable (the plan decides it: the original's game, and UPPAAL-TIGA's).",
)
REACTION = typer.Option(
    None, metavar="UNITS", help="How late a command may take effect, in time units: 0.1 (the default), 1/20, 0 …"
)
SLACK = typer.Option(
    [],
    metavar="[AGENT=]UNITS",
    help="A robot, or with AGENT= this one, may end so much later than the model; repeatable.",
)
REACH_OBJ = typer.Option(
    "dedicated",
    metavar="dedicated|all|ROBOT",
    help="Who gets the objective's commands: a controller of their own, all, or a robot's.",
)
SOLVER = typer.Option(
    None, help="verifytga: UPPAAL-TIGA's, where you have it, instead of the built-in one; its strategy is proven, too."
)
VERIFYTGA = typer.Option(None, metavar="PATH", help="Where that program is, if not on PATH.")
OPTIMIZE = typer.Option(
    None,
    help="time: look for the strategy with the least worst-case time to the goal, for two minutes or as --limit says; "
    "what is proven is told.",
)
EXPLAIN = typer.Option(
    True, "--explain/--no-explain", help="Where the objective cannot be met: look for what would change that."
)
LIMIT = typer.Option(0.0, metavar="SECONDS", min=0.0, help="Give up after so long (0: never).")
MEMORY = typer.Option(
    None,
    metavar="MIB",
    min=0,
    help="Give up when so much memory is in use (0: no limit); by default 4096, or 80 % of what is available.",
)
MARGIN = typer.Option(
    False,
    "--margin",
    help="Find the margin however long it takes, and the game's: the largest reaction for which it can be won at all.",
)
JSON = typer.Option(False, "--json", help="Print JSON on stdout.")
PLAN = typer.Option(None, metavar="FILE", help="Use this plan (UPPAAL-TIGA's format) instead of solving.")
CONTROLLERS = typer.Option(Controllers.DISTRIBUTED, help="As for ws.")
KEY = typer.Option(
    None, "--key", metavar="NAME|PATH", help="Sign with this key; with the only one there is by default."
)
POSES = typer.Option(
    None, metavar="FILE", help="Where the points are on the robots' map: a file like config/poses.yaml of a workspace."
)
COMPUTED_POSES = typer.Option(
    False, "--computed-poses", help="Points without a pose get a computed one: for simulated robots only."
)
KEYS = typer.Option(
    None, "--keys", metavar="DIR", help="Where the keys are; ~/.config/pursue/keys by default (XDG_CONFIG_HOME)."
)
