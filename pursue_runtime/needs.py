"""The Python packages that missions need, with the oldest versions that do: what is missing or too old is said at once.

Ubuntu 20.04 has all of these versions. Nothing but Python's own library is imported here.
"""

from __future__ import annotations

import importlib
import importlib.util
import os
import re
import sys
from typing import NamedTuple, Optional, Sequence, Tuple


class Need(NamedTuple):
    """A package of the Python package index, the module that it is imported as, and how Debian and Ubuntu call it."""

    name: str
    oldest: str
    """The oldest version that does."""
    module: str
    debian: str
    below: str = ""
    """The first version that is too new; "" if none is known. It limits what is installed, not what is used."""

    @property
    def requirement(self) -> str:
        """As pip and setuptools write it."""
        return f"{self.name}>={self.oldest}" + (f",<{self.below}" if self.below else "")


PYYAML = Need("PyYAML", "5.3", "yaml", "python3-yaml")
TRANSITIONS = Need("transitions", "0.7", "transitions", "python3-transitions")
TORNADO = Need("tornado", "6.0", "tornado", "python3-tornado")


class NeedError(ImportError):
    """Packages are missing or too old: the text has the versions, `hint` is what to do."""

    def __init__(self, short: Sequence[Tuple[Need, Optional[str]]]) -> None:
        """`short`: each package with the version that was found; None where it is missing."""
        super().__init__("; ".join(_told(need, found) for need, found in short))
        quoted = " ".join(f"'{need.requirement}'" for need, _ in short)
        self.hint = f"{sys.executable} -m pip install {quoted}"
        if all(found is None for _, found in short):
            self.hint += f" (Debian 12: sudo apt install {' '.join(need.debian for need, _ in short)})"


def require(*needs: Need) -> None:
    """Does nothing where all packages are here and new enough; raises NeedError otherwise."""
    short = [(need, found) for need, found in zip(needs, map(found_version, needs)) if not _does(need, found)]
    if short:
        raise NeedError(short)


def found_version(need: Need) -> Optional[str]:
    """The version that this Python would import: "" where the package does not tell it, None where it is missing."""
    if importlib.util.find_spec(need.module) is None:
        return None
    named = _named_version(need.name)
    if named:
        return named
    from importlib import metadata  # costs more than all else here

    try:
        return metadata.version(need.name) or ""
    except metadata.PackageNotFoundError:  # the module is of a package of another name, such as lark-parser
        return str(getattr(importlib.import_module(need.module), "__version__", ""))


def _named_version(package: str) -> str:
    """The version in the name of the folder that tells of a package (jinja2-3.1.2.dist-info); "" where there is not one
    such folder."""
    called = re.compile(re.sub(r"[-_.]+", "[-_.]+", package) + r"-(\d[^-]*)(-py\d[\d.]*)?\.(dist|egg)-info", re.I)
    for folder in sys.path:
        try:
            found = [match for match in map(called.fullmatch, os.listdir(folder or ".")) if match]
        except OSError:  # an archive, or nothing
            continue
        if found:
            return found[0][1] if len(found) == 1 else ""
    return ""


def _does(need: Need, found: Optional[str]) -> bool:
    return found is not None and (not _numbers(found) or _numbers(found) >= _numbers(need.oldest))


def _numbers(version: str) -> Tuple[int, ...]:
    """The numbers at the beginning of a version, without zeros at the end: those of 6.0rc1 are those of 6."""
    start = re.match(r"\d+(\.\d+)*", version)
    numbers = [int(number) for number in start[0].split(".")] if start else []
    while numbers and not numbers[-1]:
        numbers.pop()
    return tuple(numbers)


def _told(need: Need, found: Optional[str]) -> str:
    what = "is missing" if found is None else f"{found} is too old"
    return f"{need.name} {what} ({need.oldest} or newer is needed)"
