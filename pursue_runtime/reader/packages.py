"""Which packages this machine plays a part of missions with: those of the nodes that run here."""

from __future__ import annotations

from typing import Collection, Tuple

ALL = "all"
UI_NODES = ("UI", "simulator", "sim_clock", "recorder")
"""The nodes of the package UI; every other node's package is called like the node."""


def packages_here(nodes: str, installed: Collection[str]) -> Tuple[str, ...]:
    """Those of the `installed` packages whose nodes run here: `all`, or names with blanks or commas between them."""
    names = nodes.replace(",", " ").split()
    if names == [ALL]:
        return tuple(sorted(installed))
    return tuple(sorted({package_of(name) for name in names} & set(installed)))


def without_package(nodes: str, installed: Collection[str]) -> Tuple[str, ...]:
    """Return the nodes that should run here and whose package is not installed."""
    names = nodes.replace(",", " ").split()
    return tuple(name for name in names if names != [ALL] and package_of(name) not in installed)


def package_of(node: str) -> str:
    """The package of a node of the mission."""
    return "UI" if node in UI_NODES else node
