"""What docs/security.md says about firewall and tunnel, done as it stands there; machines are network namespaces."""

from __future__ import annotations

import re
import shutil
import subprocess
import sys
from pathlib import Path
from typing import Dict, Iterator, Tuple

import pytest

from tests.namespaces import Lab, lab, why_not

PAGE = Path(__file__).resolve().parent.parent.parent / "docs" / "security.md"
ROSCORE, MANAGER = 11311, 13000
MISSING = [name for name in ("nft", "wg", "wg-quick", "wireguard-go") if shutil.which(name) is None]

pytestmark = pytest.mark.skipif(
    bool(why_not() or MISSING), reason=why_not() or f"not installed here: {', '.join(MISSING)}"
)

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
KNOCK = "import socket, sys; socket.create_connection((sys.argv[1], int(sys.argv[2])), 2)"


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


def reaches(rooms: Lab, machine: str, address: str, port: int) -> bool:
    """True if a connection from this machine is taken."""
    knock = ["ip", "netns", "exec", rooms.space(machine), sys.executable, "-c", KNOCK, address, str(port)]
    return subprocess.run(knock, capture_output=True, check=False).returncode == 0


class Machine:
    """A machine on which something listens at the ports of roscore and communication_manager."""

    def __init__(self, rooms: Lab, name: str, *before: str) -> None:
        """`before`: shell commands that come first, such as closing the firewall."""
        steps = ["mkdir -p /run/wireguard", "mount -t tmpfs none /run/wireguard", *before]
        script = " && ".join([*steps, f"exec {sys.executable} -c '{SERVER}'"])
        # A process namespace of its own: whatever is started in it ends with it.
        inside = ["ip", "netns", "exec", rooms.space(name), "unshare", "-m", "-p", "--fork", "--kill-child"]
        self.process = subprocess.Popen(
            [*inside, "bash", "-c", script], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True
        )
        assert self.process.stdout is not None
        said = ""
        for line in self.process.stdout:
            said += line
            if said.count("listens") == 2:
                return
        raise AssertionError(said)

    def end(self) -> None:
        """Ends it with all that it has started."""
        self.process.kill()
        self.process.communicate()


@pytest.fixture
def rooms() -> Iterator[Lab]:
    with lab("base", "bot1", "stranger") as made:
        yield made


def test_without_a_firewall_a_stranger_reaches_ros(rooms: Lab) -> None:
    robot = Machine(rooms, "bot1")
    try:
        assert reaches(rooms, "stranger", rooms.addresses["bot1"], ROSCORE)
    finally:
        robot.end()


def test_with_firewall_and_tunnel_the_robots_reach_each_other_and_strangers_nothing(
    rooms: Lab, tmp_path: Path
) -> None:
    (tmp_path / "nftables.conf").write_text(block("nft"), encoding="utf-8")
    private, public = {}, {}
    for name in ("base", "bot1"):
        private[name], public[name] = keys()
    machines = {name: tunnelled(rooms, name, tmp_path, private, public) for name in private}
    try:
        assert reaches(rooms, "bot1", "10.9.0.1", ROSCORE)
        assert reaches(rooms, "base", "10.9.0.2", ROSCORE)
        assert reaches(rooms, "base", "10.9.0.2", MANAGER)
        for target in ("base", "bot1"):
            for port in (ROSCORE, MANAGER):
                assert not reaches(rooms, "stranger", rooms.addresses[target], port)
    finally:
        for machine in machines.values():
            machine.end()


def tunnelled(rooms: Lab, name: str, folder: Path, private: Dict[str, str], public: Dict[str, str]) -> Machine:
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
    return Machine(rooms, name, f"nft -f {folder}/nftables.conf", up)
