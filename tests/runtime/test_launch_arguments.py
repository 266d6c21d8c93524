"""What the launch files start, with which arguments: as roslaunch itself reads them, without a master."""

from __future__ import annotations

import re
import shlex
from pathlib import Path
from typing import Any, Callable, Dict, List, Sequence

import pytest

from pursue_gen.language import load
from pursue_gen.solving.solution import Rules, solve_scenario
from pursue_gen.workspace import Options, write_workspace
from pursue_runtime.arguments import BAG, CONFIG, KEYS, read_arguments
from pursue_runtime.observer import settings
from pursue_runtime.ui import options

roslaunch = pytest.importorskip("roslaunch", reason="ROS is not installed")
manager_node = pytest.importorskip("pursue_runtime.nodes.communication_manager")

SCENARIO = Path(__file__).resolve().parents[2] / "scenarios" / "thesis" / "scenario_1.pur"
MISSION = ["observer", "controller_bot1", "controller_bot2", "controllerObj", "simulator", "UI"]


WITH_VISITOR = """
poi "a" poi "b"
connect a and b distance 2
event "handOver" collaborative
agent "bot" controllable mobile 1 location a can_do handOver
agent "visitor" mobile 3 location b reacts_to handOver
reach_objective: do handOver
"""


def written(scenario: Path, folder: Path) -> Path:
    """The packages of the workspace of a scenario."""
    read, rules = load(str(scenario)), Rules()
    won = solve_scenario(read, rules)
    write_workspace(read, won.network, won.objective, won.strategy, Options(reaction=rules.reaction), folder)
    return folder / "src"


@pytest.fixture(scope="module")
def packages(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The packages of a workspace."""
    return written(SCENARIO, tmp_path_factory.mktemp("launch") / "ws")


@pytest.fixture(scope="module")
def workspaces(packages: Path, tmp_path_factory: pytest.TempPathFactory) -> Dict[str, Path]:
    """The packages of a scenario of robots alone, and of one with a visitor whom nobody controls."""
    file = tmp_path_factory.mktemp("visitor") / "library.pur"
    file.write_text(WITH_VISITOR)
    return {"scenario_1": packages, "library": written(file, file.parent / "ws")}


class Launched:
    """A launch file as roslaunch has understood it."""

    def __init__(self, config: Any) -> None:
        self.nodes = {(node.namespace + node.name).lstrip("/"): node for node in config.nodes}
        self.params: Dict[str, Any] = {name: param.value for name, param in config.params.items()}
        self.cleared = {name.strip("/") for name in config.clear_params}

    def told(self, node: str) -> Dict[str, str]:
        """What the process of a node is told: its arguments by name, as roslaunch splits them."""
        return dict(word[2:].split("=", 1) for word in shlex.split(self.nodes[node].args))

    @property
    def names(self) -> List[str]:
        return sorted(self.nodes)


@pytest.fixture
def launch(packages: Path, monkeypatch: pytest.MonkeyPatch) -> Any:
    """`launch(file, *arguments)` reads the file of the bringup package."""
    monkeypatch.setenv("ROS_PACKAGE_PATH", str(packages))

    def read(name: str, *arguments: str, only: Path = packages) -> Launched:
        monkeypatch.setenv("ROS_PACKAGE_PATH", str(only))
        monkeypatch.setattr(roslaunch.substitution_args, "_rospack", None)  # it would remember packages of before
        config = roslaunch.config.ROSLaunchConfig()
        (file,) = only.glob(f"*_bringup/launch/{name}")
        roslaunch.xmlloader.XmlLoader().load(str(file), config, argv=[str(file), *arguments])
        return Launched(config)

    return read


def test_without_arguments_the_whole_mission_of_the_workspace_is_played_once(launch: Any) -> None:
    found = launch("mission.launch")
    assert found.names == sorted(MISSION)
    assert [name for name, node in found.nodes.items() if node.required] == ["UI"]
    assert sorted(name for name, node in found.nodes.items() if node.respawn) == sorted(set(MISSION) - {"UI"})
    assert found.nodes["UI"].launch_prefix.endswith("/again.sh --end")
    assert launch("mission.launch", "required:=false").nodes["UI"].launch_prefix.endswith("/again.sh")
    assert not launch("mission.launch", "respawn:=false").nodes["UI"].launch_prefix
    assert found.params["/UI/autostart"] is True
    for node in MISSION:
        assert (found.params[f"/{node}/received"], found.params[f"/{node}/again"]) == (False, False)
    assert found.params["/UI/nodes"].split() == [name for name in MISSION if name != "UI"]


def test_a_machine_may_run_some_of_the_nodes(launch: Any) -> None:
    assert launch("mission.launch", "nodes:=controller_bot1").names == ["controller_bot1"]
    assert launch("mission.launch", "nodes:=observer, UI").names == ["UI", "observer"]
    extra = ("use_sim_time:=true", "record:=true")
    assert launch("mission.launch", *extra).names == sorted([*MISSION, "sim_clock", "recorder"])
    assert launch("mission.launch", "nodes:=UI", *extra).names == ["UI"]
    assert launch("mission.launch", "nodes:=UI", "markers:=true").names == ["UI", "markers"]
    assert launch("mission.launch", "nodes:=observer", "markers:=true").names == ["observer"]
    assert launch("mission.launch", "nodes:=UI", "rviz:=true").names == ["UI", "markers", "rviz"]
    assert launch("mission.launch", "nodes:=UI", "rviz:=true", "markers:=false").names == ["UI", "rviz"]
    assert launch("mission.launch", "nodes:=sim_clock recorder", *extra).names == ["recorder", "sim_clock"]
    assert launch("mission.launch", "nodes:=simulator", "simulate:=false").names == []


def test_what_an_earlier_launch_has_set_on_the_same_master_does_not_count(launch: Any, tmp_path: Path) -> None:
    robots = tmp_path / "robots.yaml"
    robots.write_text("retries: 0\nbot2: {ends: tf}\n")
    found = launch("mission.launch", "simulate:=false", "record:=true", f"robots:={robots}", "verdict:=/tmp/v")
    first, then = set(found.params), set(launch("mission.launch", "simulate:=false", "record:=true").params)
    left = {name.split("/")[1] for name in first - then}
    assert {"controller_bot1", "controller_bot2"} <= left
    assert left <= found.cleared and {"UI", "recorder"} <= found.cleared


@pytest.mark.parametrize("file", [["mission.launch"], ["robot.launch", "name:=base"]])
def test_nodes_behave_as_those_of_the_thesis_where_that_is_asked_for(launch: Any, file: List[str]) -> None:
    usual = launch(*file, "simulate:=true", "record:=true")
    asked = ("print_state:=true", "plain_words:=true", "show:=e")
    found = launch(*file, "simulate:=true", "record:=true", *asked)
    for node in (*MISSION, "recorder"):
        assert (usual.params[f"/{node}/print_state"], found.params[f"/{node}/print_state"]) == (False, True)
    assert (usual.params["/observer/plain_words"], found.params["/observer/plain_words"]) == (False, True)
    assert (usual.params["/UI/show"], found.params["/UI/show"]) == ("words", "e")


def test_markers_print_states_too(launch: Any) -> None:
    assert launch("mission.launch", "markers:=true", "print_state:=true").params["/markers/print_state"] is True


def test_the_monitor_groups_the_diagnostics_of_every_node(launch: Any) -> None:
    found = launch("monitor.launch")
    assert found.names == ["diagnostic_aggregator"]
    group = "/diagnostic_aggregator/analyzers/mission/analyzers"
    prefixes = [name for key in ("observer", "controllers", "ui") for name in found.params[f"{group}/{key}/startswith"]]
    assert {f"{node}:" for node in MISSION} <= set(prefixes)
    assert found.params[f"{group}/controllers/num_items"] == sum(name.startswith("controller") for name in MISSION)


REAL = {"goals": "action", "ends": "result", "on_stop": "cancel"}
SIMULATED = {"goals": "simple", "ends": "words", "on_stop": "finish"}


@pytest.mark.parametrize("file, given, simulated", [
    ("mission.launch", [], True),
    ("mission.launch", ["simulate:=true"], True),
    ("mission.launch", ["simulate:=1"], True),
    ("mission.launch", ["simulate:=false"], False),
    ("mission.launch", ["simulate:=0"], False),
    ("robot.launch", ["name:=base"], False),
    ("robot.launch", ["name:=base", "simulate:=true"], True),
])  # fmt: skip
@pytest.mark.parametrize("scenario", ["scenario_1", "library"])
def test_what_is_not_given_fits_robots_that_are_real_or_simulated(
    workspaces: Dict[str, Path], launch: Any, scenario: str, file: str, given: List[str], simulated: bool
) -> None:
    found = launch(file, *given, only=workspaces[scenario])
    controllers = [name for name in found.names if name.startswith("controller_bot")]
    wanted = SIMULATED if simulated else REAL
    assert controllers
    for controller in controllers:
        settings = {name: found.params[f"/{controller}/{name}"] for name in wanted}
        assert (settings, found.params[f"/{controller}/simulated"]) == (wanted, simulated)
    assert found.params["/observer/lost_after"] == (30 if simulated else 180), "move_base tries for minutes"
    free = scenario == "library"
    assert found.params["/UI/mode"] == ("random" if simulated and free else "still"), "nobody's moves are invented"
    assert found.params["/UI/ends"] is not simulated, "whoever is not simulated is reported by a person"
    assert ("simulator" in found.names) is simulated


def test_what_is_given_counts_for_real_robots_too(launch: Any) -> None:
    found = launch("mission.launch", "simulate:=false", "goals:=simple", "ends:=tf", "on_stop:=finish", "mode:=random")
    params = found.params
    assert [params[f"/controller_bot1/{name}"] for name in ("goals", "ends", "on_stop")] == ["simple", "tf", "finish"]
    assert params["/UI/mode"] == "random"


def test_one_launch_line_for_real_robots_is_documented_everywhere(packages: Path) -> None:
    root = SCENARIO.parents[2]
    pages = {root / "README.md": "my_floor", root / "docs" / "robots.md": "my_floor",
             packages.parent / "README.md": "scenario_1"}
    for page, name in pages.items():
        lines = re.findall(r"^ +(rosrun \w+ run_mission .*simulate:=false.*)$", page.read_text(), re.MULTILINE)
        bare = {re.sub(rf"{name}(_surveyed|_calibrated)?_bringup|( record:=\S+)?$", "", line) for line in lines}
        assert bare == {"rosrun  run_mission simulate:=false"}, page


READ: Dict[str, Callable[[List[str]], Any]] = {
    "observer": lambda words: read_arguments("observer", settings.ARGUMENTS, words),
    "recorder": lambda words: read_arguments("recorder", [CONFIG, BAG], words),
    "UI": options.read_told,
    "base/communication_manager": lambda words: read_arguments("", manager_node.ARGUMENTS, words),
    "base/pursue_reader": lambda words: read_arguments("", [KEYS], words),
}  # fmt: skip
GIVEN = {
    "planner": ("observer", "planner", "timeout 20 'my planner' --fast"),
    "journal": ("observer", "journal", "/o'brien/a journal"),
    "record": ("recorder", "file", "/o'brien/007"),
    "trace": ("UI", "trace", "/a/trace.yaml"),
    "verdict": ("UI", "verdict", "/a b/verdict"),
    "token": ("UI", "token", "0012345678"),
    "keys": ("base/pursue_reader", "keys", "/my keys"),
    "certificate": ("base/communication_manager", "certificate", "/robot.pem"),
    "private_key": ("base/communication_manager", "private_key", "-/robot.key"),
    "forwardedtopics": ("base/communication_manager", "forwardedtopics", "/pursue/events,/pursue/system_state"),
}


@pytest.mark.parametrize("name", sorted(GIVEN))
def test_programs_keys_files_and_addresses_are_arguments_of_the_process_and_no_parameters(
    launch: Any, name: str
) -> None:
    node, argument, value = GIVEN[name]
    file = ["robot.launch", "name:=base"] if "/" in node else ["mission.launch"]
    found = launch(*file, f"{name}:={value}")
    assert READ[node](shlex.split(found.nodes[node].args))[argument] == value
    assert not [param for param in found.params if param.endswith(f"/{argument}")]


def test_what_is_not_given_is_as_the_nodes_document_it(launch: Any) -> None:
    found = {**launch("mission.launch", "record:=true").nodes, **launch("robot.launch", "name:=base").nodes}
    for node, read in READ.items():
        told, usual = read(shlex.split(found[node].args)), read([])
        own = {"launch", "file"}  # the launch is named, and true means what is usual
        assert {key: told[key] for key in set(told) - own} == {key: usual[key] for key in set(usual) - own}, node


def test_an_observer_that_is_started_again_belongs_to_the_same_launch(launch: Any) -> None:
    found = launch("mission.launch")
    first, again = (found.told("observer")["launch"] for _ in range(2))
    assert first == again and "$" not in first and first.startswith("mission_")
    assert launch("mission.launch").told("observer")["launch"] != first, "each launch has a name of its own"


@pytest.mark.parametrize("file", ["mission.launch", "robot.launch"])
def test_a_node_that_is_not_there_is_an_error_that_lists_those_that_are(launch: Any, file: str) -> None:
    named = ["name:=bot1"] if file == "robot.launch" else []
    with pytest.raises(Exception, match="nodes:= has controller_bot; there are: all observer controller_bot1 "):
        launch(file, *named, "nodes:=UI controller_bot")


def test_a_robot_needs_the_packages_of_its_own_nodes_only(launch: Any, packages: Path, tmp_path: Path) -> None:
    for name in ("scenario_1_bringup", "controller_bot1"):
        (tmp_path / name).symlink_to(packages / name)
    found = launch("robot.launch", "name:=bot1", "nodes:=controller_bot1", only=tmp_path)
    assert found.names == ["bot1/communication_manager", "bot1/pursue_reader", "controller_bot1"]


def test_the_page_on_which_a_mission_is_started_outlives_it_and_the_nodes_wait_for_the_next(launch: Any) -> None:
    found = launch("mission.launch", "web:=true", "record:=true")
    others = [node for node in found.names if node != "UI"]
    assert (found.params["/UI/stay"], found.params["/UI/again"]) == (True, False)
    assert all(found.params[f"/{node}/again"] is True for node in others) and "recorder" in others
    assert found.nodes["UI"].required and "again.sh" in found.nodes["UI"].launch_prefix, "closing it ends the launch"
    for given in (["web:=true", "autostart:=true"], ["web:=true", "stay:=false"], []):
        found = launch("mission.launch", *given)
        assert not any(found.params[f"/{node}/again"] for node in MISSION) and found.params["/UI/stay"] is False
    found = launch("robot.launch", "name:=base", "nodes:=UI", "web:=true")
    assert (found.params["/UI/stay"], found.params["/UI/again"]) == (True, True)


def test_mission_after_mission_nothing_ends_for_good(launch: Any) -> None:
    found = launch("mission.launch", "again:=true", "received:=true")
    assert not any(node.required for node in found.nodes.values())
    assert all(node.respawn for node in found.nodes.values())
    assert not found.nodes["UI"].launch_prefix
    assert found.params["/UI/autostart"] is False
    assert launch("mission.launch", "again:=true", "autostart:=true").params["/UI/autostart"] is True
    for node in MISSION:
        assert (found.params[f"/{node}/received"], found.params[f"/{node}/again"]) == (True, True)


def test_the_nodes_to_wait_for_are_those_of_the_mission_that_was_received(launch: Any) -> None:
    found = launch("mission.launch", "received:=true", "simulate:=false", "record:=true")
    assert "/UI/nodes" not in found.params and "/recorder/nodes" not in found.params
    assert (found.params["/UI/without"], found.params["/UI/also"]) == ("simulator", "recorder")
    assert found.params["/recorder/without"] == "simulator"
    found = launch("mission.launch", "received:=true")
    assert "/UI/without" not in found.params and "/UI/also" not in found.params


def test_a_robot_takes_missions_and_plays_its_part_of_them(launch: Any) -> None:
    given = ("host:=10.0.0.2", "port:=13100", "keys:=/keys", "keep:=9", "page_port:=81", "web:=true", "time_unit:=2")
    found = launch("robot.launch", "name:=base", "nodes:=observer UI", *given)
    assert found.names == ["UI", "base/communication_manager", "base/pursue_reader", "observer"]
    params = found.params
    manager, reader = "/base/communication_manager", "/base/pursue_reader"
    told = found.told("base/communication_manager")
    assert (told["host"], told["port"]) == ("10.0.0.2", "13100")
    assert (found.told("UI")["host"], found.told("UI")["port"], params["/UI/web"]) == ("127.0.0.1", "81", True)
    assert told["keys"] == found.told("base/pursue_reader")["keys"] == "/keys"
    assert params[f"{manager}/robot"] == params[f"{reader}/robot"] == "base"
    assert (params[f"{reader}/keep"], params["/observer/time_unit"]) == (9, 2)
    assert params[f"{reader}/nodes"] == "observer UI", "the desk is told what runs here"
    assert launch("robot.launch", "name:=base").params[f"{reader}/nodes"] == "all"
    assert params["/observer/received"] is params["/observer/again"] is params["/UI/again"] is True
    assert all(node.respawn for node in found.nodes.values())


def test_a_robot_passes_on_what_it_is_reported(packages: Path) -> None:
    """What robot.launch declares and does not use itself is an argument of mission.launch, and goes there by name."""
    folder = packages / "scenario_1_bringup" / "launch"
    robot, mission = ((folder / name).read_text() for name in ("robot.launch", "mission.launch"))
    own = set(re.findall(r"\$\(arg (\w+)\)", robot))
    declared = set(re.findall(r'<arg name="(\w+)" (?:default|doc)=', robot))
    known = set(re.findall(r'<arg name="(\w+)" default=', mission))
    passed = {"goals", "ends", "planner", "seed", "print_state", "show", "plain_words"}
    assert declared - own <= known and passed <= declared - own


@pytest.mark.parametrize("package", ["communication_manager", "pursue_reader"])
def test_parameters_of_the_nodes_that_take_missions_are_those_of_their_own_launch_files(
    launch: Any, packages: Path, package: str
) -> None:
    own = (packages / package / "launch" / f"{package}.launch").read_text()
    known = set(re.findall(r'<param [^>]*?\bname="(\w+)"', own))
    robot = launch("robot.launch", "name:=bot1")
    ours = {name.split("/")[-1] for name in robot.params if f"/{package}/" in name}
    assert ours and ours <= known
    assert list(robot.told(f"bot1/{package}")) == re.findall(r"--(\w+)=", own)


@pytest.mark.parametrize("file", ["mission.launch", "robot.launch"])
def test_what_has_a_default_is_optional_and_all_say_what_they_are(packages: Path, file: str, launch: Any) -> None:
    """As `roslaunch --ros-args` tells them apart: it takes an empty default for none."""
    arg_dump = pytest.importorskip("roslaunch.arg_dump")
    launch("mission.launch")  # the packages are found
    path = packages / "scenario_1_bringup" / "launch" / file
    told = arg_dump.get_args([str(path)])
    required = [name for name, (_, default) in told.items() if not default]
    assert required == (["name"] if file == "robot.launch" else [])
    assert [name for name, (doc, _) in told.items() if not doc] == []


@pytest.mark.parametrize(
    ("file", "arguments", "clock", "runs"),
    [
        ("mission.launch", (), False, False),
        ("mission.launch", ("use_sim_time:=true",), True, True),
        ("mission.launch", ("simulate:=false",), None, False),
        ("mission.launch", ("simulate:=false", "use_sim_time:=false"), False, False),
        ("mission.launch", ("simulate:=false", "use_sim_time:=true"), True, True),
        ("robot.launch", ("name:=base",), None, False),
        ("robot.launch", ("name:=base", "use_sim_time:=true"), True, True),
    ],
)
def test_the_clock_of_real_robots_stays_as_their_launch_has_set_it(
    launch: Any, file: str, arguments: Sequence[str], clock: object, runs: bool
) -> None:
    """Gazebo, for example, sets /use_sim_time and publishes /clock."""
    launched = launch(file, *arguments)
    assert (launched.params.get("/use_sim_time"), "sim_clock" in launched.names) == (clock, runs)
