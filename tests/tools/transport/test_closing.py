"""What docs/security.md says about firewall and tunnel, done as it stands there; machines are network namespaces."""

from __future__ import annotations

import contextlib
import re
import shutil
import subprocess
import sys
from pathlib import Path
from typing import ContextManager, Dict, Iterator, Tuple

import pytest

from tests.namespaces import Lab, lab, why_not
from tests.waiting import until

PAGE = Path(__file__).resolve().parents[3] / "docs" / "security.md"
ROSCORE, MANAGER = 11311, 13000
OPEN = 22  # the firewall lets it through, and nothing listens there


def why_not_here() -> str:
    """Why this machine cannot do what the page says; empty if it can."""
    missing = [name for name in ("nft", "wg", "wg-quick", "wireguard-go") if shutil.which(name) is None]
    if why_not() or missing:
        return why_not() or f"not installed here: {', '.join(missing)}"
    needs = {"nftables": "nft add table inet probe", "tunnels": "ip link add wg0 type wireguard || : <>/dev/net/tun"}
    for what, command in needs.items():
        if subprocess.run(["unshare", "--net", "bash", "-c", command], capture_output=True, check=False).returncode:
            return f"the system here has no {what}"
    return ""


WHY_NOT = why_not_here()
pytestmark = pytest.mark.skipif(bool(WHY_NOT), reason=WHY_NOT)

SERVER = """
import socket, sys, threading
def serve(port):
    server = socket.create_server(("0.0.0.0", port))
    print("listens", flush=True)
    while True:
        server.accept()[0].close()
for port in (11311, 13000):
    threading.Thread(target=serve, args=(port,)).start()
"""
KNOCK = """
import socket, sys
try:
    socket.create_connection((sys.argv[1], int(sys.argv[2])), 2)
    print("taken")
except ConnectionRefusedError:
    print("refused")
except OSError:
    print("nothing")
"""


def block(name: str) -> str:
    """The fenced block of this name on the page."""
    found = re.search(rf"^```{name}\n(.*?)^```$", PAGE.read_text(encoding="utf-8"), re.MULTILINE | re.DOTALL)
    assert found is not None, f"no block {name!r} on {PAGE.name}"
    return found.group(1)


def keys() -> Tuple[str, str]:
    """A private key and its public one."""
    private = subprocess.run(["wg", "genkey"], capture_output=True, text=True, check=True).stdout
    public = subprocess.run(["wg", "pubkey"], input=private, capture_output=True, text=True, check=True).stdout
    return private.strip(), public.strip()


def knock(rooms: Lab, machine: str, address: str, port: int) -> str:
    """What comes of a connection from this machine within two seconds: it is taken, refused, or nothing comes."""
    words = ["ip", "netns", "exec", rooms.space(machine), sys.executable, "-c", KNOCK, address, str(port)]
    return subprocess.run(words, capture_output=True, text=True, check=True).stdout.strip()


def reaches(rooms: Lab, machine: str, address: str, port: int, answer: str = "taken") -> None:
    """Knocks until it is answered so: cables and tunnels carry a while after they are made, not at once."""
    until(lambda: knock(rooms, machine, address, port) == answer, f"{machine} gets to {address}, port {port}")


@contextlib.contextmanager
def machine(rooms: Lab, name: str, *before: str) -> Iterator[None]:
    """A machine on which something listens at the ports of roscore and communication_manager.

    `before`: shell commands that come first, such as closing the firewall.
    """
    steps = ["mkdir -p /run/wireguard", "mount -t tmpfs none /run/wireguard", *before]
    script = " && ".join([*steps, f"exec {sys.executable} -c '{SERVER}'"])
    # A process namespace of its own: whatever is started in it ends with it.
    inside = ["ip", "netns", "exec", rooms.space(name), "unshare", "-m", "-p", "--fork", "--kill-child"]
    process = subprocess.Popen(
        [*inside, "bash", "-c", script], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True
    )
    try:
        assert process.stdout is not None
        said = ""
        while said.count("listens") < 2:
            line = process.stdout.readline()
            assert line, said
            said += line
        yield
    finally:
        process.kill()
        process.communicate()


@pytest.fixture
def rooms() -> Iterator[Lab]:
    with lab("base", "bot1", "stranger") as made:
        yield made


def test_without_a_firewall_a_stranger_reaches_ros(rooms: Lab) -> None:
    with machine(rooms, "bot1"):
        reaches(rooms, "stranger", rooms.addresses["bot1"], ROSCORE)


def test_with_firewall_and_tunnel_the_robots_reach_each_other_and_strangers_nothing(
    rooms: Lab, tmp_path: Path
) -> None:
    (tmp_path / "nftables.conf").write_text(block("nft"), encoding="utf-8")
    private, public = {}, {}
    for name in ("base", "bot1"):
        private[name], public[name] = keys()
    with contextlib.ExitStack() as machines:
        for name in private:
            machines.enter_context(tunnelled(rooms, name, tmp_path, private, public))
        reaches(rooms, "bot1", "10.9.0.1", ROSCORE)
        reaches(rooms, "base", "10.9.0.2", ROSCORE)
        reaches(rooms, "base", "10.9.0.2", MANAGER)
        for target in ("base", "bot1"):
            reaches(rooms, "stranger", rooms.addresses[target], OPEN, "refused")  # so its cable does carry
            for port in (ROSCORE, MANAGER):
                assert knock(rooms, "stranger", rooms.addresses[target], port) == "nothing"


def tunnelled(
    rooms: Lab, name: str, folder: Path, private: Dict[str, str], public: Dict[str, str]
) -> ContextManager[None]:
    """A machine with firewall and tunnel as the page has them."""
    text = block(f"ini {name}").replace("192.168.1.10", rooms.addresses["base"])
    for owner in private:
        text = text.replace(f"<private key of {owner}>", private[owner]).replace(
            f"<public key of {owner}>", public[owner]
        )
    assert "<" not in text
    (folder / name).mkdir()
    config = folder / name / "wg0.conf"
    config.write_text(text, encoding="utf-8")
    config.chmod(0o600)
    up = f"WG_QUICK_USERSPACE_IMPLEMENTATION=wireguard-go wg-quick up {config}"
    return machine(rooms, name, f"nft -f {folder}/nftables.conf", up)
