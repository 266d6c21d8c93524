"""A scenario, its game and a strategy for it → the files of a catkin workspace, in memory.

Pure: the same arguments give the same bytes, with no date and no path of the machine in them.
"""

from __future__ import annotations

import re
from dataclasses import replace
from typing import Any, Dict, List, Mapping, Optional, Sequence, Tuple

import jinja2

from pursue_gen import __version__
from pursue_gen.diagnostics import error, listed
from pursue_gen.drawing import map_svg
from pursue_gen.language.document import statement_text
from pursue_gen.language.labels import in_markdown
from pursue_gen.language.scenario import Reach, Safety, Scenario
from pursue_gen.language.sentences import condition_of_promise, end_words
from pursue_gen.language.times import time_units
from pursue_gen.outcomes import Invalid
from pursue_gen.partition import SubStrategy, partition, strategy_data, unneeded
from pursue_gen.partition.yaml_text import inline, yaml_text
from pursue_gen.synthesis.plan import write_plan
from pursue_gen.synthesis.strategy import Strategy
from pursue_gen.tga.event_words import event_word
from pursue_gen.tga.network import Network, Objective
from pursue_gen.tga.uppaal_write import write_network, write_query
from pursue_gen.workspace import context, deploy, game_file, model_file, ui_file
from pursue_gen.workspace.context import Options
from pursue_gen.workspace.packages import (
    RECEIVING,
    TEST_DEPENDS,
    Package,
    environment,
    files_of,
    message_package,
    runtime_package,
    templates_dir,
)
from pursue_gen.workspace.poses_text import poses_text
from pursue_gen.workspace.spots import placing
from pursue_runtime.bounded import DATA
from pursue_runtime.manifest import MISSION, Manifest, make_manifest, mission_file

_UI = "UI"
_PACKAGE_NAME = re.compile(r"[A-Za-z][A-Za-z0-9_]*", re.ASCII)
_PEOPLE = "people"
_VIEW = (520, 300)
"""Pixels of rviz's window that the places take, at most."""

_MISSION_DATA = re.compile(r"src/(\w+)/config/(\w+\.yaml)", re.ASCII)


def generate(
    scenario: Scenario, network: Network, objective: Objective, strategy: Strategy, options: Options
) -> Dict[str, bytes]:
    """path within the workspace → content.

    `network` is the game that the strategy was made for (its ends and slack included). Raises PursueError where the
    scenario's name cannot become a package's, and what `partition` raises.
    """
    _check_name(scenario)
    subs = partition(strategy, network, scenario.agents, options.controllers, options.reach_obj)
    controllers = [sub for sub in subs if sub.controller != _UI]
    where = placing(scenario, options.spot_distance)
    templates = templates_dir()
    jinja = environment(templates)
    trace = model_file.first_report(network)
    plan = write_plan(strategy, network, objective)
    values = context.common(scenario, objective, options, controllers)
    values["plays"] = _plays(scenario, trace)
    values["view"] = _view([(pose.x, pose.y) for pose in where.places.values()])
    data = {
        "poses": poses_text(scenario, where),
        "model": model_file.render(network, objective, scenario, options.reaction, __version__).encode(),
        "cover": strategy_data.render_cover(strategy, scenario.name, __version__).encode(),
        "game": game_file.render(scenario, options, strategy, plan, __version__).encode(),
        "expected": _expected(network, objective, scenario, controllers),
        "ui": ui_file.render(
            scenario, network, where, options, values["controllers"], values["reported"], __version__,
            [agent.name for agent in unneeded(scenario, strategy)],
        ),
        "strategies": ui_file.render_strategies(controllers, scenario, options.reaction, __version__) or b"",
        "controllers": _controllers(values),
        "trace": yaml_text([inline({"at": 2.0, "do": trace})] if trace else []).encode(),
    }
    files: Dict[str, bytes] = {}
    sent = {sub.controller: [agent for agent in sub.agents if agent in where.spots] for sub in subs}
    more = options.spare, options.levels
    poses_of = {controller: poses_text(scenario, where, robots, *more) for controller, robots in sent.items()}
    packages = _with_mission(_packages(scenario, subs, data, poses_of, options), scenario)
    _check_packages(packages)
    _check_sizes(packages)
    for package in packages:
        for path, content in files_of(package, values, jinja, templates).items():
            files[f"src/{package.name}/{path}"] = content
    files.update(_top_files(scenario, network, objective, plan))
    names = [package.name for package in packages]
    files.update(deploy.docker_files(jinja, values, names) if options.docker else {})
    files.update(deploy.systemd_files(jinja, values, options.machines) if options.systemd else {})
    files["map.svg"] = map_svg.draw(scenario, where.places, where.computed).encode()
    files["README.md"] = _readme(jinja, {**values, "margin": options.margin}, scenario, packages, where.computed)
    return files


def mission_of(scenario: str, files: Mapping[str, bytes]) -> Tuple[Manifest, Dict[str, bytes]]:
    """The mission in a workspace as `generate` returns it: its manifest, and `package/name.yaml` → content.

    It is all the data of the packages that have a mission.yaml, but for that file.
    """
    found = {}
    for path, content in files.items():
        match = _MISSION_DATA.fullmatch(path)
        if match and match.group(2) != MISSION and f"src/{match.group(1)}/config/{MISSION}" in files:
            found[f"{match.group(1)}/{match.group(2)}"] = content
    controllers = tuple(path.split("/")[0] for path in found if path.endswith("/strategy.yaml"))
    return make_manifest(scenario, __version__, controllers, found), found


def _with_mission(packages: Sequence[Package], scenario: Scenario) -> List[Package]:
    """The packages; those with data of the mission get its mission.yaml."""
    data = {
        f"src/{package.name}/{path}": content
        for package in packages
        if package.runs
        for path, content in {**package.data, f"config/{MISSION}": b""}.items()
    }
    text = mission_file(mission_of(scenario.name, data)[0].digest, scenario.name)
    return [
        replace(package, data={**package.data, f"config/{MISSION}": text})
        if f"src/{package.name}/config/{MISSION}" in data
        else package
        for package in packages
    ]


def _check_name(scenario: Scenario) -> None:
    if not _PACKAGE_NAME.fullmatch(scenario.name):
        message = (
            f"the scenario is called '{scenario.name}', and {context.bringup_of(scenario)} cannot be a ROS package; "
            "expected letters, digits and underscores, a letter first"
        )
        raise Invalid([error("WSP005", message, hint="rename the .pur file, for example to my_mission.pur")])


def _check_packages(packages: Sequence[Package]) -> None:
    """Two packages of one name would be one folder; on some disks also where the names differ in case only."""
    names = [package.name.lower() for package in packages]
    twice = sorted({package.name for package in packages if names.count(package.name.lower()) > 1})
    if twice:
        message = f"two packages would have the same name: {', '.join(twice)}"
        raise Invalid([error("WSP006", message, hint="rename the robot, or the .pur file")])


def _check_sizes(packages: Sequence[Package]) -> None:
    """What nodes would not read is not written."""
    for package in packages:
        for path, content in package.data.items():
            if path.startswith("config/") and len(content) > DATA.size:
                megabytes = f"{len(content) >> 20} MiB; nodes read {DATA.size >> 20} MiB at most"
                hint = "ask for less at once: a patrol by some robots in place of any robot, fewer places or robots"
                raise Invalid([error("WSP009", f"src/{package.name}/{path} would have {megabytes}", hint=hint)])


def _packages(
    scenario: Scenario,
    subs: Sequence[SubStrategy],
    data: Mapping[str, bytes],
    poses_of: Mapping[str, bytes],
    options: Options,
) -> List[Package]:
    """The packages with what their manifests say and their data, the controllers first; `poses_of` by controller."""
    packages = []
    people: Dict[str, bytes] = {}
    for sub in subs:
        text = strategy_data.render(sub, scenario.name, __version__, options.reaction).encode()
        if sub.controller == _UI:
            people = {f"config/{_PEOPLE}.yaml": text}
            continue
        commanded = " and ".join(sub.agents) or "nobody"
        summary = f"The controller that commands {commanded}."
        files = {"config/strategy.yaml": text, "config/poses.yaml": poses_of[sub.controller]}
        packages.append(Package(sub.controller, "controller", summary, files))
    observer = {f"config/{name}.yaml": data[name] for name in ("model", "cover", "controllers", "game")}
    packages.append(Package("observer", "observer", "The observer: keeps the state of the mission.", observer))
    ui = {"config/model.yaml": data["model"], "config/poses.yaml": data["poses"], **people}
    ui["config/ui.yaml"], ui["config/game.yaml"] = data["ui"], data["game"]
    ui.update({} if options.floor is None else ui_file.floor_files(options.floor, __version__))
    ui.update({"config/strategies.yaml": data["strategies"]} if data["strategies"] else {})
    packages.append(Package(_UI, _UI, "The user's side of the mission: start and events; the simulated robots.", ui))
    packages += [Package(name, name, summary, {}) for name, summary in RECEIVING.items()]
    packages += [message_package(), runtime_package()]
    tests = {"test/expected.json": data["expected"], "test/trace.yaml": data["trace"]}
    names = tuple(package.name for package in packages)
    bringup = context.bringup_of(scenario)
    summary = "Launch files and tests of the whole mission."
    packages.append(Package(bringup, "bringup", summary, tests, names, TEST_DEPENDS))
    return packages


def _plays(scenario: Scenario, trace: Optional[str]) -> List[str]:
    """The behaviours of uncontrollable agents in the launch tests: none, random, and the trace."""
    random = ["mode:=random seed:=1", "mode:=random seed:=2"]
    free = any(not agent.controllable for agent in scenario.agents)
    return ["mode:=still", *(random if free else []), *(["mode:=trace"] if trace else [])]


def _view(places: Sequence[Tuple[float, float]]) -> Dict[str, float]:
    """The view of rviz from above: its centre (`x`, `y`, in metres) and its `scale`, in pixels per metre."""
    low, high = ([pick(numbers) for numbers in zip(*places)] for pick in (min, max))
    metres = max(high[0] - low[0], (high[1] - low[1]) * _VIEW[0] / _VIEW[1], 1.0)
    x, y = ((a + b) / 2 for a, b in zip(low, high))
    return {"x": round(x, 3) + 0.0, "y": round(y, 3) + 0.0, "scale": round(_VIEW[0] / metres, 1)}


def _expected(network: Network, objective: Objective, scenario: Scenario, controllers: Sequence[SubStrategy]) -> bytes:
    commands = {}
    for sub in controllers:
        moves = [command.moves[0] for _, block in sub.blocks for command in block]
        commands[sub.controller] = [event_word(move.automaton, move.edge) for move in moves]
    robots = {agent.name for agent in scenario.agents if agent.is_robot}
    owner = {agent: sub.controller for sub in controllers for agent in sub.agents if agent in robots}
    nodes = ["observer", "simulator", _UI, *commands]
    return model_file.expected(network, objective, owner, commands, nodes)


def _controllers(values: Mapping[str, Any]) -> bytes:
    """The text of controllers.yaml: the nodes whose heartbeats the observer expects, and that a new plan goes to."""
    head = f"Written by pursue-gen {__version__} for the observer of {values['scenario']}."
    return yaml_text({"format": 1, "controllers": inline(values["controllers"])}, [head]).encode()


def _top_files(scenario: Scenario, network: Network, objective: Objective, plan: str) -> Dict[str, bytes]:
    """The files next to src/: scenario, network, query, plan."""
    return {
        f"{scenario.name}.pur": scenario.text.encode(),
        "TGA.xml": write_network(network, objective).encode(),
        "TCTL.q": write_query(objective).encode(),
        "UPPAAL_plan.txt": plan.encode(),
    }


def _readme(
    jinja: jinja2.Environment,
    values: Mapping[str, Any],
    scenario: Scenario,
    packages: Sequence[Package],
    computed: bool,
) -> bytes:
    nodes = [package.name for package in packages if package.runs]
    more = {"packages": packages, "nodes": nodes, "poses_computed": computed, "promise": _promise(scenario)}
    return jinja.get_template("workspace/README.md.j2").render({**values, **more}).encode()


def _promise(scenario: Scenario) -> str:
    """What the mission guarantees, in a sentence, with the names of the scenario."""
    parts = [_reaches(reach) for reach in scenario.reach]
    parts += [f"keeps `{_source(scenario, safety)}`" for safety in scenario.safety]
    assumed = in_markdown(scenario, condition_of_promise(scenario))
    kept = f"The mission {listed(parts)}, whatever the agents do that nobody controls{assumed and f', {assumed}'}."
    kept += "".join(f" {sentence}" for sentence in end_words(scenario))
    given_up = [f"`{one.objective.text}`" for one in scenario.given_up]
    return f"{kept} What is optional and had to be given up: {listed(given_up)}." if given_up else kept


def _reaches(reach: Reach) -> str:
    goal = "reaches " + listed(f"`{ref.name}`" for ref in reach.events)
    goal += f" {reach.often}" if reach.times > 1 else ""
    goal += "" if reach.apart is None else f", at least {time_units(reach.apart)} apart,"
    goal += f" after {time_units(reach.after)}" if reach.after else ""
    return goal.rstrip(",") if reach.within is None else f"{goal} within {time_units(reach.within)}"


def _source(scenario: Scenario, safety: Safety) -> str:
    """A safety objective as it stands in the scenario."""
    return statement_text(scenario.text, safety.span).split(":", 1)[-1].strip()
