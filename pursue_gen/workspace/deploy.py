"""A mission as services: containers (Docker compose) or systemd units, one for each node, and one for the ROS master.

The node's own parameters are the same everywhere; what differs is how their values are set: `${NAME:-value}` in
compose files, a file of variables for systemd.
"""

from __future__ import annotations

import json
import re
from dataclasses import dataclass
from functools import partial
from typing import Any, Dict, List, Mapping, Sequence, Tuple

import jinja2

from pursue_gen.workspace.machines import Machines
from pursue_gen.workspace.packages import SHARED

BASE = "base"
"""The name of the machine with observer and UI; each controller has a machine of its own."""
PORT = 13000
"""Where the desk reaches the first machine of a lab in containers; the next ones follow."""

_TRANSPORT = ("communication_manager", "pursue_reader")
_LONGEST_LABEL = 63
_NODE_ANSWERS = (
    "import sys; from xmlrpc.client import ServerProxy as At; "
    "At(At('http://master:11311').lookupNode('/health', sys.argv[1])[2]).getPid('/health')"
)
_MASTER_ANSWERS = "from xmlrpc.client import ServerProxy as At; At('http://master:11311').getPid('/health')"
DEBIAN_PACKAGES = (
    "python3-actionlib-msgs", "python3-cryptography", "python3-diagnostic-msgs", "python3-geometry-msgs",
    "python3-move-base-msgs", "python3-rospy", "python3-std-msgs", "python3-tf2-ros", "python3-tornado",
    "python3-transitions", "python3-yaml", "ros-core", "rosbash",
)
"""What the nodes need where they run, on Debian 12."""
NOETIC_PACKAGES = (
    "python3-cryptography", "python3-tornado", "python3-transitions", "python3-yaml", "ros-noetic-move-base-msgs",
    "ros-noetic-tf2-ros",
)
"""The same beside ros-noetic-ros-base."""


@dataclass(frozen=True)
class Setting:
    """A parameter of a node. `variable`: what sets it from outside, if anything; `text`: its value is no number."""

    name: str
    value: str
    variable: str = ""
    text: bool = False

    def argument(self, reference: str = "") -> str:
        """As rosrun takes it; a text is quoted, or YAML would read `off` as false."""
        value = reference or self.value
        return f"_{self.name}:='{value}'" if self.text else f"_{self.name}:={value}"


@dataclass(frozen=True)
class Service:
    """A node where it runs.

    `name`: a DNS label; `package` and `node` as ROS has them; `packages`: what its image holds; `machine`: whose
    volume it shares; `profile`: only then it is started; `ports`: host → container; `namespace`: in the ROS graph.
    """

    name: str
    package: str
    node: str
    settings: Tuple[Setting, ...]
    packages: Tuple[str, ...]
    machine: str
    profile: str = ""
    ports: Tuple[str, ...] = ()
    namespace: str = ""

    @property
    def command(self) -> List[str]:
        """For compose: `${NAME:-value}` where a variable may set it."""
        arguments = [one.argument(f"${{{one.variable}:-{one.value}}}" if one.variable else "") for one in self.settings]
        return ["rosrun", self.package, self.node, *arguments, *([f"__ns:={self.namespace}"] if self.namespace else [])]

    @property
    def built(self) -> Tuple[str, ...]:
        """The packages that its image is built from: its own, and those that all nodes share."""
        return (*SHARED, *self.packages)

    @property
    def health(self) -> List[str]:
        """A program that fails unless the node answers. (`rosnode ping` ends well for nodes that are gone, too.)"""
        return ["python3", "-c", _NODE_ANSWERS, self.path]

    @property
    def path(self) -> str:
        """The node's name in the ROS graph."""
        return f"{self.namespace}/{self.node}"


def docker_files(jinja: jinja2.Environment, values: Mapping[str, Any], packages: Sequence[str]) -> Dict[str, bytes]:
    """The folder docker/: path in the workspace → content. `packages`: those of the workspace."""
    controllers = values["controllers"]
    services = [*_mission(values, robots=False), *_transport_in_lab(controllers)]
    names = service_names([service.name for service in services])
    context = {
        **values,
        "packages": packages,
        "services": [(names[service.name], service) for service in services],
        "volumes": service_names([BASE, *controllers]),
        "debian_packages": DEBIAN_PACKAGES,
        "noetic_packages": NOETIC_PACKAGES,
        "project": values["scenario"].lower(),
        "robots": [(machine, PORT + number) for number, machine in enumerate([BASE, *controllers])],
        "json": partial(json.dumps, ensure_ascii=False),  # JSON is YAML in one line
        "master_health": ["python3", "-c", _MASTER_ANSWERS],
    }
    names_of_files = ("Dockerfile.debian", "Dockerfile.noetic", "compose.yaml", "lab.env", "robots.yaml", "README.md")
    files = {f"docker/{name}": _rendered(jinja, f"deploy/docker/{name}.j2", context) for name in names_of_files}
    files["docker/.env"] = _rendered(jinja, "deploy/docker/project.env.j2", context)  # setup.py ships no hidden files
    return files


def systemd_files(jinja: jinja2.Environment, values: Mapping[str, Any], machines: Machines) -> Dict[str, bytes]:
    """The folder systemd/: a unit for each node, one for the master, the file of variables, and how to install them."""
    services = [*_mission(values, robots=True), *(_of_machine(name) for name in _TRANSPORT)]
    nodes = [service.node for service in services if service.package not in _TRANSPORT]
    places = {node: machines.of("UI" if node == "doors" else node).host for node in nodes}
    context = {
        **values,
        "services": services,
        "master": machines.master,
        "places": places,
        "hosts": _hosts(places, machines.master),
        "variables": _variables(services),
    }
    files = {
        f"systemd/{name}": _rendered(jinja, f"deploy/systemd/{name}.j2", context)
        for name in ("pursue-roscore.service", "pursue.target", "pursue.env", "README.md")
    }
    for service in services:
        own = {**context, "service": service, "argument": _unit_argument}
        unit = _rendered(jinja, "deploy/systemd/node.service.j2", own)
        files[f"systemd/pursue-{service.node}.service"] = unit
    return files


def service_names(nodes: Sequence[str]) -> Dict[str, str]:
    """node → the name of its service: a DNS label (lower case, digits, hyphens), no two the same."""
    found: Dict[str, str] = {}
    for node in nodes:
        label = re.sub(r"[^a-z0-9]+", "-", node.lower()).strip("-")[: _LONGEST_LABEL - 4].rstrip("-") or "node"
        number, name = 1, label
        while name in found.values():
            number += 1
            name = f"{label}-{number}"
        found[node] = name
    return found


def _mission(values: Mapping[str, Any], robots: bool) -> List[Service]:
    """The nodes of the mission; for `robots` nothing is simulated, and no mission starts by itself."""
    controllers = list(values["controllers"])
    shared = (Setting("received", _bool(robots), "PURSUE_RECEIVED"), Setting("again", _bool(robots), "PURSUE_AGAIN"))
    unit = Setting("time_unit", repr(float(values["time_unit"])), "PURSUE_TIME_UNIT")
    mode = "random" if values["free_agents"] and not robots else "still"
    without = Setting("without", "simulator" if robots else "", "PURSUE_WITHOUT", text=True)
    own_page = Setting("host", "127.0.0.1", "PURSUE_PAGE_HOST", text=True), Setting("port", "8080", "PURSUE_PAGE_PORT")
    page_inside = Setting("host", "0.0.0.0", text=True), Setting("port", "8080")
    ui = (
        Setting("mode", mode, "PURSUE_MODE", text=True),
        Setting("web", _bool(robots), "PURSUE_WEB"),
        *(own_page if robots else page_inside),
        Setting("token", "", "PURSUE_TOKEN", text=True),
        Setting("autostart", _bool(not robots), "PURSUE_AUTOSTART"),
        Setting("wait", "60"),
        Setting("ends", _bool(robots)),
        without,
        Setting("also", "", "PURSUE_ALSO", text=True),
    )
    either = (
        Setting("simulated", _bool(not robots), "PURSUE_SIMULATE"),
        Setting("orders", "numbered", "PURSUE_ORDERS", text=True),
    )
    real = (
        Setting("goals", "action", "PURSUE_GOALS", text=True),
        Setting("ends", "result", "PURSUE_ENDS", text=True),
        Setting("on_stop", "cancel", "PURSUE_ON_STOP", text=True),
    )
    robot = (*either, *(real if robots else ()))
    planner = Setting("planner", "off", "PURSUE_PLANNER", text=True)
    page = ("127.0.0.1:${PURSUE_PAGE_PORT:-8080}:8080",)
    doors = Setting("adapter", "std_msgs" if robots else "simulated", "PURSUE_DOORS", text=True)
    bag = (Setting("file", "true"), without)
    return [
        Service("observer", "observer", "observer", (unit, planner, *shared), ("observer",), BASE),
        *(Service(name, name, name, (*robot, *shared), (name,), name) for name in controllers),
        Service("UI", "UI", "UI", (*ui, *shared), ("UI",), BASE, ports=page),
        *([] if robots else [Service("simulator", "UI", "simulator", shared, ("UI",), BASE)]),
        *([Service("doors", "UI", "doors", (doors, *shared), ("UI",), BASE)] if values["doors"] else []),
        Service("recorder", "UI", "recorder", (*bag, *shared), ("UI",), BASE, profile="record"),
    ]


def _transport_in_lab(controllers: Sequence[str]) -> List[Service]:
    """For each machine what takes missions from the desk: profile `lab`. Both share the machine's volume."""
    found = []
    machines = {BASE: ("observer", "UI"), **{name: (name,) for name in controllers}}
    for number, (machine, nodes) in enumerate(machines.items()):
        for package in _TRANSPORT:
            settings: Tuple[Setting, ...] = (Setting("keys", "/keys", text=True),)
            ports: Tuple[str, ...] = ()
            packages = (package, *nodes)  # the reader reports which of them are here
            if package == "communication_manager":
                settings = (*settings, Setting("host", "0.0.0.0", text=True), Setting("port", str(PORT)))
                ports, packages = (f"127.0.0.1:{PORT + number}:{PORT}",), (package,)
            name = f"{machine}_{package}"
            found.append(Service(name, package, package, settings, packages, machine, "lab", ports, f"/{machine}"))
    return found


def _of_machine(package: str) -> Service:
    """What takes missions from the desk, as a unit: one on each machine, in a namespace with the machine's name."""
    settings: Tuple[Setting, ...] = (Setting("nodes", "all", "PURSUE_NODES", text=True),)
    if package == "communication_manager":
        settings = (
            Setting("host", "127.0.0.1", "PURSUE_MISSION_HOST", text=True),
            Setting("port", str(PORT), "PURSUE_MISSION_PORT"),
        )
    return Service(package, package, package, settings, (package,), "", namespace="/${PURSUE_ROBOT}")


def _hosts(places: Mapping[str, str], master: str) -> Dict[str, List[str]]:
    """host → the units that it enables, the master's host first; the recorder is enabled by hand."""
    found: Dict[str, List[str]] = {master: ["pursue-roscore"]}
    for node, host in places.items():
        found.setdefault(host, []).extend([f"pursue-{node}"] if node != "recorder" else [])
    return {host: [*units, *(f"pursue-{name}" for name in _TRANSPORT)] for host, units in found.items()}


def _unit_argument(setting: Setting) -> str:
    """As a word of ExecStart, where systemd puts the variables in."""
    return f'"{setting.argument("${" + setting.variable + "}" if setting.variable else "")}"'


def _variables(services: Sequence[Service]) -> Dict[str, str]:
    """variable → its default value."""
    return {one.variable: one.value for service in services for one in service.settings if one.variable}


def _bool(value: bool) -> str:
    return "true" if value else "false"


def _rendered(jinja: jinja2.Environment, template: str, values: Mapping[str, Any]) -> bytes:
    return jinja.get_template(template).render(values).encode()
