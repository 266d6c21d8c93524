"""machines.yaml: which machine runs which node of the mission, and where the ROS master is.

    format: 1
    master: base.local
    machines:
      base.local: {nodes: [observer, UI]}
      bot1.local: {nodes: [controller_bot1], user: ros, env_loader: /home/ros/mission/devel/env.sh}

A node that is not listed runs on the master's machine; without `master` that is the machine of roslaunch.
"""

from __future__ import annotations

import difflib
import re
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Dict, List, Optional, Sequence, Tuple

from pursue_gen.diagnostics import Diagnostic, PursueError, Span, error, in_order, warning
from pursue_gen.files import compose_yaml, read_text, span_of
from pursue_gen.language.similar import closest
from pursue_runtime.reader.packages import UI_NODES

HERE = "localhost"
_HOST = re.compile(r"(?=.{1,253}\Z)[A-Za-z0-9]([A-Za-z0-9_-]*[A-Za-z0-9])?(\.[A-Za-z0-9]([A-Za-z0-9_-]*[A-Za-z0-9])?)*")
_USER = re.compile(r"[A-Za-z_][A-Za-z0-9_.-]*", re.ASCII)
_PATH = re.compile(r"~?/[A-Za-z0-9_./+-]*", re.ASCII)  # ssh gives it to a shell
_KEYS = ("format", "master", "machines")
_MACHINE_KEYS = ("nodes", "user", "env_loader")
_EXAMPLE = "for example   bot1.local: {nodes: [controller_bot1], user: ros, env_loader: /home/ros/mission/devel/env.sh}"


@dataclass(frozen=True)
class Machine:
    """A machine: its host name or address, the nodes it runs, who logs in there, and what sets up ROS there."""

    host: str
    nodes: Tuple[str, ...]
    user: str = ""
    env_loader: str = ""


@dataclass(frozen=True)
class Machines:
    """Where the nodes run. `master`: the host of the ROS master, and of every node that is not listed."""

    master: str = HERE
    machines: Tuple[Machine, ...] = ()

    def of(self, node: str) -> Machine:
        """The machine that runs this node."""
        for machine in self.machines:
            if node in machine.nodes:
                return machine
        for machine in self.machines:
            if machine.host == self.master:
                return machine
        return Machine(self.master, ())


ONE_MACHINE = Machines()
"""All nodes run on the machine on which they are launched."""


def nodes_of(controllers: Sequence[str]) -> Tuple[str, ...]:
    """Every node of a mission with these controllers, in the order of the launch file."""
    return ("observer", *controllers, *UI_NODES)


def read_machines(file: Path, controllers: Sequence[str]) -> Tuple[Machines, Tuple[Diagnostic, ...]]:
    """The machines of a machines.yaml for a mission with these controllers, and warnings about it.

    Raises PursueError with all that is wrong in it (exit status 2).
    """
    text = read_text(file, "a file of machines, such as machines.yaml")
    return parse_machines(text, str(file), nodes_of(controllers))


def parse_machines(text: str, file: str, nodes: Sequence[str]) -> Tuple[Machines, Tuple[Diagnostic, ...]]:
    """The same for a text; `file` is its name in messages."""
    reader = _MachinesReader(file, nodes)
    found = reader.read(compose_yaml(text, file, "TRN040", _EXAMPLE))
    if reader.problems:
        raise PursueError(in_order(reader.problems))
    unplaced = [node for node in nodes if node not in reader.placed]
    if not unplaced:
        return found, ()
    where = "the machine that launches" if found.master == HERE else found.master
    message = f"on no machine, so they stay on {where}: {', '.join(unplaced)}"
    return found, (warning("TRN043", message, Span(file, 1, 1, 1, 1), "name them under a machine's nodes"),)


class _MachinesReader:
    """Reads PyYAML's tree once; collects the errors, and the machine of each node."""

    def __init__(self, file: str, nodes: Sequence[str]) -> None:
        self.file, self.nodes = file, nodes
        self.problems: List[Diagnostic] = []
        self.placed: Dict[str, str] = {}

    def read(self, root: Any) -> Machines:
        """The whole file."""
        if root is None:
            self.wrong(None, "it is empty", f"write format: 1, machines: and the machines; {_EXAMPLE}")
            return ONE_MACHINE
        top = self.mapping(root, "this file", _KEYS)
        if "format" not in top:
            self.wrong(root, "the line format: 1 is missing", "write it on top")
        elif self.text(top["format"]) != "1":
            self.wrong(top["format"], "this format is not known", "write format: 1, or use a newer pursue-gen")
        if "machines" not in top:
            self.wrong(root, "machines: is missing", f"write machines: and below it each machine; {_EXAMPLE}")
        master = self.matching(top.get("master"), _HOST, "a host name or an address, such as base.local") or HERE
        machines = self.mapping(top["machines"], "machines", None) if "machines" in top else {}
        return Machines(master, tuple(self.machine(host, node) for host, node in machines.items()))

    def machine(self, host: str, node: Any) -> Machine:
        """One machine's line."""
        fields = self.mapping(node, f"the machine {host}", _MACHINE_KEYS)
        if node.id == "mapping" and "nodes" not in fields:
            self.wrong(node, f"{host} has no nodes", _EXAMPLE)
        names = [name for name in self.names(fields.get("nodes"), host) if self.known(name, host)]
        user = self.matching(fields.get("user"), _USER, "the name of a user")
        path = "a path without blanks that begins with / or ~/, such as /home/ros/mission/devel/env.sh"
        loader = self.matching(fields.get("env_loader"), _PATH, path)
        return Machine(host, tuple(self.text(name) for name in names), user, loader)

    def names(self, node: Any, host: str) -> List[Any]:
        """The list of nodes."""
        if node is None:
            return []
        if not (isinstance(node.value, list) and node.id == "sequence"):
            self.wrong(node, f"the nodes of {host} are not a list", "write them as [observer, UI]")
            return []
        return list(node.value)

    def known(self, node: Any, host: str) -> bool:
        """True for a node of this mission that has no machine yet."""
        name = self.text(node)
        if name not in self.nodes:
            close = difflib.get_close_matches(name, self.nodes, n=1, cutoff=0.5)
            expected = f"the nodes are {', '.join(self.nodes)}"
            hint = f"did you mean {close[0]}? {expected}" if close else expected
            self.problems.append(error("TRN041", f"there is no node '{name}'", self.span(node), hint))
            return False
        if name in self.placed:
            message = f"{name} is on {self.placed[name]} already"
            self.problems.append(error("TRN042", message, self.span(node), "a node runs on one machine: name it once"))
            return False
        self.placed[name] = host
        return True

    def mapping(self, node: Any, what: str, keys: Optional[Sequence[str]]) -> Dict[str, Any]:
        """key → value; without `keys` the keys are host names."""
        if node.id != "mapping":
            self.wrong(node, f"{what} is no list of settings", f"write name: value lines; {_EXAMPLE}")
            return {}
        found: Dict[str, Any] = {}
        for key, value in node.value:
            name = self.text(key)
            if keys is not None and name not in keys:
                meant = closest(name, tuple(keys))
                hint = f"did you mean {meant}?" if meant else f"expected {', '.join(keys)}"
                self.wrong(key, f"{what} has no setting '{name}'", hint)
            elif keys is None and not _HOST.fullmatch(name):
                self.wrong(key, f"'{name}' is no host name", "write a host name or an address, such as bot1.local")
            elif name in found:
                span, hint = self.span(key), "put both into one"
                self.problems.append(error("TRN042", f"'{name}' stands here twice", span, hint))
            else:
                found[name] = value
        return found

    def matching(self, node: Any, pattern: "re.Pattern[str]", expected: str) -> str:
        """A text of this form; empty where there is none."""
        text = "" if node is None else self.text(node)
        if node is not None and not pattern.fullmatch(text):
            self.wrong(node, f"'{text}' cannot be used here" if text else "a text is missing here", f"write {expected}")
            return ""
        return text

    def text(self, node: Any) -> str:
        """A single value as it is written; empty for lists and the like."""
        return str(node.value) if node.id == "scalar" else ""

    def wrong(self, node: Any, message: str, hint: str) -> None:
        """Add an error with the code TRN040."""
        self.problems.append(error("TRN040", message, self.span(node), hint))

    def span(self, node: Any) -> Span:
        """The span of a node of the tree."""
        return span_of(node, self.file)
