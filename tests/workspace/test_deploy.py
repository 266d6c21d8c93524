"""Containers and services of a workspace: the files are what Docker, compose, systemd and their linters take, and say
for each node what it needs; the images' steps really work (with PURSUE_LONG_TESTS=1)."""

from __future__ import annotations

import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
from dataclasses import replace
from pathlib import Path
from typing import Any, Dict, List, Set

import pytest
import yaml
from debian_image import instructions, interpolated
from hypothesis import given
from hypothesis import strategies as st
from worlds import REACTION, world

from pursue_gen.diagnostics import PursueError
from pursue_gen.workspace import Options, generate, write_tree
from pursue_gen.workspace.deploy import DEBIAN_PACKAGES, service_names
from pursue_gen.workspace.machines import Machine, Machines
from pursue_gen.workspace.packages import SHARED
from tests.waiting import PATIENCE

OPTIONS = Options(reaction=REACTION, docker=True, systemd=True)
CONTROLLERS = {"controller_polBot1", "controller_polBot2", "controllerObj"}


@pytest.fixture(scope="module")
def generated() -> Dict[str, bytes]:
    return generate(*world("thesis/catch_the_thief"), OPTIONS)


@pytest.fixture(scope="module")
def workspace(generated: Dict[str, bytes], tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("deploy") / "ws"
    write_tree(generated, folder)
    return folder


@pytest.fixture(scope="module")
def compose(generated: Dict[str, bytes]) -> Dict[str, Any]:
    found = yaml.safe_load(generated["docker/compose.yaml"])
    assert isinstance(found, dict)
    return found


def tool(name: str) -> str:
    """A program of the virtual environment, or of the system."""
    found = shutil.which(name, path=f"{Path(sys.executable).parent}:{os.environ.get('PATH', '')}")
    if found is None:
        pytest.skip(f"{name} is not installed")
    return found


def run(words: List[str], folder: Path, **more: str) -> "subprocess.CompletedProcess[str]":
    environment = {"PATH": "/usr/bin:/bin", "HOME": str(folder), "LANG": "C.UTF-8", **more}
    return subprocess.run(
        words,
        cwd=folder,
        env=environment,
        capture_output=True,
        text=True,
        timeout=2 * PATIENCE,
        check=False,
        stdin=subprocess.DEVNULL,
    )


# Docker ---------------------------------------------------------------------------------------------------------------


def test_only_who_asks_gets_them(generated: Dict[str, bytes]) -> None:
    without = generate(*world("thesis/catch_the_thief"), Options(reaction=REACTION))
    more = {path for path in generated if path not in without}
    assert {path.split("/")[0] for path in more} == {"docker", "systemd"}
    assert {path for path in without if without[path] != generated[path]} == {"README.md"}


def test_they_are_always_the_same_and_edits_are_kept(generated: Dict[str, bytes], tmp_path: Path) -> None:
    assert generate(*world("thesis/catch_the_thief"), OPTIONS) == generated
    write_tree(generated, tmp_path / "ws")
    (tmp_path / "ws/docker/compose.yaml").write_text("mine", encoding="utf-8")
    with pytest.raises(PursueError, match="compose.yaml"):
        write_tree(generated, tmp_path / "ws")


def test_the_compose_file_fits_the_specification(workspace: Path) -> None:
    pytest.importorskip("check_jsonschema", reason="check-jsonschema is not installed")
    words = [sys.executable, "-m", "check_jsonschema", "--builtin-schema", "vendor.compose-spec"]
    done = run([*words, str(workspace / "docker/compose.yaml")], workspace)
    if "is not one of" in done.stderr:
        pytest.skip("this check-jsonschema does not know the specification: those for Python 3.8 do not")
    assert done.returncode == 0, done.stdout + done.stderr
    broken = workspace / "broken.yaml"
    broken.write_text((workspace / "docker/compose.yaml").read_text().replace("hostname:", "hostnam:"))
    assert run([*words, str(broken)], workspace).returncode == 1


def test_debians_docker_compose_takes_it(workspace: Path) -> None:
    program = tool("docker-compose")
    plain = run([program, "-f", "docker/compose.yaml", "config", "--services"], workspace)
    assert plain.returncode == 0, plain.stderr
    assert "controllerobj" in plain.stdout.split()
    lab = run([program, "-f", "docker/compose.yaml", "--env-file", "docker/lab.env", "config"], workspace)
    assert lab.returncode == 0, lab.stderr
    services = yaml.safe_load(lab.stdout)["services"]
    assert "_again:=true" in services["observer"]["command"] and "base-pursue-reader" in services


@pytest.mark.parametrize("name", ["Dockerfile.debian", "Dockerfile.noetic"])
def test_dockerfiles_please_the_linter(workspace: Path, name: str) -> None:
    done = run([tool("hadolint"), "--no-color", f"docker/{name}"], workspace)
    assert (done.returncode, done.stdout) == (0, ""), done.stdout + done.stderr


@pytest.mark.parametrize("name", ["Dockerfile.debian", "Dockerfile.noetic"])
def test_what_is_copied_is_there_and_nobody_is_root(generated: Dict[str, bytes], name: str) -> None:
    steps = instructions(generated[f"docker/{name}"].decode())
    copied = [rest.split()[0] for word, rest in steps if word == "COPY" and not rest.startswith("--from")]
    assert sorted(copied) == sorted({path.split("/")[1] for path in generated if path.startswith("src/")})
    assert steps[-3] == ("USER", "1000:1000")
    assert {rest.split()[0] for word, rest in steps if word == "FROM"} <= {"debian:12", "ros:noetic-ros-base", "ros"}


def test_every_service_builds_from_files_that_are_there(workspace: Path, compose: Dict[str, Any]) -> None:
    for variables in ({}, {"PURSUE_ROS": "noetic"}):
        for service in interpolated(compose["services"], variables).values():
            context = workspace / "docker" / service["build"]["context"]
            assert (context / service["build"]["dockerfile"]).is_file()
            for package in service["build"]["args"]["PACKAGES"].split(";"):
                assert (context / package / "package.xml").is_file()


def test_one_container_for_each_node_with_its_own_package(compose: Dict[str, Any]) -> None:
    services = {name: service for name, service in compose["services"].items() if "profiles" not in service}
    assert set(services) == {
        "master",
        "observer",
        "controller-polbot1",
        "controller-polbot2",
        "controllerobj",
        "ui",
        "simulator",
    }
    nodes = {tuple(service["command"][1:3]) for name, service in services.items() if name != "master"}
    assert nodes == {(name, name) for name in CONTROLLERS | {"observer", "UI"}} | {("UI", "simulator")}
    for name, service in services.items():
        if name != "master":
            assert service["build"]["args"]["PACKAGES"].split(";") == [*SHARED, service["command"][1]]
            assert service["depends_on"] == {"master": {"condition": "service_healthy"}}
            assert service["healthcheck"]["test"][-1] == "/" + service["command"][2]


def test_containers_find_each_other_and_keep_what_they_learn(compose: Dict[str, Any]) -> None:
    assert compose["networks"] == {"pursue": {"name": "pursue"}}
    for name, service in compose["services"].items():
        assert re.fullmatch(r"[a-z0-9]([a-z0-9-]{0,61}[a-z0-9])?", name)
        assert service["environment"] == {"ROS_MASTER_URI": "http://master:11311", "ROS_HOSTNAME": name}
        assert (service["hostname"], service["networks"]) == (name, ["pursue"])
        volume, target = service["volumes"][0].split(":")
        assert volume in compose["volumes"] and target == "/var/lib/pursue"
        assert service["init"] and service["read_only"] and service["cap_drop"] == ["ALL"] and service["healthcheck"]
    volumes = {name: service["volumes"][0] for name, service in compose["services"].items()}
    assert volumes["observer"] == volumes["ui"] == volumes["simulator"] == volumes["base-pursue-reader"]
    assert len({volumes[name] for name in ("observer", "controller-polbot1", "controllerobj", "master")}) == 4


def test_ports_are_open_on_loopback_only_and_missions_arrive_in_the_lab_only(
    compose: Dict[str, Any], workspace: Path
) -> None:
    services = interpolated(compose["services"], {})
    ports = {name: service["ports"] for name, service in services.items() if "ports" in service}
    assert all(port.startswith("127.0.0.1:") for there in ports.values() for port in there)
    assert ports.pop("ui") == ["127.0.0.1:8080:8080"]
    assert all(
        services[name]["profiles"] == ["lab"] and services[name]["command"][1] == "communication_manager"
        for name in ports
    )
    robots = pytest.importorskip("pursue_gen.tools.transport.robots_file")
    found = {
        robot.name: (robot.host, f"127.0.0.1:{robot.port}:13000")
        for robot in robots.read_robots(workspace / "docker/robots.yaml")
    }
    spaces = {services[name]["command"][-1][len("__ns:=/") :]: ports[name][0] for name in ports}
    assert {name: port for name, (_, port) in found.items()} == spaces
    assert set(spaces) == {"base", *CONTROLLERS}


def test_every_variable_is_explained(generated: Dict[str, bytes]) -> None:
    asked = set(re.findall(r"\$\{(PURSUE_\w+)", generated["docker/compose.yaml"].decode()))
    explained = set(re.findall(r"PURSUE_\w+", generated["docker/README.md"].decode()))
    assert asked - {"PURSUE_PLANNER"} <= explained
    assert set(re.findall(r"^(PURSUE_\w+)=", generated["docker/lab.env"].decode(), re.MULTILINE)) <= asked


def test_how_robots_get_their_orders_is_set_from_outside(compose: Dict[str, Any]) -> None:
    """As a node of the thesis needs it, which cannot acknowledge them."""
    for variables, wanted in ({}, "numbered"), ({"PURSUE_ORDERS": "plain"}, "plain"):
        services = interpolated(compose["services"], variables)
        told = {name for name, service in services.items() if f"_orders:='{wanted}'" in service["command"]}
        assert told == {"controller-polbot1", "controller-polbot2", "controllerobj"}


def test_debian_12_has_every_package() -> None:
    tools = ("catkin", "g++", "make")
    words = [tool("apt-cache"), "show", "--no-all-versions", *tools, *DEBIAN_PACKAGES]
    if "bookworm" not in Path("/etc/os-release").read_text(encoding="utf-8"):
        pytest.skip("this is not Debian 12")
    done = run(words, Path("/"))
    # Without lists apt still knows what is installed, but for its file in the archive.
    listed = [record for record in done.stdout.split("\n\n") if "\nFilename: " in record]
    found = set(re.findall(r"^Package: (\S+)", "\n".join(listed), re.MULTILINE))
    if not found >= set(tools):
        pytest.skip("apt has no lists here")
    assert set(DEBIAN_PACKAGES) <= found, done.stderr


@given(st.lists(st.from_regex(r"[A-Za-z][A-Za-z0-9_]{0,80}", fullmatch=True), unique=True, max_size=6))
def test_every_node_gets_a_name_that_dns_takes(nodes: List[str]) -> None:
    names = service_names(nodes)
    assert list(names) == nodes and len(set(names.values())) == len(nodes)
    assert all(re.fullmatch(r"[a-z0-9]([a-z0-9-]{0,61}[a-z0-9])?", name) for name in names.values())


@pytest.mark.slow
@pytest.mark.skipif(
    not os.environ.get("PURSUE_LONG_TESTS"), reason="takes minutes and the network: PURSUE_LONG_TESTS=1"
)
def test_the_images_play_a_mission_to_its_goal() -> None:
    """Dockerfile.debian's steps in a debootstrap root, then compose's services; no docker is needed, but root."""
    if os.geteuid() or not shutil.which("debootstrap"):
        pytest.skip("this needs root and debootstrap")
    place = Path(tempfile.mkdtemp(prefix="pursue-image-"))
    try:
        write_tree(generate(*world("thesis/scenario_1"), OPTIONS), place / "ws")
        (place / "image").mkdir()
        words = [
            sys.executable,
            str(Path(__file__).with_name("debian_image.py")),
            str(place / "ws"),
            str(place / "image"),
        ]
        done = subprocess.run(words, capture_output=True, text=True, timeout=3600, check=False)
        assert done.returncode == 0, done.stderr[-8000:]
        found = json.loads(done.stdout)
        assert set(found["healthy"].values()) == {True} and found["dead"] != 0
        assert {status for name, status in found["statuses"].items() if name != "master"} == {0}
    finally:
        assert str(place) not in Path("/proc/self/mounts").read_text(encoding="utf-8")
        shutil.rmtree(place)


# systemd --------------------------------------------------------------------------------------------------------------


def units(generated: Dict[str, bytes]) -> Dict[str, str]:
    return {path.split("/")[1]: text.decode() for path, text in generated.items() if path.startswith("systemd/pursue")}


def test_a_unit_for_each_node(generated: Dict[str, bytes]) -> None:
    nodes: Set[str] = CONTROLLERS | {"observer", "UI", "recorder", "roscore", "communication_manager", "pursue_reader"}
    assert {name for name in units(generated) if name.endswith(".service")} == {
        f"pursue-{node}.service" for node in nodes
    }


def test_systemd_finds_no_fault(workspace: Path) -> None:
    program = tool("systemd-analyze")
    folder = workspace / "systemd"
    names = sorted(path.name for path in folder.iterdir() if path.suffix in (".service", ".target"))
    done = run([program, "verify", "--man=no", *(f"./{name}" for name in names)], folder)
    if "Failed to" in done.stderr and "manager" in done.stderr:
        pytest.skip(f"systemd-analyze does not work here: {done.stderr.strip()}")
    assert (done.returncode, done.stderr) == (0, "")


def test_units_may_write_to_their_state_only(generated: Dict[str, bytes]) -> None:
    for name, text in units(generated).items():
        if name.endswith(".service"):
            for line in ("NoNewPrivileges=true", "ProtectSystem=strict", "PrivateTmp=true", "StateDirectory=pursue"):
                assert f"\n{line}\n" in text, name
            assert "\nUser=pursue\n" in text and "\nRestart=always\n" in text


def test_every_variable_of_a_unit_has_a_value(generated: Dict[str, bytes]) -> None:
    given = set(re.findall(r"^(\w+)=", generated["systemd/pursue.env"].decode(), re.MULTILINE))
    for text in units(generated).values():
        assert set(re.findall(r"\$\{(\w+)\}", text)) <= given


def test_on_robots_nothing_is_simulated_and_nothing_starts_by_itself(generated: Dict[str, bytes]) -> None:
    told = generated["systemd/pursue.env"].decode()
    real = 'PURSUE_GOALS="action"', 'PURSUE_ENDS="result"', 'PURSUE_ON_STOP="cancel"', 'PURSUE_ORDERS="numbered"'
    for line in ('PURSUE_SIMULATE="false"', 'PURSUE_AUTOSTART="false"', 'PURSUE_PAGE_HOST="127.0.0.1"', *real):
        assert f"\n{line}\n" in told
    assert '\nPURSUE_NODES="all"\n' in told
    reader = generated["systemd/pursue-pursue_reader.service"].decode()
    assert "\"_nodes:='${PURSUE_NODES}'\"" in reader
    assert '\nPURSUE_WITHOUT="simulator"\n' in told and 'PURSUE_MISSION_HOST="127.0.0.1"' in told


def test_units_know_the_machines(generated: Dict[str, bytes]) -> None:
    machines = Machines("base.local", (Machine("bot1.local", ("controller_polBot1",)),))
    files = generate(*world("thesis/catch_the_thief"), replace(OPTIONS, machines=machines))
    assert "\nROS_MASTER_URI=http://base.local:11311\n" in files["systemd/pursue.env"].decode()
    (line,) = [line for line in files["systemd/README.md"].decode().splitlines() if line.endswith("# bot1.local")]
    assert "pursue-controller_polBot1 " in line and "pursue-observer" not in line
