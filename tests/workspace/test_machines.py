"""machines.yaml: which machine runs which node, as roslaunch reads it; what is wrong in it is told with its place."""

from __future__ import annotations

import subprocess
import sys
import xml.etree.ElementTree as ElementTree
from dataclasses import replace
from pathlib import Path
from typing import Dict, List, Tuple

import pytest
import yaml
from hypothesis import given
from hypothesis import strategies as st
from worlds import REACTION, SCENARIOS, files, world

from pursue_gen.diagnostics import Diagnostic, PursueError
from pursue_gen.workspace import Options, generate
from pursue_gen.workspace.machines import Machine, Machines, nodes_of, parse_machines
from tests.waiting import PATIENCE

NODES = nodes_of(["controller_bot1", "controller_bot2", "controllerObj"])
GOOD = """\
format: 1
master: base.local
machines:
  base.local: {nodes: [observer, UI]}
  bot1.local: {nodes: [controller_bot1], user: ros, env_loader: /opt/pursue/env.sh}
"""


def wrong(text: str) -> List[Diagnostic]:
    with pytest.raises(PursueError) as caught:
        parse_machines(text, "machines.yaml", NODES)
    assert caught.value.exit_status == 2
    return list(caught.value.diagnostics)


def place(finding: Diagnostic) -> Tuple[str, int, int]:
    assert finding.span is not None
    return finding.code, finding.span.line, finding.span.column


def launched(generated: Dict[str, bytes]) -> Dict[str, Dict[str, str]]:
    (text,) = [text for path, text in generated.items() if path.endswith("launch/machines.launch")]
    return {machine.attrib["name"]: dict(machine.attrib) for machine in ElementTree.fromstring(text).iter("machine")}


def test_nodes_go_where_the_file_says_and_the_rest_to_the_master() -> None:
    machines, (finding,) = parse_machines(GOOD, "machines.yaml", NODES)
    assert machines.of("UI").host == "base.local"
    assert machines.of("controller_bot1") == Machine("bot1.local", ("controller_bot1",), "ros", "/opt/pursue/env.sh")
    assert {machines.of(node).host for node in NODES if node != "controller_bot1"} == {"base.local"}
    assert (
        finding.code == "TRN043" and "stay on base.local: controller_bot2, controllerObj, s" in finding.message
    )


def test_without_a_master_the_rest_stays_where_it_is_launched() -> None:
    machines, (finding,) = parse_machines("format: 1\nmachines: {b: {nodes: [UI]}}", "m", NODES)
    assert machines.of("observer").host == "localhost" and "the machine that launches" in finding.message


def test_who_says_everything_is_reported_nothing() -> None:
    text = f"format: 1\nmachines: {{b: {{nodes: [{', '.join(NODES)}]}}}}"
    assert parse_machines(text, "m", NODES)[1] == ()


@pytest.mark.parametrize(
    ("text", "found", "hint"),
    [
        (GOOD.replace("[observer, UI]", "[observer, IU]"), ("TRN041", 4, 34), "did you mean UI?"),
        (GOOD.replace("[observer, UI]", "[observer, zzz]"), ("TRN041", 4, 34), "the nodes are observer, "),
        (GOOD.replace("[controller_bot1]", "[controller_bot1, UI]"), ("TRN042", 5, 41), "once"),
        (GOOD.replace("bot1.local:", "base.local:"), ("TRN042", 5, 3), "one"),
        (GOOD.replace("user:", "usr:"), ("TRN040", 5, 42), "did you mean user?"),
        (GOOD.replace("user: ros", "user: 'a b'"), ("TRN040", 5, 48), "a user"),
        (GOOD.replace("/opt/pursue/env.sh", "/opt/x; rm -rf /"), ("TRN040", 5, 65), "a path without blanks"),
        (GOOD.replace("base.local\n", "http://base.local\n"), ("TRN040", 2, 9), "a host name"),
        (GOOD.replace("  bot1.local", "  -bot1"), ("TRN040", 5, 3), "a host name"),
        (GOOD.replace("[observer, UI]", "observer"), ("TRN040", 4, 23), "[observer, UI]"),
        (GOOD.replace("format: 1", "format: 2"), ("TRN040", 1, 9), "format: 1"),
        (GOOD.replace("format: 1\n", ""), ("TRN040", 1, 1), "on top"),
        ("format: 1\nmaster: b\n", ("TRN040", 1, 1), "machines:"),
        ("format: 1\nmachines: 3\n", ("TRN040", 2, 11), "name: value"),
        ("format: 1\nmachines: {b: {user: x}}\n", ("TRN040", 2, 15), "nodes"),
        ("a: [\n", ("TRN040", 2, 1), "for example"),
        ("", ("TRN040", 1, 1), "format: 1"),
    ],
)
def test_what_is_wrong_is_reported_with_place_and_a_way_out(text: str, found: Tuple[str, int, int], hint: str) -> None:
    (finding,) = wrong(text)
    assert place(finding) == found
    assert hint in finding.hint


def test_everything_that_is_wrong_is_reported_at_once_in_order() -> None:
    text = GOOD.replace("observer", "observr").replace("user", "usr").replace("base.local\n", "-x\n")
    assert [place(finding)[1] for finding in wrong(text)] == [2, 4, 5]


disturbed = st.builds(lambda a, b: GOOD[:a] + b + GOOD[a:], st.integers(0, 150), st.text(max_size=9))


@given(st.one_of(st.text(max_size=200), disturbed))
def test_any_text_is_read_or_refused(text: str) -> None:
    try:
        machines, _ = parse_machines(text, "machines.yaml", NODES)
    except PursueError as problem:
        assert all(finding.span is not None and finding.hint for finding in problem.diagnostics)
    else:
        placed = [node for machine in machines.machines for node in machine.nodes]
        assert len(set(placed)) == len(placed) and set(placed) <= set(NODES)


hosts = st.from_regex(r"[a-z0-9]([a-z0-9-]{0,8}[a-z0-9])?(\.[a-z0-9]{1,5})?", fullmatch=True)


@given(st.dictionaries(hosts, st.lists(st.sampled_from(NODES), unique=True), min_size=1, max_size=4))
def test_what_is_written_is_read(wanted: Dict[str, List[str]]) -> None:
    seen: List[str] = []
    for host, nodes in wanted.items():
        wanted[host] = [node for node in nodes if node not in seen]
        seen += wanted[host]
    text = yaml.safe_dump({"format": 1, "machines": {host: {"nodes": nodes} for host, nodes in wanted.items()}})
    machines, _ = parse_machines(text, "m", NODES)
    assert {machine.host: list(machine.nodes) for machine in machines.machines} == wanted


def test_every_node_of_the_launch_file_has_a_machine() -> None:
    generated = files("thesis/scenario_1")
    (text,) = [text for path, text in generated.items() if path.endswith("launch/mission.launch")]
    asked = {node.attrib.get("machine") for node in ElementTree.fromstring(text).iter("node")} - {None}
    machines = launched(generated)
    assert asked == set(machines) == set(NODES)
    assert {machine["address"] for machine in machines.values()} == {"localhost"}


def test_the_launch_file_has_the_machines_that_were_asked_for() -> None:
    machines, _ = parse_machines(GOOD, "machines.yaml", NODES)
    generated = generate(*world("thesis/scenario_1"), replace(Options(reaction=REACTION), machines=machines))
    found = launched(generated)
    loader = {"name": "controller_bot1", "address": "bot1.local", "user": "ros", "env-loader": "/opt/pursue/env.sh"}
    assert found["controller_bot1"] == loader
    assert found["simulator"] == {"name": "simulator", "address": "base.local"}


def test_roslaunch_takes_them(tmp_path: Path) -> None:
    pytest.importorskip("roslaunch", reason="roslaunch is not installed")
    machines = Machines("127.0.0.1", (Machine("127.0.0.2", ("observer",), "ros", "/opt/pursue/env.sh"),))
    generated = generate(*world("thesis/scenario_1"), Options(reaction=REACTION, machines=machines))
    (text,) = [text for path, text in generated.items() if path.endswith("launch/machines.launch")]
    file = tmp_path / "machines.launch"
    file.write_bytes(text)
    script = (
        "import sys, roslaunch.config as c\n"
        "m = c.load_config_default([sys.argv[1]], None, verbose=False).machines\n"
        "print(sorted((n, x.address, x.user, x.env_loader) for n, x in m.items() if n in ('observer', 'UI')))\n"
    )
    environment = {"PATH": "/usr/bin:/bin", "HOME": str(tmp_path), "ROS_MASTER_URI": "http://localhost:1"}
    words = [sys.executable, "-c", script, str(file)]
    done = subprocess.run(words, capture_output=True, text=True, env=environment, timeout=PATIENCE, check=False)
    assert "('observer', '127.0.0.2', 'ros', '/opt/pursue/env.sh')" in done.stdout, done.stderr
    assert "('UI', '127.0.0.1', None" in done.stdout


def test_the_command_tells_what_has_no_machine_and_writes_nothing_where_the_file_is_wrong(tmp_path: Path) -> None:
    file = tmp_path / "machines.yaml"
    file.write_text(GOOD, encoding="utf-8")
    words = [sys.executable, "-m", "pursue_gen", "ws", str(SCENARIOS / "thesis/scenario_1.pur")]
    words += ["--machines", str(file), "-o", str(tmp_path / "ws")]
    done = subprocess.run(words, capture_output=True, text=True, timeout=2 * PATIENCE, check=False)
    assert done.returncode == 0 and "TRN043" in done.stderr
    file.write_text(GOOD.replace("UI", "IU"), encoding="utf-8")
    words[-1] = str(tmp_path / "other")
    done = subprocess.run(words, capture_output=True, text=True, timeout=2 * PATIENCE, check=False)
    assert done.returncode == 2 and f"{file}:4:34: error TRN041" in done.stderr
    assert not (tmp_path / "other").exists()
