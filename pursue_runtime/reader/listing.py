"""Lists the missions that this machine keeps: `rosrun pursue_reader missions`. Changes nothing, needs no master."""

from __future__ import annotations

import os
import sys

from pursue_runtime.data import Package
from pursue_runtime.folders import missions_folder
from pursue_runtime.reader.contents import StoreError, table


def main(package: Package) -> int:
    """Prints the list; returns the exit status."""
    folder = missions_folder(os.environ)
    try:
        rows = table(folder, package.scenario)
    except StoreError as problem:
        print(f"missions: {problem}", file=sys.stderr)
        return 1
    print(f"missions in {folder}:")
    for row in (("mission", "scenario", "what it is"), *rows):
        print("  {:<14}{:<24}{}".format(*row))
    return 0
