"""Machines for the tests: network namespaces with cables to one switch, which can be cut and mended. Needs root."""

from __future__ import annotations

import contextlib
import functools
import os
import shutil
import subprocess
import uuid
from pathlib import Path
from typing import Dict, Iterator, Sequence

HOSTS = Path("/etc/netns")


def _mark() -> str:
    """How names begin that neither a run beside this one has, nor one that was killed and has left its own behind."""
    return f"pursue-{uuid.uuid4().hex[:12]}"


@functools.lru_cache(maxsize=None)
def why_not() -> str:
    """Why this machine cannot have network namespaces; empty if it can."""
    if not hasattr(os, "geteuid") or os.geteuid() != 0:
        return "network namespaces need root"
    if shutil.which("ip") is None:
        return "network namespaces need the command ip (package iproute2)"
    probe = f"{_mark()}-probe"
    commands = (("netns", "add", probe), ("-n", probe, "link", "add", "bridge0", "type", "bridge"),
                ("-n", probe, "link", "add", "end1", "type", "veth", "peer", "name", "end2"))
    try:
        for command in commands:
            done = subprocess.run(["ip", *command], capture_output=True, text=True, check=False)
            if done.returncode:
                return f"no network namespaces here: ip {' '.join(command)}: {done.stderr.strip()}"
    finally:
        subprocess.run(["ip", "netns", "del", probe], capture_output=True, check=False)
    return ""


class Lab:
    """Machines by name, each a namespace, and a switch in a namespace of its own: nothing touches the real network."""

    def __init__(self, machines: Sequence[str]) -> None:
        self.addresses: Dict[str, str] = {name: f"10.77.0.{i + 1}" for i, name in enumerate(machines)}
        self._mark = _mark()
        self._ports = {name: f"port{i}" for i, name in enumerate(machines)}

    def space(self, machine: str) -> str:
        """The name of its namespace."""
        return f"{self._mark}-{machine}"

    def build(self) -> None:
        """Makes namespaces, cables and the switch."""
        switch = self.space("switch")
        _ip("netns", "add", switch)
        _ip("-n", switch, "link", "add", "bridge0", "type", "bridge")
        _ip("-n", switch, "link", "set", "bridge0", "up")
        hosts = "127.0.0.1 localhost\n" + "".join(f"{at} {name}\n" for name, at in self.addresses.items())
        for name, address in self.addresses.items():
            space, port = self.space(name), self._ports[name]
            _ip("netns", "add", space)
            _ip("-n", space, "link", "add", "cable", "type", "veth", "peer", "name", port, "netns", switch)
            _ip("-n", space, "addr", "add", f"{address}/24", "dev", "cable")
            for device in ("lo", "cable"):
                _ip("-n", space, "link", "set", device, "up")
            _ip("-n", switch, "link", "set", port, "up")
            self.mend(name)
            (HOSTS / space).mkdir(parents=True, exist_ok=True)
            (HOSTS / space / "hosts").write_text(hosts, encoding="utf-8")

    def remove(self) -> None:
        """Removes all of it; to be called also where `build` has failed."""
        for name in (*self.addresses, "switch"):
            space = self.space(name)
            subprocess.run(["ip", "netns", "del", space], capture_output=True, check=False)
            shutil.rmtree(HOSTS / space, ignore_errors=True)  # HOSTS stays: another run may be about to write there

    def cut(self, machine: str) -> None:
        """From now on nothing gets to the machine or from it; neither end is told."""
        _ip("-n", self.space("switch"), "link", "set", self._ports[machine], "nomaster")

    def mend(self, machine: str) -> None:
        """The cable carries again."""
        _ip("-n", self.space("switch"), "link", "set", self._ports[machine], "master", "bridge0")

    def at(self, machine: str, command: str) -> str:
        """The shell command, to be run on this machine."""
        return f"exec ip netns exec {self.space(machine)} bash -c '{command}'"

    def variables(self, machine: str, master: str) -> Dict[str, str]:
        """What ROS needs to know on this machine."""
        return {"ROS_MASTER_URI": f"http://{master}:11311", "ROS_HOSTNAME": machine}


@contextlib.contextmanager
def lab(*machines: str) -> Iterator[Lab]:
    """A lab, removed in the end."""
    made = Lab(machines)
    try:
        made.build()
        yield made
    finally:
        made.remove()


def _ip(*command: str) -> None:
    subprocess.run(["ip", *command], check=True, capture_output=True, text=True)
