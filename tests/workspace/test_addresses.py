"""Whatever of a workspace listens on a port does so on this machine only, unless somebody has said otherwise."""

from __future__ import annotations

import re
from dataclasses import replace
from typing import Dict

from worlds import REACTION, world

from pursue_gen.workspace import Options, generate
from pursue_runtime import arguments

LOOPBACK = "127.0.0.1"
OPENS = re.compile(r"\bbind(_sockets)?\(|\.listen\(|create_server\(")


def files() -> Dict[str, str]:
    """All texts of a workspace with services."""
    made = generate(*world("thesis/scenario_1"), replace(Options(reaction=REACTION), systemd=True))
    return {path: content.decode("utf-8", "replace") for path, content in made.items()}


def test_launch_files_and_services_open_ports_for_this_machine_only() -> None:
    """Arguments that name an address to listen on, and variables of services that do."""
    found = {}
    for path, text in files().items():
        for name, default in re.findall(r'<arg name="((?:\w+_)?host)" default="([^"]*)"', text):
            found[path.rsplit("/", 1)[-1], name] = default
        for name, default in re.findall(r'^(PURSUE_\w*HOST)="?([^"\s]*)', text, re.MULTILINE):
            found[path, name] = default
    assert {("robot.launch", "host"), ("robot.launch", "page_host"), ("mission.launch", "host"),
            ("communication_manager.launch", "host")} < set(found)  # fmt: skip
    assert {("systemd/pursue.env", f"PURSUE_{door}_HOST") for door in ("MISSION", "PAGE")} < set(found)
    assert set(found.values()) == {LOOPBACK}, found


def test_nodes_do_so_too_where_nobody_has_given_an_address() -> None:
    """As `rosrun` starts them. Nothing but these two listens, but for ROS itself."""
    found = {}
    for path, text in files().items():
        for default in re.findall(r"""told\["host"\] or (\w+)""", text):
            found[path.rsplit("/", 1)[-1]] = default
        if path.endswith("ui/options.py"):
            assert re.search(rf'^    host: str = "{LOOPBACK}"$', text, re.MULTILINE)
    assert found == {"communication_manager.py": "LOOPBACK", "options.py": "LOOPBACK"}
    assert arguments.LOOPBACK == LOOPBACK
    listening = {path.rsplit("/", 1)[-1] for path, text in files().items() if OPENS.search(text)}
    assert listening == {"communication_manager.py", "http_server.py", "web.py"}, listening
