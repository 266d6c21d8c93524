"""The Python packages that the program needs. setup.py takes them from here, too."""

from __future__ import annotations

from pursue_runtime.needs import PYYAML, TRANSITIONS, Need

NEEDS = (
    Need("catkin_pkg", "0.4", "catkin_pkg", "python3-catkin-pkg"),
    Need("jinja2", "2.10.1", "jinja2", "python3-jinja2"),
    Need("lark", "1.1.5", "lark", "python3-lark"),
    PYYAML,
    TRANSITIONS,
    # typer 0.29 brought pydantic, whose import takes longer than all that a quick command does.
    Need("typer", "0.7", "typer", "python3-typer", below="0.29"),
)
