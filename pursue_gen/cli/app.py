"""The program: its commands, one file each, in the order of the help. What a command needs is imported when it runs."""

from __future__ import annotations

import gc
import sys
from importlib import import_module
from typing import Any, List

import typer

from pursue_gen import __version__
from pursue_gen.cli.groups import Commands
from pursue_gen.outcomes import INTERRUPTED


class _Program(Commands):
    """All commands; the module of one is imported when it is asked for, since all together take longer than many a
    solution."""

    def list_commands(self, ctx: Any) -> List[str]:
        """Their names, in the order of the help."""
        return [_name_of(module) for module, _ in COMMANDS]

    def get_command(self, ctx: Any, cmd_name: str) -> Any:
        """The command of this name, None: there is none."""
        for module, example in COMMANDS:
            if _name_of(module) == cmd_name and cmd_name not in self.commands:
                self.commands[cmd_name] = _made(module, example)
        return super().get_command(ctx, cmd_name)


app = typer.Typer(
    name="pursue-gen",
    cls=_Program,
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


COMMANDS = (
    ("cli.check", "For example: pursue-gen check my_floor.pur"),
    ("cli.survey", "For example: pursue-gen survey map.yaml my_floor.pur --radius 0.25 --speed bot1=0.4"),
    ("cli.tga", "For example: pursue-gen tga scenarios/thesis/scenario_1.pur -o uppaal"),
    (
        "cli.solve",
        "For example: pursue-gen solve my_floor.pur -o plan.txt; "
        "as UPPAAL-TIGA plays: pursue-gen solve TGA.xml TCTL.q --ends controllable --reaction 0",
    ),
    ("cli.verify", "For example: pursue-gen verify my_floor.pur plan.txt"),
    ("cli.ws", "For example: pursue-gen ws scenarios/thesis/scenario_1.pur"),
    ("cli.explain", "For example: pursue-gen explain PML110"),
    ("tools.commands.play", "For example: pursue-gen play scenarios/thesis/catch_the_thief.pur"),
    ("tools.commands.report", "For example: pursue-gen report scenarios/thesis/scenario_3.pur --html"),
    ("tools.commands.replay", "For example: pursue-gen replay mission.bag"),
    (
        "tools.commands.calibrate",
        "For example: pursue-gen calibrate my_floor.pur mission.bag drives.bag -o my_floor_calibrated.pur",
    ),
    ("tools.commands.sim", "For example: pursue-gen sim my_floor.pur --runs 10000 --faults delay,loss --jobs 4"),
    ("cli.fmt", "For example: pursue-gen fmt my_floor.pur"),
    ("tools.commands.new", "For example: pursue-gen new my_floor --kind reach --robots 2"),
    ("tools.commands.import_", "For example: pursue-gen import office.building.yaml --speed 0.7"),
    ("tools.commands.draw", "For example: pursue-gen draw map.yaml my_floor.pur"),
    ("tools.commands.examples", "For example: pursue-gen examples thesis/scenario_1"),
    ("tools.commands.replan", "For example: pursue-gen replan < request.json"),
    ("tools.commands.lsp", "For example, in an editor's settings: pursue-gen lsp"),
    ("tools.commands.keys", ""),
    ("tools.commands.bundle", "For example: pursue-gen bundle my_floor.pur --poses lab.yaml --key lab"),
    ("tools.commands.send", "For example: pursue-gen send my_floor.pur --to robots.yaml --poses lab.yaml"),
)
"""The module of each command, in which a function or a group has the command's name, and the last line of its help.

Tools stand above `cli` in the layers, so their commands are named here and not imported. This is no entry point of the
installation: a checkout on PYTHONPATH alone has all commands, too.
"""

_OBJECTS = 300_000
"""So many new objects are made between two searches for garbage: strategies are many small values without cycles."""


def main() -> None:
    """The program `pursue-gen`."""
    before = gc.get_threshold()
    gc.set_threshold(_OBJECTS)
    for stream in (sys.stdout, sys.stderr):
        if hasattr(stream, "reconfigure"):  # a terminal that cannot show a letter gets its code
            stream.reconfigure(errors="backslashreplace")
    try:
        app(prog_name="pursue-gen")
    except KeyboardInterrupt:  # before or after the command itself
        sys.exit(INTERRUPTED)
    finally:
        gc.set_threshold(*before)  # who calls this in a process of his own keeps his


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


def _name_of(module: str) -> str:
    return module.rpartition(".")[2].rstrip("_")  # `import` is a word of Python


def _made(module: str, example: str) -> Any:
    """The command, or group of commands, of a module."""
    name = _name_of(module)
    found = getattr(import_module(f"pursue_gen.{module}"), module.rpartition(".")[2])
    alone = typer.Typer(rich_markup_mode=None, add_completion=False)
    if isinstance(found, typer.Typer):
        alone.add_typer(found, name=name)
    else:
        alone.command(name, epilog=example)(found)
    return typer.main.get_group(alone).commands[name]


if __name__ == "__main__":
    main()
