"""What the other functions are asked for: rules of the game, who commands what, limits."""

from __future__ import annotations

import math
from fractions import Fraction
from pathlib import Path
from typing import TYPE_CHECKING, Iterable, Mapping, Optional, Union

from pursue_gen.diagnostics import usage_error

if TYPE_CHECKING:
    from pursue_gen.solving.request import SolveRequest

File = Union[str, Path]


def request(
    *,
    ends: Optional[str] = None,
    reaction: Union[str, float, Fraction, None] = None,
    slack: Union[Mapping[str, int], Iterable[str]] = (),
    within: Union[str, float, Fraction, None] = None,
    optimize: Optional[str] = None,
    controllers: str = "distributed",
    reach_obj: str = "dedicated",
    plan: Optional[File] = None,
    seconds: Optional[float] = None,
    memory: Optional[int] = None,
    work: int = 0,
    whole: bool = False,
    solver: Optional[str] = None,
    verifytga: Optional[File] = None,
) -> SolveRequest:
    """What `solve`, `simulate` and `write_workspace` are asked for; by default what the commands do by default.

    The game: `ends` "reported" (robots report them) or "controllable" (the original's game), `reaction` (time units:
    how late a command may take effect, 0.1 by default), `slack` (agent → time units: how much later than the model it
    may end). `within`: the goal has to be reached in so many time units; `optimize`: "time" for the least worst-case
    time, "none" for the first strategy found. `controllers` ("distributed", "centralized", "general") and `reach_obj`
    ("dedicated", "all", a robot): who commands what. `plan`: a file with a plan to use instead of solving.

    Limits: `seconds` of processor time (60 by default, 0: none), `memory` of the process in MiB (0: none; by
    default 1024 beside what it holds already, or 80 % of what there is), `work` of a game in one piece (0: no limit):
    the same everywhere.
    `whole`, `solver`, `verifytga`: as the command line has them. Raises PursueError for what has no meaning.

    >>> request(reaction=0.05, slack={"bot1": 2}, seconds=10).slack
    ('bot1=2',)
    """
    from pursue_gen.solving.options import SolveOptions
    from pursue_gen.solving.request import SolveRequest
    from pursue_gen.synthesis.limits import DEFAULT_SECONDS, Limits, careful_memory

    check_words(ends=ends, optimize=optimize, controllers=controllers, solver=solver)
    for name, number in {"seconds": seconds, "memory": memory, "work": work}.items():
        if number is not None and not 0 <= number < math.inf:
            raise usage_error(f"{name} is {number}", "expected a number, 0 for no limit")
    memory = careful_memory() if memory is None else memory
    limits = Limits(DEFAULT_SECONDS, memory, by_default=True) if seconds is None else Limits(seconds, memory)
    path = None if verifytga is None else Path(verifytga)
    how = SolveOptions(limits, optimize=optimize, whole=whole, solver=solver, verifytga=path, most_work=work)
    late = tuple(f"{agent}={units}" for agent, units in slack.items()) if isinstance(slack, Mapping) else tuple(slack)
    times = (None if time is None else str(time) for time in (reaction, within))
    file = None if plan is None else Path(plan)
    return SolveRequest(controllers, reach_obj, ends, next(times), late, next(times), file, how)


_WORDS = {
    "ends": ("reported", "controllable"),
    "optimize": ("time", "none"),
    "controllers": ("distributed", "centralized", "general"),
    "solver": ("verifytga",),
    "opponent": ("random", "worst", "still", "mixed"),
}


def check_words(**values: Optional[str]) -> None:
    """Raises PursueError for what is none of the words that there are."""
    for name, value in values.items():
        if value is not None and value not in _WORDS[name]:
            raise usage_error(f"{name} is {value!r}", f"expected one of {', '.join(_WORDS[name])}")


def default_request() -> SolveRequest:
    """What is asked for where nobody says anything."""
    return request()
