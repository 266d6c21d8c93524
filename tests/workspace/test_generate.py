"""A workspace in memory: what it holds, that catkin, roslaunch and Python accept it, and that it is always the same."""

from __future__ import annotations

import ast
import dataclasses
import functools
import json
import math
import re
import subprocess
import sys
import xml.etree.ElementTree as ElementTree
from fractions import Fraction
from pathlib import Path
from typing import Dict, FrozenSet, List, Set, Tuple

import pytest
import yaml
from catkin_pkg.package import parse_package
from worlds import REACTION, SCENARIOS, files, made, world

import pursue_runtime
from pursue_gen.diagnostics import PursueError
from pursue_gen.language import load, parse
from pursue_gen.partition import partition
from pursue_gen.synthesis.plan import read_plan
from pursue_gen.tga.uppaal import read_network, read_query
from pursue_gen.workspace import Options, generate, templates_dir, ui_file, write_workspace
from pursue_gen.workspace.packages import RECEIVING, RUNTIME, SHARED
from pursue_gen.workspace.poses_text import poses_text
from pursue_gen.workspace.spots import placing
from pursue_runtime import bundle
from pursue_runtime.bounded import DATA
from pursue_runtime.event_words import MARKERS
from pursue_runtime.poses import read_poses
from pursue_runtime.ui.promise import read_promise
from tests.runtime.texts import read

SHAPES = [
    ("thesis/scenario_1", "distributed", "dedicated"),
    ("thesis/scenario_1", "distributed", "bot2"),
    ("thesis/catch_the_thief", "distributed", "all"),
    ("thesis/catch_the_thief", "centralized", "dedicated"),
    ("thesis/catch_the_thief", "general", "dedicated"),
    ("work_cell/work_cell", "distributed", "dedicated"),
]
HOME = "/home/somebody_who_generates"


def packages(generated: Dict[str, bytes]) -> Set[str]:
    return {path.split("/")[1] for path in generated if path.startswith("src/")}


def python(generated: Dict[str, bytes]) -> Dict[str, str]:
    shebang = b"#!/usr/bin/env python3\n"
    return {p: text.decode() for p, text in generated.items() if p.endswith(".py") or text.startswith(shebang)}


@pytest.fixture(scope="module", params=SHAPES, ids="-".join)
def generated(request: pytest.FixtureRequest) -> Dict[str, bytes]:
    name, controllers, reach_obj = request.param
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("HOME", HOME)
        return made(name, controllers, reach_obj)


def test_what_is_special_to_a_mission_is_small() -> None:
    apart = [*(f"src/{name}/" for name in SHARED), "TGA.xml", "TCTL.q", "UPPAAL_plan.txt", r".*/test/", r".*\.svg"]
    every = files("thesis/catch_the_thief").items()
    special = {path: text for path, text in every if not re.match("|".join(apart), path)}
    assert sum(text.count(b"\n") for text in special.values()) <= 2500


def test_one_package_for_each_node() -> None:
    common = {"observer", "UI", "catch_the_thief_bringup", *SHARED, *RECEIVING}
    robots = {"controller_polBot1", "controller_polBot2"}
    name = "thesis/catch_the_thief"
    assert packages(files(name)) == common | robots | {"controllerObj"}
    assert packages(files(name, "distributed", "all")) == common | robots
    assert packages(files(name, "distributed", "polBot1")) == common | robots
    assert packages(files(name, "centralized")) == common | {"controller"}
    assert packages(files(name, "general")) == common | {"controller"}


def test_manifests_are_valid_and_named_like_their_folders(generated: Dict[str, bytes], tmp_path: Path) -> None:
    for name in packages(generated):
        manifest = tmp_path / "package.xml"
        manifest.write_bytes(generated[f"src/{name}/package.xml"])
        parsed = parse_package(str(manifest))
        parsed.validate()
        assert parsed.name == name
        assert [d.name for d in parsed.buildtool_depends] == ["catkin"]
        assert name.endswith("_bringup") or name in SHARED or RUNTIME in {d.name for d in parsed.exec_depends}


def test_what_a_node_imports_is_in_its_manifest_or_that_of_the_run_time(generated: Dict[str, bytes]) -> None:
    keys = {"yaml": "python3-yaml", "transitions": "python3-transitions", "tornado": "python3-tornado"}
    keys["cryptography"] = "python3-cryptography"
    known = {"rospy", "std_msgs", "geometry_msgs", "diagnostic_msgs", "rosgraph_msgs", "rosbag", "rostest", *keys}
    for path, text in python(generated).items():
        package = path.split("/")[1]
        if package == RUNTIME:
            continue
        manifest = b"".join(generated[f"src/{name}/package.xml"] for name in (package, RUNTIME)).decode()
        for module in reached(text, generated) & known:
            assert f"_depend>{keys.get(module, module)}<" in manifest, f"{path} needs {module}"


def reached(text: str, generated: Dict[str, bytes]) -> Set[str]:
    """What a script imports, directly or by way of modules of the run time that are imported at once."""
    found: Set[str] = set()
    seen: Set[str] = set()
    waiting = [text]
    while waiting:
        names, modules = imports(waiting.pop())
        found |= names
        for module in modules - seen:
            seen.add(module)
            path = f"src/{RUNTIME}/src/{module.replace('.', '/')}.py"
            if path in generated:
                waiting.append(generated[path].decode())
    return found


@functools.lru_cache(maxsize=None)
def imports(text: str) -> Tuple[FrozenSet[str], FrozenSet[str]]:
    """Of what is imported anywhere in it: the top-level names, and what may be a module behind `from`.

    The run time is in every workspace, so it is read once.
    """
    top, modules = set(), set()
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, ast.Import):
            top |= {name.name.split(".")[0] for name in node.names}
        elif isinstance(node, ast.ImportFrom):
            top.add((node.module or "").split(".")[0])
            if node.module:
                modules |= {node.module, *(f"{node.module}.{name.name}" for name in node.names)}
    return frozenset(top), frozenset(modules)


def test_the_run_time_is_there_once_and_byte_for_byte_what_is_imported_here(generated: Dict[str, bytes]) -> None:
    root = Path(pursue_runtime.__file__).parent
    ours = {path for path in root.rglob("*") if path.is_file() and "__pycache__" not in path.parts}
    head = f"src/{RUNTIME}/src/{RUNTIME}/"
    assert {path[len(head):] for path in generated if path.startswith(head)} == {
        path.relative_to(root).as_posix() for path in ours
    }
    assert all(generated[head + path.relative_to(root).as_posix()] == path.read_bytes() for path in ours)
    assert not [path for path in generated if path.endswith(".py") and "/scripts/" in path]


def test_the_script_of_a_node_is_small_and_says_where_it_comes_from(generated: Dict[str, bytes]) -> None:
    scripts = {path: text for path, text in python(generated).items() if not path.startswith(f"src/{RUNTIME}/")}
    assert scripts
    for path, text in scripts.items():
        assert len(text.splitlines()) <= 40, path
        assert "Generated by pursue-gen" in text.splitlines()[1], path


def test_what_cmake_names_is_there_and_everything_is_installed(generated: Dict[str, bytes]) -> None:
    for name in packages(generated):
        cmake = generated[f"src/{name}/CMakeLists.txt"].decode()
        assert f"project({name})" in cmake
        inside = {p.split("/", 2)[2] for p in generated if p.startswith(f"src/{name}/")}
        named = set(re.findall(r"(?:scripts|test)/[\w.]+", cmake))
        assert named <= inside
        assert {p for p in inside if p.startswith("scripts/")} <= named
        assert all(p[len("msg/") :] in cmake for p in inside if p.startswith(("msg/", "srv/")))
        folders = {p.split("/")[0] for p in inside if "/" in p} - {"scripts", "src", "msg", "srv"}
        for folder in folders:
            assert re.search(rf"install\(DIRECTORY[^)]*\b{folder}\b", cmake), f"{name}/{folder} is not installed"


def test_robots_check_missions_with_the_desks_own_code(generated: Dict[str, bytes]) -> None:
    assert generated[f"src/{RUNTIME}/src/{RUNTIME}/bundle.py"] == Path(bundle.__file__).read_bytes()
    for package in RECEIVING:
        assert "_depend>python3-cryptography<" in generated[f"src/{package}/package.xml"].decode()
        assert f"rosrun {package}" not in generated["README.md"].decode()


def test_each_package_has_the_node_of_its_name(generated: Dict[str, bytes]) -> None:
    for name in packages(generated):
        if not name.endswith("_bringup") and name not in SHARED:
            assert generated[f"src/{name}/scripts/{name}"].startswith(b"#!/usr/bin/env python3\n")
    assert "src/UI/scripts/simulator" in generated and "src/UI/scripts/sim_clock" in generated


def test_python_is_that_of_ubuntu_20_04(generated: Dict[str, bytes]) -> None:
    for path, text in python(generated).items():
        ast.parse(text, path, feature_version=(3, 8))


def test_python_passes_the_linter(generated: Dict[str, bytes], tmp_path: Path) -> None:
    pytest.importorskip("ruff", reason="ruff is not installed")
    for number, (path, text) in enumerate(sorted(python(generated).items())):
        folder = tmp_path / str(number)  # alone: ruff tells first-party modules by their neighbours
        folder.mkdir()
        (folder / (Path(path).stem + ".py")).write_text(text, encoding="utf-8")
    command = [sys.executable, "-m", "ruff", "check", "--isolated", "--no-cache", "--target-version", "py38"]
    command += ["--select", "E4,E7,E9,F,W,B", str(tmp_path)]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout


def test_data_and_launch_files_can_be_read(generated: Dict[str, bytes]) -> None:
    for path, text in generated.items():
        if path.endswith((".yaml", ".rviz")):
            assert read(text) is not None, path
        elif path.endswith((".xml", ".launch", ".test", ".svg")):
            ElementTree.fromstring(text)
        elif path.endswith(".json"):
            json.loads(text)


def test_rviz_shows_the_places_and_none_of_its_tools_sends_a_robot_anywhere() -> None:
    generated = files("thesis/catch_the_thief")
    rviz = read(generated["src/catch_the_thief_bringup/rviz/mission.rviz"])["Visualization Manager"]
    tools = {tool["Class"]: tool.get("Topic") for tool in rviz["Tools"]}
    assert "rviz/MoveCamera" in tools and set(tools.values()) == {None, "/clicked_point"}
    assert not {"rviz/SetGoal", "rviz/SetInitialPose"} & set(tools)
    shown = [each["Marker Topic"] for each in rviz["Displays"] if each["Class"] == "rviz/MarkerArray"]
    assert shown == [f"/{MARKERS}"]
    view = rviz["Views"]["Current"]
    for x, y, *_ in read(generated["src/UI/config/poses.yaml"])["poses"].values():
        assert abs(x - view["X"]) * view["Scale"] <= 261 and abs(y - view["Y"]) * view["Scale"] <= 151, "pixels"


def test_every_launch_argument_has_a_default_and_says_what_it_is(generated: Dict[str, bytes]) -> None:
    arguments = []
    for path, text in generated.items():
        if path.endswith((".launch", ".test")):
            told = (a.attrib for a in ElementTree.fromstring(text).findall("arg"))
            arguments += [(path.split("/")[-1], a) for a in told if "value" not in a]  # those nobody can give
    assert len(arguments) > 10
    assert all(a.get("doc") for _, a in arguments)
    # Nobody but its user knows what the desk calls a machine.
    assert [(file, a["name"]) for file, a in arguments if "default" not in a] == [("robot.launch", "name")]


def test_the_launch_file_starts_every_node_and_no_other(generated: Dict[str, bytes]) -> None:
    (launch,) = [text for path, text in generated.items() if path.endswith("mission.launch")]
    nodes = {(n.attrib["pkg"], n.attrib["type"]) for n in ElementTree.fromstring(launch).iter("node")}
    there = {(p.split("/")[1], p.split("/")[3]) for p in generated if "/scripts/" in p and not p.endswith(".py")}
    there = {(package, node) for package, node in there if package not in RECEIVING}  # they outlive missions
    there = {(package, node) for package, node in there if node != "run_mission"}  # it starts the launch file
    there -= {("UI", "drive_legs")}  # it drives robots while no mission runs
    there -= {("UI", "doors")}  # these scenarios have none
    assert nodes - {("rviz", "rviz")} == there


def test_the_same_scenario_gives_the_same_bytes() -> None:
    assert made("thesis/catch_the_thief") == files("thesis/catch_the_thief")


def test_neither_the_machine_nor_the_day_is_in_any_file(generated: Dict[str, bytes]) -> None:
    for path, text in generated.items():
        said = text.decode()
        assert str(SCENARIOS) not in said and HOME not in said, path
        assert not re.search(r"\b20\d\d-\d\d-\d\d\b", said), path


def test_what_stands_beside_the_packages_tells_the_same_game() -> None:
    scenario, network, objective, strategy = world("thesis/catch_the_thief")
    generated = files("thesis/catch_the_thief")
    again = read_network(generated["TGA.xml"].decode(), "TGA.xml")
    assert {a.name for a in again.automata} == {a.name for a in network.automata}
    assert read_query(generated["TCTL.q"].decode(), "TCTL.q") == objective
    plan = read_plan(generated["UPPAAL_plan.txt"].decode(), network, "plan")
    assert {b.state for b in plan.blocks} == {b.state for b in strategy.blocks if b.wait or b.commands}
    assert generated["catch_the_thief.pur"].decode() == scenario.text


def sent(generated: Dict[str, bytes], package: str) -> Dict[str, Dict[str, List[float]]]:
    """robot → place → pose, as the package's controller reads them."""
    content = read(generated[f"src/{package}/config/poses.yaml"])
    strategy = read(generated[f"src/{package}/config/strategy.yaml"])
    return read_poses(content).of(agent for agent in strategy["commands_agents"] if agent != "reachObj")


@pytest.mark.parametrize("name", ["thesis/catch_the_thief", "thesis/scenario_1"])
def test_two_robots_never_have_the_same_pose_at_one_place(name: str) -> None:
    distributed = files(name)
    apart: Dict[str, Dict[str, List[float]]] = {}
    for package in sorted(packages(distributed)):
        if package.startswith("controller_"):
            apart.update(sent(distributed, package))
    first, second = apart.values()
    places = read(distributed["src/UI/config/poses.yaml"])["poses"]
    assert first == places
    for place in places:
        assert math.dist(first[place][:2], second[place][:2]) >= 0.798
        assert first[place][2:] == second[place][2:]
    for shape in ("centralized", "general"):
        assert sent(files(name, shape), "controller") == apart


def test_the_format_of_poses_says_whether_robots_differ() -> None:
    for shape, package, number in (
        ("distributed", "controller_polBot2", 1),
        ("centralized", "controller", 2),
        ("centralized", "UI", 1),
    ):
        content = files("thesis/catch_the_thief", shape)[f"src/{package}/config/poses.yaml"]
        data = read(content)
        assert (data["format"], "robots" in data) == (number, number == 2)
        assert (b"0.8 m apart (--spot-distance)" in content) == (package != "UI")


def test_the_map_of_the_ui_has_the_spots_that_differ_from_their_places() -> None:
    made = files("thesis/catch_the_thief", "centralized")
    spots = read(made["src/UI/config/ui.yaml"])["spots"]
    own = read(made["src/controller/config/poses.yaml"])["robots"]
    assert spots == {robot: {place: pose[:2] for place, pose in table.items()} for robot, table in own.items()} != {}


def test_the_spot_distance_changes_poses_and_nothing_of_the_game() -> None:
    near, far = (generate(*world("thesis/scenario_1"), Options(spot_distance=metres)) for metres in (0.0, 3.0))
    for path in near:
        same = near[path] == far[path] or path.endswith("config/mission.yaml")
        poses = [f"src/controller_{bot}/config/poses.yaml" for bot in ("bot1", "bot2")]
        assert same == (path not in (*poses, "src/UI/config/ui.yaml"))
    assert sent(near, "controller_bot2")["bot2"] == sent(near, "controller_bot1")["bot1"]


def test_a_place_without_a_pose_demands_no_orientation_but_a_robot_with_a_pose_of_its_own_does() -> None:
    computed = read(files("thesis/scenario_1")["src/controller_bot1/config/poses.yaml"])["poses"]
    assert all(pose[3:] == [0.0] * 4 for pose in computed.values())
    measured = read(files("thesis/catch_the_thief")["src/controller_polBot1/config/poses.yaml"])["poses"]
    assert all(any(pose[3:]) for pose in measured.values())
    text = """
poi "a" //[0, 0, 0, 0, 0, 0, 1]
poi "b" //[x, y, z, qx, qy, qz, qw] bot1 [3, 0, 0, 0, 0, 1, 0]
connect a and b distance 3
event "e" location b duration 1
agent "bot1" controllable mobile 1 location a can_do e
agent "bot2" controllable mobile 1 location a
reach_objective: do e after 0
"""
    placed = placing(parse(text, "own.pur"), 0.8)
    of_bot1, of_bot2 = (
        read(poses_text(parse(text, "own.pur"), placed, [robot]))["poses"]["b"] for robot in ("bot1", "bot2")
    )
    assert (of_bot1[3:], of_bot2[3:]) == ([0.0, 0.0, 1.0, 0.0], [0.0] * 4)


def test_poses_are_the_authors_or_are_said_to_be_computed() -> None:
    given = read(files("thesis/catch_the_thief")["src/controller_polBot1/config/poses.yaml"])
    assert given["computed"] is False
    assert given["poses"]["a"] == pytest.approx([3.0, 1.54, 0.0, 0.0, 0.0, 0.67, 0.73], abs=0.01)
    computed = files("thesis/scenario_1")["src/UI/config/poses.yaml"]
    assert read(computed)["computed"] is True and b"Computed from the distances" in computed
    assert "computed from the distances" in files("thesis/scenario_1")["README.md"].decode()


@pytest.mark.parametrize("loader", ["SafeLoader", "CSafeLoader"])
def test_names_that_yaml_misreads_are_found_in_every_file(loader: str) -> None:
    if not hasattr(yaml, loader):
        pytest.skip("PyYAML was built without libyaml")
    text = """
        poi "on" poi "null" poi "y"
        connect on and null distance 2 one_way
        connect null and y distance 3
        event "off" location y
        agent "no" controllable mobile 1 location on can_do off
        reach_objective: do off
    """
    found = {
        path: yaml.load(content, Loader=getattr(yaml, loader))
        for path, content in generate_text(text, "yes").items()
        if path.endswith(".yaml")
    }
    assert found["src/observer/config/mission.yaml"]["scenario"] == "yes"
    assert len(found["src/observer/config/mission.yaml"]["mission"]) == 64
    assert found["src/observer/config/game.yaml"]["name"] == "yes"
    assert found["src/observer/config/controllers.yaml"]["controllers"][0] == "controller_no"
    assert set(found["src/UI/config/poses.yaml"]["poses"]) == {"on", "null", "y"}
    assert found["src/UI/config/ui.yaml"]["reports"] == ["no"]
    assert found["src/UI/config/ui.yaml"]["connections"] == [["on", "null", 2, "one_way"], ["null", "y", 3]]
    strategy = found["src/controller_no/config/strategy.yaml"]
    assert strategy["commands_agents"] == ["no"] and strategy["strategy"][0]["state"]["no"] == "on"
    model = found["src/observer/config/model.yaml"]
    assert [automaton["name"] for automaton in model["automata"]] == ["no", "reachObj"]
    assert all("no" in entry["state"] for entry in found["src/observer/config/cover.yaml"]["cover"])


def test_a_mission_of_several_objectives_names_them_all() -> None:
    found = files("airport/last_call")
    model = read(found["src/observer/config/model.yaml"])
    assert (model["format"], model["objective"]["goal"]) == (2, ["reachObj", "win"])
    assert model["objective"]["bad"] == ["reachObj", "late"]
    assert model["objective"]["says"] == {"reachObj": "do stamp and fetch within 26"}
    assert {automaton["name"]: automaton["kind"] for automaton in model["automata"]} == {
        "porter": "robot", "reachObj": "reach",
    }  # fmt: skip
    assert "reaches `stamp` and `fetch` within 26 time units, whatever" in found["README.md"].decode()
    readme = " ".join(files("hotel/two_bells")["README.md"].decode().split())
    for side in ("East", "West"):
        assert f"keeps `if ring{side} then serve{side} within 20`" in readme


def test_expectations_of_the_launch_tests() -> None:
    expected = json.loads(files("thesis/catch_the_thief")["src/catch_the_thief_bringup/test/expected.json"])
    assert expected["reach"] is True
    assert expected["robots"] == {"polBot1": "controller_polBot1", "polBot2": "controller_polBot2"}
    assert all(word.startswith("polBot1_") or word == "catch" for word in expected["commands"]["controller_polBot1"])
    assert "polBot1_going_a_to_b2b" in expected["ends"]
    assert set(expected["nodes"]) == {
        "observer", "UI", "simulator", "controllerObj", "controller_polBot1", "controller_polBot2",
    }


def test_a_trace_is_something_that_can_happen() -> None:
    generated = files("work_cell/work_cell")
    (step,) = read(generated["src/work_cell_bringup/test/trace.yaml"])
    assert step["do"].split(":")[-1] == "newBox"


@pytest.mark.parametrize("name", ["2fast", "my scenario", "a-b", "ä", ""])
def test_a_name_that_no_package_can_have_is_reported(name: str) -> None:
    scenario, network, objective, strategy = world("thesis/scenario_1")
    with pytest.raises(PursueError) as caught:
        generate(dataclasses.replace(scenario, name=name), network, objective, strategy, Options())
    (finding,) = caught.value.diagnostics
    assert finding.code == "WSP005" and "rename" in finding.hint


def test_two_packages_of_one_name_are_reported() -> None:
    scenario, network, objective, strategy = world("thesis/scenario_1")
    renamed = dataclasses.replace(scenario, name="controller_bot1")
    there = generate(renamed, network, objective, strategy, Options())
    assert "src/controller_bot1_bringup/package.xml" in there
    text = scenario.text.replace("bot1", "x_bringup")
    with pytest.raises(PursueError, match="same name"):
        generate_text(text, "controller_x")


def generate_text(text: str, name: str) -> Dict[str, bytes]:
    from pursue_gen.language import parse
    from pursue_gen.synthesis.solve import solve
    from pursue_gen.tga import scenario_objective, translate

    scenario = parse(text, f"{name}.pur", name)
    network, objective = translate(scenario), scenario_objective(scenario)
    strategy = solve(network, objective).strategy
    assert strategy is not None
    return generate(scenario, network, objective, strategy, Options())


def test_people_get_instructions_and_no_controller() -> None:
    text = (SCENARIOS / "thesis/scenario_1.pur").read_text().replace('"bot2" controllable', '"bot2" human controllable')
    generated = generate_text(text, "ward")
    nodes = {"controller_bot1", "controllerObj", "observer", "UI"}
    assert packages(generated) == {*nodes, "ward_bringup", *SHARED, *RECEIVING}
    (instructions,) = [read(t) for p, t in generated.items() if p.endswith("/config/people.yaml")]
    assert instructions["commands_agents"] == ["bot2"]


def test_writing_puts_the_folder_where_it_was_asked_for(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    scenario, network, objective, strategy = world("thesis/scenario_1")
    assert write_workspace(scenario, network, objective, strategy) == Path("workspace_out/scenario_1")
    assert (tmp_path / "workspace_out/scenario_1/src/observer/package.xml").is_file()
    there = tmp_path / "there"
    assert write_workspace(scenario, network, objective, strategy, folder=there) == there
    assert (there / "scenario_1.pur").read_text() == scenario.text


def test_templates_are_found() -> None:
    assert (templates_dir() / "common" / "package.xml.j2").is_file()


def test_each_command_of_the_strategy_reaches_a_package() -> None:
    scenario, network, _, strategy = world("thesis/catch_the_thief")
    generated = files("thesis/catch_the_thief")
    for sub in partition(strategy, network, scenario.agents):
        data = read(generated[f"src/{sub.controller}/config/strategy.yaml"])
        assert sum(len(entry["commands"]) for entry in data["strategy"]) == sub.commands


def test_the_simulator_tells_the_ends_that_no_controller_decides() -> None:
    settings = read(files("thesis/scenario_1")["src/UI/config/ui.yaml"])
    assert settings["reports"] == ["bot1", "bot2"]
    assert settings["nodes"] == ["observer", "controller_bot1", "controller_bot2", "controllerObj", "simulator"]
    assert read(files("thesis/scenario_1", "general")["src/UI/config/ui.yaml"])["reports"] == []


def test_the_page_gets_the_objectives_in_words_and_the_guaranteed_time() -> None:
    settings = read(files("thesis/catch_the_thief")["src/UI/config/ui.yaml"])
    assert settings["objectives"] == [{"name": "catch", "says": "catch happens.", "of": ["reachObj"]}]
    assert "guarantee" not in settings, "nobody has found it out"
    known = generate(*world("thesis/catch_the_thief"), Options(reaction=REACTION, guarantee=Fraction(43, 2)))
    assert read(known["src/UI/config/ui.yaml"])["guarantee"] == 21.5
    third = generate(*world("thesis/catch_the_thief"), Options(reaction=REACTION, guarantee=Fraction(64, 3)))
    assert read_promise(read(third["src/UI/config/ui.yaml"])).most == 21.334, "a decimal, rounded up"
    bells = generate(*world("hotel/two_bells"), Options(reaction=REACTION, answers={"obj": Fraction("11.004")}))
    told = read(bells["src/UI/config/ui.yaml"])["objectives"]
    assert [each.get("worst") for each in told] == [11.1, None]
    several = read(files("airport/last_call")["src/UI/config/ui.yaml"])["objectives"]
    assert [each["of"] for each in several] == [["reachObj"]] and "within 26 units" in several[0]["says"]


def test_the_page_gets_the_strategies_of_all_controllers_unless_they_are_large(monkeypatch: pytest.MonkeyPatch) -> None:
    path = "src/UI/config/strategies.yaml"
    found = files("thesis/catch_the_thief")
    written = read(found[path])["strategies"]
    assert list(written) == ["controller_polBot1", "controller_polBot2", "controllerObj"]
    for controller, data in written.items():
        assert data == read(found[f"src/{controller}/config/strategy.yaml"])
    assert found[path].count(b"\n") < 10, "one line each"
    monkeypatch.setattr(ui_file, "LARGEST", 10)
    assert path not in made("thesis/catch_the_thief")


def paths_in(readme: str) -> List[str]:
    return re.findall(r"\| `([^`]+)`", readme) + re.findall(r"\((\w+\.svg)\)", readme)


def test_the_readme_names_what_is_there(generated: Dict[str, bytes]) -> None:
    named = [p for cell in paths_in(generated["README.md"].decode()) for p in cell.split("`, `")]
    assert len(named) > 8
    there = {*generated, ".pursue_gen.json", *(f"src/{name}" for name in packages(generated))}
    assert set(named) <= there


def test_scenarios_of_the_project_can_all_be_packages() -> None:
    for path in sorted(SCENARIOS.rglob("*.pur")):
        assert re.fullmatch("[a-z][a-z0-9_]*", load(str(path)).name), path


def test_what_nodes_would_not_read_is_not_written(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys.modules["pursue_gen.workspace.generate"], "DATA", DATA._replace(size=500))
    with pytest.raises(PursueError, match="nodes read 0 MiB at most") as refused:
        made("thesis/scenario_1")
    assert refused.value.diagnostics[0].code == "WSP009"
