"""The program: its commands, one file each, in the order of the help. What a command needs is imported when it runs."""

from __future__ import annotations

import gc
import sys

import typer

from pursue_gen import __version__
from pursue_gen.cli.bundle import bundle
from pursue_gen.cli.calibrate import calibrate
from pursue_gen.cli.check import check
from pursue_gen.cli.draw import draw
from pursue_gen.cli.examples import examples
from pursue_gen.cli.explain import explain
from pursue_gen.cli.fmt import fmt
from pursue_gen.cli.groups import Commands
from pursue_gen.cli.keys import keys
from pursue_gen.cli.lsp import lsp
from pursue_gen.cli.new import new
from pursue_gen.cli.play import play
from pursue_gen.cli.replan import replan
from pursue_gen.cli.replay import replay
from pursue_gen.cli.report import report
from pursue_gen.cli.send import send
from pursue_gen.cli.sim import sim
from pursue_gen.cli.solve import solve
from pursue_gen.cli.survey import survey
from pursue_gen.cli.tga import tga
from pursue_gen.cli.verify import verify
from pursue_gen.cli.ws import ws
from pursue_gen.outcomes import INTERRUPTED

app = typer.Typer(
    name="pursue-gen",
    cls=Commands,
    rich_markup_mode=None,
    pretty_exceptions_enable=False,
    no_args_is_help=True,
    context_settings={"help_option_names": ["-h", "--help"]},
    help="From a scenario in PuRSUE-ML to a ROS 1 workspace with one proven controller per robot.",
    epilog="Data goes to stdout, everything else to stderr. Exit status: 0 well; 2 the command line or a file is "
    "wrong; 3 the scenario has errors; 4 the objective cannot be met, or a plan does not win; 5 a limit was hit; 6 "
    "something that is needed is missing; 7 robots could not be reached or refused, and nothing has changed; 8 the "
    "robots differ; 130 interrupted.",
)


_OBJECTS = 300_000
"""So many new objects are made between two searches for garbage: strategies are many small values without cycles."""


def main() -> None:
    """The program `pursue-gen`."""
    gc.set_threshold(_OBJECTS)
    for stream in (sys.stdout, sys.stderr):
        if hasattr(stream, "reconfigure"):  # a terminal that cannot show a letter gets its code
            stream.reconfigure(errors="backslashreplace")
    try:
        app(prog_name="pursue-gen")
    except KeyboardInterrupt:  # before or after the command itself
        sys.exit(INTERRUPTED)


def _version(wanted: bool) -> None:
    if wanted:
        print(f"pursue-gen {__version__}")
        raise typer.Exit()


@app.callback()
def _options(
    version: bool = typer.Option(
        False, "--version", callback=_version, is_eager=True, help="Print the version and exit."
    ),
) -> None:
    pass


app.command(epilog="For example: pursue-gen check my_floor.pur")(check)
app.command(epilog="For example: pursue-gen survey map.yaml my_floor.pur --radius 0.25 --speed bot1=0.4")(survey)
app.command(epilog="For example: pursue-gen tga scenarios/thesis/scenario_1.pur -o uppaal")(tga)
app.command(
    epilog="For example: pursue-gen solve my_floor.pur -o plan.txt; "
    "as UPPAAL-TIGA plays: pursue-gen solve TGA.xml TCTL.q --ends controllable --reaction 0"
)(solve)
app.command(epilog="For example: pursue-gen verify my_floor.pur plan.txt")(verify)
app.command(epilog="For example: pursue-gen ws scenarios/thesis/scenario_1.pur")(ws)
app.command(epilog="For example: pursue-gen explain PML110")(explain)
app.command(epilog="For example: pursue-gen play scenarios/thesis/catch_the_thief.pur")(play)
app.command(epilog="For example: pursue-gen report scenarios/thesis/scenario_3.pur --html")(report)
app.command(epilog="For example: pursue-gen replay mission.bag")(replay)
app.command(epilog="For example: pursue-gen calibrate my_floor.pur mission.bag drives.bag -o my_floor_calibrated.pur")(
    calibrate
)
app.command(epilog="For example: pursue-gen sim my_floor.pur --runs 10000 --faults delay,loss --jobs 4")(sim)
app.command(epilog="For example: pursue-gen fmt my_floor.pur")(fmt)
app.command(epilog="For example: pursue-gen new my_floor --kind reach --robots 2")(new)
app.command(epilog="For example: pursue-gen draw map.yaml my_floor.pur")(draw)
app.command(epilog="For example: pursue-gen examples thesis/scenario_1")(examples)
app.command(epilog="For example: pursue-gen replan < request.json")(replan)
app.command(epilog="For example, in an editor's settings: pursue-gen lsp")(lsp)
app.add_typer(keys, name="keys")
app.command(epilog="For example: pursue-gen bundle my_floor.pur --poses lab.yaml --key lab")(bundle)
app.command(epilog="For example: pursue-gen send my_floor.pur --to robots.yaml --poses lab.yaml")(send)


if __name__ == "__main__":
    main()
