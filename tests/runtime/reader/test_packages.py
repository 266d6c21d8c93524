"""A reader says which packages play a part of missions on its machine: those of the nodes that run there."""

from __future__ import annotations

from typing import Tuple

import pytest

from pursue_gen.workspace.machines import UI_NODES
from pursue_runtime.reader import packages as reader_nodes
from pursue_runtime.reader.packages import packages_here, without_package

INSTALLED = ("observer", "UI", "controller_bot1", "controller_bot2", "controllerObj")


@pytest.mark.parametrize(
    ("nodes", "expected", "nowhere"),
    [
        ("all", tuple(sorted(INSTALLED)), ()),
        (" all ", tuple(sorted(INSTALLED)), ()),
        ("controller_bot1", ("controller_bot1",), ()),
        ("observer, UI controllerObj", ("UI", "controllerObj", "observer"), ()),
        ("observer,UI,simulator,recorder,sim_clock", ("UI", "observer"), ()),
        ("recorder", ("UI",), ()),
        ("controller_bot", (), ("controller_bot",)),
        ("observer controller_bot3", ("observer",), ("controller_bot3",)),
        ("", (), ()),
    ],
)
def test_packages_are_those_of_the_nodes_that_run_here(
    nodes: str, expected: Tuple[str, ...], nowhere: Tuple[str, ...]
) -> None:
    assert packages_here(nodes, INSTALLED) == expected
    assert without_package(nodes, INSTALLED) == nowhere


def test_what_is_not_installed_does_not_count() -> None:
    assert packages_here("observer UI", ("UI",)) == ("UI",)
    assert packages_here("all", ()) == ()


def test_nodes_of_the_package_ui_are_those_that_the_desk_knows() -> None:
    assert reader_nodes.UI_NODES == UI_NODES
