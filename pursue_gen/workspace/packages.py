"""The files of one catkin package: its kind's templates, the modules it imports from the common ones, and its data.

Templates stand file for file as they will in the workspace. Those of a kind come before those in `common/`; of
`common/scripts`, and of the desk's own modules (DESK), a package gets what its scripts import, and what that
imports. `.j2` files are rendered (see context.py), others are copied; a script that is called like the kind gets the
package's name.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Dict, Iterator, List, Mapping, Tuple

import jinja2

_COMMON = "common"
_IMPORT = re.compile(r"^(?:from|import) +(\w+)", re.MULTILINE)
_DESK_IMPORT = re.compile(r"^from pursue_gen\.\w+\.(\w+) import ", re.MULTILINE)

DEPENDS: Mapping[str, Tuple[str, ...]] = {
    "controller": (
        "rospy", "std_msgs", "geometry_msgs", "diagnostic_msgs", "rosgraph_msgs", "python3-yaml",
        "actionlib_msgs", "move_base_msgs", "tf2_ros",
    ),
    "observer": ("rospy", "std_msgs", "diagnostic_msgs", "rosgraph_msgs", "python3-yaml", "python3-transitions"),
    "UI": (
        "rospy", "std_msgs", "geometry_msgs", "diagnostic_msgs", "rosgraph_msgs", "rosbag", "python3-yaml",
        "python3-tornado",
    ),
    "communication_manager": (
        "rospy", "std_msgs", "diagnostic_msgs", "rosgraph_msgs", "python3-yaml", "python3-cryptography",
        "python3-tornado",
    ),
    "pursue_reader": (
        "rospy", "std_msgs", "diagnostic_msgs", "rosgraph_msgs", "python3-yaml", "python3-cryptography",
    ),
    "bringup": ("roslaunch",),
}
"""What the nodes of each kind of package need where they run: ROS packages, and rosdep keys."""

RECEIVING: Mapping[str, str] = {
    "communication_manager": "Takes missions from the desk, over HTTP.",
    "pursue_reader": "Checks missions from the desk, keeps them, and has them played.",
}
"""The packages of a robot that gets its missions from the desk, their names are their kinds; what each is for."""

DESK = ("transport/mission_bundle.py", "workspace/mission_manifest.py")
"""Modules of pursue_gen that robots have as well, in scripts/ like the common ones."""

TEST_DEPENDS = ("rostest", "rospy", "std_msgs", "geometry_msgs", "diagnostic_msgs")


@dataclass(frozen=True)
class Package:
    """A package to be: its kind (a folder of templates), what its manifest says, data files by path within it."""

    name: str
    kind: str
    summary: str
    data: Mapping[str, bytes]
    depends: Tuple[str, ...] = ()
    test_depends: Tuple[str, ...] = ()


def templates_dir() -> Path:
    """The templates of catkin packages: beside the installed generator, or in the checkout it runs from."""
    package = Path(__file__).resolve().parent.parent
    installed = package / "_templates"
    return installed if installed.is_dir() else package.parent / "templates" / "catkin"


def environment(templates: Path) -> jinja2.Environment:
    """How templates are rendered: unknown names are errors, tags leave no lines behind."""
    return jinja2.Environment(
        loader=jinja2.FileSystemLoader(str(templates)),
        undefined=jinja2.StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
        keep_trailing_newline=True,
    )


def files_of(
    package: Package, values: Mapping[str, Any], jinja: jinja2.Environment, templates: Path
) -> Dict[str, bytes]:
    """path within the package → content."""
    context = {**values, "package": package.name, "summary": package.summary}
    if package.kind == "controller":
        context["controller"] = package.name
    context["exec_depends"] = (*DEPENDS[package.kind], *package.depends)
    context["test_depends"] = package.test_depends
    own, shared = _folder(templates / package.kind), {**_folder(templates / _COMMON), **_desk()}
    if package.kind == "bringup":  # no nodes of its own
        shared = {}
    late = ("package.xml", "CMakeLists.txt")  # they list what the others are
    files = {
        _renamed(path, package): _content(template, context, jinja, templates)
        for path, template in own.items()
        if path not in late
    }
    files.update(_imported(files, shared, context, jinja, templates))
    files.update(package.data)
    context.update(_lists(files))
    for path in late:
        files[path] = _content({**shared, **own}[path], context, jinja, templates)
    return files


def _folder(folder: Path) -> Dict[str, Path]:
    """path in the package → template."""
    found = {}
    for place in sorted(folder.rglob("*")):
        if place.is_file() and "__pycache__" not in place.parts:
            path = place.relative_to(folder).as_posix()
            found[path[:-3] if path.endswith(".j2") else path] = place
    return found


def _desk() -> Dict[str, Path]:
    """path in the package → the desk's own module."""
    generator = Path(__file__).resolve().parent.parent
    return {f"scripts/{Path(path).name}": generator / path for path in DESK}


def desk_modules(context: Mapping[str, Any]) -> Dict[str, bytes]:
    """file name → content of the modules that desk and robots share, as they stand in a package."""
    return {path.name: _desk_module(path, context) for path in _desk().values()}


def _desk_module(path: Path, context: Mapping[str, Any]) -> bytes:
    head = f"# Generated by pursue-gen {context['generator']} from {context['scenario']}.pur\n"
    return (head + _DESK_IMPORT.sub(r"from \1 import ", path.read_text(encoding="utf-8"))).encode()


def _renamed(path: str, package: Package) -> str:
    """`scripts/controller` is `scripts/controller_bot1` in the package controller_bot1."""
    return f"scripts/{package.name}" if path == f"scripts/{package.kind}" else path


def _content(template: Path, context: Mapping[str, Any], jinja: jinja2.Environment, templates: Path) -> bytes:
    if template in _desk().values():
        return _desk_module(template, context)
    if template.suffix != ".j2":
        return template.read_bytes()
    return jinja.get_template(template.relative_to(templates).as_posix()).render(context).encode()


def _imported(
    files: Mapping[str, bytes],
    shared: Mapping[str, Path],
    context: Mapping[str, Any],
    jinja: jinja2.Environment,
    templates: Path,
) -> Dict[str, bytes]:
    """The modules of the common ones and of the desk's that these scripts import, with those that these import."""
    found: Dict[str, bytes] = {}
    waiting: List[bytes] = [content for path, content in sorted(files.items()) if path.startswith("scripts/")]
    while waiting:
        for module in _IMPORT.findall(waiting.pop().decode()):
            path = f"scripts/{module}.py"
            if path in shared and path not in found and path not in files:
                found[path] = _content(shared[path], context, jinja, templates)
                waiting.append(found[path])
    return found


def _lists(files: Mapping[str, bytes]) -> Dict[str, List[str]]:
    """What CMakeLists.txt installs and tests."""
    scripts = [path for path in sorted(files) if path.startswith("scripts/")]
    nodes = [path for path in scripts if files[path].startswith(b"#!")]
    return {
        "nodes": list(_names(nodes)),
        "modules": list(_names(path for path in scripts if path not in nodes)),
        "folders": sorted({path.split("/")[0] for path in files if "/" in path} - {"scripts"}),
    }


def _names(paths: Any) -> Iterator[str]:
    return (path.split("/", 1)[1] for path in paths)
