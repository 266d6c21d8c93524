"""The files of one catkin package: its kind's templates, a script for each of its nodes, and its data.

Templates stand file for file as they will in the workspace. Those of a kind come before those in `common/`. `.j2` files
are rendered (see context.py), others are copied. What the nodes do is in the package `pursue_runtime`, which holds the
run time verbatim.
"""

from __future__ import annotations

import functools
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Dict, List, Mapping, Tuple

import jinja2

import pursue_runtime

RUNTIME = "pursue_runtime"
"""The package with the run time, and its kind."""

MESSAGES = "pursue_msgs"
"""The package with the messages of the run time, and its kind."""

SHARED = (MESSAGES, RUNTIME)
"""The packages that each machine needs beside those of its nodes."""

_COMMON = "common"
_NODE_SCRIPT = "common/node.j2"

DEPENDS: Mapping[str, Tuple[str, ...]] = {
    MESSAGES: ("message_runtime",),
    RUNTIME: (MESSAGES, "rospy", "std_msgs", "geometry_msgs", "diagnostic_msgs", "rosgraph_msgs", "python3-yaml"),
    "controller": (RUNTIME, "actionlib_msgs", "move_base_msgs", "tf2_ros"),
    "observer": (RUNTIME, "python3-transitions"),
    "UI": (RUNTIME, "rosbag", "tf2_ros", "python3-tornado"),
    "communication_manager": (RUNTIME, "python3-cryptography", "python3-tornado"),
    "pursue_reader": (RUNTIME, "python3-cryptography"),
    "bringup": ("roslaunch",),
}
"""What the nodes of each kind of package need where they run: ROS packages, and rosdep keys."""

BUILD_DEPENDS: Mapping[str, Tuple[str, ...]] = {MESSAGES: ("message_generation",)}
"""What a kind of package needs where it is built, beside catkin."""

RECEIVING: Mapping[str, str] = {
    "communication_manager": "Takes missions from the desk, over HTTP.",
    "pursue_reader": "Checks missions from the desk, keeps them, and has them played.",
}
"""The packages of a robot that gets its missions from the desk, their names are their kinds; what each is for."""

TEST_DEPENDS = (RUNTIME, "rostest", "rospy", "std_msgs", "geometry_msgs", "diagnostic_msgs")


@dataclass(frozen=True)
class Node:
    """A node of a package: the module of the run time that it runs, and what it is, in a sentence."""

    module: str
    summary: str


NODES: Mapping[str, Mapping[str, Node]] = {
    "controller": {"": Node("nodes.controller", "")},
    "observer": {"": Node("nodes.observer", "")},
    "UI": {
        "": Node("nodes.ui", ""),
        "simulator": Node("nodes.simulator", "The simulated robots, people and other agents."),
        "sim_clock": Node("nodes.sim_clock", "Simulated time, for missions that run faster than life."),
        "doors": Node("nodes.doors", "Has doors opened for robots, and lifts come."),
        "recorder": Node("nodes.recorder", "Records a mission in a bag."),
        "markers": Node("nodes.markers", "Shows the mission in rviz."),
        "drive_legs": Node("nodes.drive_legs", "Drives robots along all ways, and records how long all takes."),
    },
    "bringup": {"run_mission": Node("ui.run_mission", "Launches the mission, and exits with the verdict.")},
    "communication_manager": {"": Node("nodes.communication_manager", "")},
    "pursue_reader": {
        "": Node("nodes.pursue_reader", ""),
        "missions": Node("reader.listing", "Lists the missions that this machine keeps."),
    },
}
"""The nodes of each kind of package by the name of their script, "" for the one that is called like the package and
does what that is for."""


@dataclass(frozen=True)
class Package:
    """A package to be: its kind (a folder of templates), its manifest's entries, data files by path within it."""

    name: str
    kind: str
    summary: str
    data: Mapping[str, bytes]
    depends: Tuple[str, ...] = ()
    test_depends: Tuple[str, ...] = ()

    @property
    def runs(self) -> bool:
        """True where it is a node of the mission."""
        return self.kind not in ("bringup", *SHARED, *RECEIVING)


def templates_dir() -> Path:
    """The templates of catkin packages: beside the installed generator, or in the checkout it runs from."""
    package = Path(__file__).resolve().parent.parent
    installed = package / "_templates"
    return installed if installed.is_dir() else package.parent / "templates" / "catkin"


@functools.lru_cache(maxsize=8)
def environment(templates: Path) -> jinja2.Environment:
    """How templates are rendered: unknown names are errors, tags leave no lines behind. Each is compiled once."""
    return jinja2.Environment(
        loader=jinja2.FileSystemLoader(str(templates)),
        undefined=jinja2.StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
        keep_trailing_newline=True,
    )


@functools.lru_cache(maxsize=None)
def runtime_package() -> Package:
    """The package that holds the run time, byte for byte as it is imported here; read once in a process."""
    root = Path(pursue_runtime.__file__).resolve().parent
    files = {f"src/{RUNTIME}/{path}": content for path, content in _tree(root).items()}
    return Package(RUNTIME, RUNTIME, "What the nodes of a mission do: the same in every workspace.", files)


def message_package() -> Package:
    """The package with the messages."""
    return Package(MESSAGES, MESSAGES, "The messages of a mission: the same in every workspace.", {})


def files_of(
    package: Package, values: Mapping[str, Any], jinja: jinja2.Environment, templates: Path
) -> Dict[str, bytes]:
    """path within the package → content. Raises catkin_pkg's InvalidPackage where catkin would refuse the manifest."""
    context = {**values, "package": package.name, "summary": package.summary}
    context["exec_depends"] = (*DEPENDS[package.kind], *package.depends)
    context["build_depends"] = BUILD_DEPENDS.get(package.kind, ())
    context["test_depends"] = package.test_depends
    context["origin"] = "" if package.name in SHARED else f" from {values['scenario']}.pur"
    nodes = {name or package.name: node for name, node in NODES.get(package.kind, {}).items()}
    files = {f"scripts/{name}": _script(node, context, jinja) for name, node in nodes.items()}
    files.update(package.data)
    context.update(nodes=sorted(nodes), python_packages=_python_packages(package), folders=_folders(files))
    own = _templates_of(templates / package.kind)
    context["folders"] = sorted({*context["folders"], *_folders(own)})
    context["messages"] = [Path(path).name for path in own if path.endswith(".msg")]
    context["services"] = [Path(path).name for path in own if path.endswith(".srv")]
    for path, template in {**_templates_of(templates / _COMMON), **own}.items():
        files[path] = _content(template, context, jinja, templates)
    _check_manifest(files["package.xml"], f"src/{package.name}/package.xml")
    return files


def _check_manifest(manifest: bytes, path: str) -> None:
    """Raises InvalidPackage, with the path, where catkin would refuse the text of a package.xml."""
    from catkin_pkg.package import parse_package_string  # few commands write manifests

    parse_package_string(manifest.decode(), path, warnings=[])  # names with upper-case letters get a warning


def _tree(folder: Path) -> Dict[str, bytes]:
    """path below the folder → content, without what Python keeps there."""
    places = (place for place in sorted(folder.rglob("*")) if place.is_file() and "__pycache__" not in place.parts)
    return {place.relative_to(folder).as_posix(): place.read_bytes() for place in places}


def _templates_of(folder: Path) -> Dict[str, Path]:
    """path in the package → template."""
    found = {}
    for place in sorted(folder.rglob("*")):
        if place.is_file() and "__pycache__" not in place.parts and place.name != Path(_NODE_SCRIPT).name:
            path = place.relative_to(folder).as_posix()
            found[path[:-3] if path.endswith(".j2") else path] = place
    return found


def _script(node: Node, context: Mapping[str, Any], jinja: jinja2.Environment) -> bytes:
    """The script that starts a node."""
    folder, _, module = node.module.rpartition(".")
    names = {"folder": f"{RUNTIME}.{folder}", "module": module, "does": node.summary or context["summary"]}
    return jinja.get_template(_NODE_SCRIPT).render({**context, **names}).encode()


def _content(template: Path, context: Mapping[str, Any], jinja: jinja2.Environment, templates: Path) -> bytes:
    if template.suffix != ".j2":
        return template.read_bytes()
    return jinja.get_template(template.relative_to(templates).as_posix()).render(context).encode()


def _python_packages(package: Package) -> List[str]:
    """The Python packages in `src/`, by their dotted names."""
    found = (path.split("/")[1:-1] for path in package.data if path.startswith("src/") and path.endswith("__init__.py"))
    return sorted(".".join(parts) for parts in found)


def _folders(files: Mapping[str, object]) -> List[str]:
    """The folders that are installed as they are."""
    return sorted({path.split("/")[0] for path in files if "/" in path} - {"scripts", "src"})
