"""The command `play`."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING, Optional

import typer

from pursue_gen.cli.console import guarded
from pursue_gen.cli.options import REQUEST, SCENARIO, choice, with_request
from pursue_gen.diagnostics import usage_error
from pursue_gen.tools.authoring.dialog import LONGEST_LINE

if TYPE_CHECKING:
    from pursue_gen.solving.request import SolveRequest

_PROMPT = "> "


@guarded
@with_request("ends", "reaction", "slack", "limit", "memory")
def play(
    scenario: Path = SCENARIO,
    side: Optional[str] = choice(
        "side",
        None,
        "Whom you play: world (everybody but the robots, where the objective can be met) or robots (where it cannot). "
        "By default what fits.",
        "--as",
    ),
    seed: int = typer.Option(1, metavar="S", min=0, help="For what is drawn: when movements end that you leave alone."),
    request: SolveRequest = REQUEST,
) -> None:
    """Play a scenario step by step: the others against the strategy; or the robots, where these cannot win.

    Commands are read from stdin, with or without a terminal; help lists them. The exit status is 0.
    """
    from pursue_gen import api
    from pursue_gen.cli.inputs import naming_costs, settled
    from pursue_gen.cli.progress import progress_line
    from pursue_gen.tools.play.counter import CounterPlay
    from pursue_gen.tools.play.session import answer, farewell, opening, session_of

    read = settled(api.read(scenario), request)
    rules = request.rules(api.game(read)[0])
    with naming_costs(read, request), progress_line() as progress:
        session = session_of(read, rules, seed, request.options.limits, progress)
    is_robots = isinstance(session.game, CounterPlay)
    if side is not None and (side == "robots") != is_robots:
        can, whom = ("cannot", "robots") if is_robots else ("can", "others")
        message = f"with these rules the objective {can} be met, so you can only play the {whom}"
        raise usage_error(message, f"leave out --as {side}, or change the rules")
    print("\n".join(opening(session)), flush=True)
    interactive = sys.stdin.isatty()
    while True:
        if interactive:
            print(_PROMPT, end="", flush=True)
        try:
            line = sys.stdin.readline(LONGEST_LINE)
        except KeyboardInterrupt:
            line = ""
        if len(line) == LONGEST_LINE:
            raise usage_error("what was typed is no command: its line does not end", "type help for a list of commands")
        if not line:
            if not session.play.over:  # else the table has been printed
                print(("\n" if interactive else "") + farewell(session))
            return
        if not interactive:
            print(f"{_PROMPT}{line.strip()}")
        reply = answer(session, line)
        session = reply.session
        print("\n".join(reply.lines), flush=True)
        if reply.over:
            return
