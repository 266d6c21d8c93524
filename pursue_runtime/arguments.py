"""What a node is told by the one who starts it: programs, keys, files, and where it listens.

These are arguments of its process. A parameter of ROS can be set by anybody who reaches the master, and counts when the
node is started again; arguments stay as they are, and roslaunch keeps them for a node that it starts again.
"""

from __future__ import annotations

import argparse
import shlex
from typing import Any, Dict, Mapping, NamedTuple, NoReturn, Optional, Sequence

from pursue_runtime.parameters import ParameterError, whole

LOOPBACK = "127.0.0.1"

NONE = "none"
"""The value that stands in launch files for an argument that is not given."""


class Argument(NamedTuple):
    """An argument `--name METAVAR` of a node's process."""

    name: str
    metavar: str
    help: str
    default: str = ""


CONFIG = Argument("config", "FOLDER", "the folder of the data files (default: beside the package)")
KEYS = Argument("keys", "FOLDER", "the folder of the trusted keys (default: $ROS_HOME/pursue/keys)")

BAG = Argument("file", "FILE", "the bag, relative to ROS_HOME (default: in the folder of the scenario)")


class _Parser(argparse.ArgumentParser):
    def error(self, message: str) -> NoReturn:
        raise ParameterError(f"{message} (--help lists the arguments)")


def read_arguments(program: str, known: Sequence[Argument], words: Sequence[str]) -> Dict[str, str]:
    """Return the value of each known argument by its name. `words`: the command line without the program's name and
    without what is for ROS.

    Raises ParameterError for what is not known; `--help` prints the arguments, and ends the program.
    """
    parser = _Parser(prog=program, allow_abbrev=False)
    add_arguments(parser, known)
    return values(known, vars(parser.parse_args(list(words))))


def add_arguments(parser: argparse.ArgumentParser, known: Sequence[Argument]) -> None:
    """Add these arguments to a parser, which returns None for each that is not given."""
    for each in known:
        parser.add_argument(f"--{each.name}", metavar=each.metavar, type=_given, help=each.help)


def values(known: Sequence[Argument], given: Mapping[str, Optional[str]]) -> Dict[str, str]:
    """Return the value of each known argument by its name: what is given, or its default."""
    found = {each.name: given.get(each.name) for each in known}
    return {each.name: each.default if found[each.name] is None else str(found[each.name]) for each in known}


def _given(value: str) -> Optional[str]:
    return None if value == NONE else value


def ignored(known: Sequence[Argument], params: Any) -> str:
    """Return a sentence that names the arguments that somebody has set as parameters of the node; "" for none."""
    names = [each.name for each in known if isinstance(params, dict) and each.name in params]
    if not names:
        return ""
    return (
        f"ignored parameters: {', '.join(f'~{name}' for name in names)}; anybody who reaches the master can set them."
        f" Pass {', '.join(f'--{name}' for name in names)} to the process (in a launch file: <node args=...>)"
    )


def command(told: Mapping[str, str], name: str) -> str:
    """Return an argument that is a shell command, or `off`. Raises ParameterError."""
    value = told[name]
    try:
        if shlex.split(value):
            return value
        problem = "it is empty"
    except ValueError as error:
        problem = str(error)
    raise ParameterError(f"--{name} is {value!r}; expected a command, or off ({problem})")


def port(told: Mapping[str, str], name: str) -> int:
    """Return an argument that is the number of a port. Raises ParameterError."""
    try:
        return whole(told, name, 0, most=65535)
    except ParameterError as problem:
        raise ParameterError(f"-{str(problem).replace('~', '-', 1)}") from problem
