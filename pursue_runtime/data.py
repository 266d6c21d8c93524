"""The data files of a generated package: where they are, and how they are read."""

from __future__ import annotations

import contextlib
import os
from typing import Any, Dict, Iterator, NamedTuple

from pursue_runtime import __version__
from pursue_runtime.bounded import DATA, BadText, read_yaml
from pursue_runtime.named_files import read_start

FORMAT = 1
"""The format of data files that this run time reads."""

NEWEST = {"cover.yaml": 4, "model.yaml": 7, "people.yaml": 2, "poses.yaml": 6, "strategy.yaml": 2}
"""The newest format of those files of which it reads several, from FORMAT on."""


class Package(NamedTuple):
    """The generated package whose node runs: its name, the scenario it was made from, the path of the node's script."""

    name: str
    scenario: str
    script: str


class DataError(Exception):
    """A data file or a text in it cannot be used; the message says which, and why."""


@contextlib.contextmanager
def reading(what: str, where: str = "") -> Iterator[None]:
    """Read the parts of data in the body: DataError is raised, and names them (`what`, and `where` in that), if one is
    missing or of another kind."""
    try:
        yield
    except (LookupError, TypeError, ValueError, AttributeError, ArithmeticError) as problem:
        place = f" in {where}" if where else ""
        raise DataError(f"{what} lacks or misspells something{place}: {problem!r}") from problem


def read_data(path: str) -> Dict[str, Any]:
    """The content of one of the package's YAML files. Raises DataError."""
    try:
        content = read_start(path, DATA.size)
    except OSError as problem:
        raise DataError(f"cannot read {path}: {problem}") from problem
    return parse_data(content, path)


def parse_data(content: bytes, path: str) -> Dict[str, Any]:
    """What is in a YAML file of ours; `path` says in messages which one it is. Raises DataError."""
    try:
        data = read_yaml(content)
    except BadText as problem:
        raise DataError(f"cannot read {path}: {problem}") from problem
    return check_format(data, path, NEWEST.get(os.path.basename(path), FORMAT))


def check_format(data: object, what: str, newest: int = FORMAT) -> Dict[str, Any]:
    """Return the data if this run time reads their format, FORMAT to `newest`; `what` names them in messages.

    Raises DataError.
    """
    found = data.get("format") if isinstance(data, dict) else None
    if isinstance(data, dict) and type(found) is int and FORMAT <= found <= newest:
        return data
    reads = f"pursue_runtime {__version__} reads format {newest}"
    if isinstance(found, int) and found > newest:
        raise DataError(
            f"{what} has format {found}, and {reads}: put the packages pursue_runtime and pursue_msgs of the workspace "
            "that it was generated with on this machine, and build them"
        )
    raise DataError(f"{what} is not a data file of format {newest} ({reads}): generate the workspace again")


def data_file(package: Package, name: str, config: str = "") -> str:
    """The path of a data file: in the folder `config` if given, else beside scripts/ (source and devel space) or in
    share/<package>/config (install space, where the script is in lib/<package>). Raises DataError if there is none."""
    here = os.path.dirname(os.path.realpath(package.script))
    beside = os.path.join(here, "..", "config")
    installed = os.path.join(here, "..", "..", "share", package.name, "config")
    folders = [config] if config else [beside, installed]
    for folder in folders:
        path = os.path.normpath(os.path.join(folder, name))
        if os.path.isfile(path):
            return path
    places = " nor in ".join(os.path.normpath(folder) for folder in folders)
    raise DataError(f"no {name} in {places}; pass its folder as --config")
