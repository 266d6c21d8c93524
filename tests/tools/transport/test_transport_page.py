"""What docs/transport.md tells people to type works."""

from __future__ import annotations

import re
import shutil
import subprocess
from dataclasses import replace
from pathlib import Path

import pytest
from fake_robot import FakeRobot, serving

from pursue_gen.tools.transport.client import health
from tests.waiting import PATIENCE

ROOT = Path(__file__).resolve().parents[3]
PAGE = (ROOT / "docs" / "transport.md").read_text(encoding="utf-8")
LAUNCH = (ROOT / "templates" / "catkin" / "bringup" / "launch" / "robot.launch.j2").read_text(encoding="utf-8")


@pytest.mark.skipif(shutil.which("openssl") is None, reason="openssl is not installed")
def test_a_certificate_made_as_the_page_says_is_accepted(tmp_path: Path) -> None:
    found = re.search(r"^ +(openssl .*\n.*)$", PAGE, re.MULTILINE)
    assert found is not None
    command = found.group(1).replace("10.0.0.12", "127.0.0.1")
    subprocess.run(["bash", "-c", command], cwd=tmp_path, capture_output=True, check=True, timeout=PATIENCE)
    both = tmp_path / "both.pem"
    both.write_bytes((tmp_path / "bot2.pem").read_bytes() + (tmp_path / "bot2.key").read_bytes())
    with serving([FakeRobot("bot2")], tls=both) as (place,):
        assert health(replace(place, ca=tmp_path / "bot2.pem")).robot == "bot2"


def test_launch_arguments_are_those_of_the_launch_file() -> None:
    known = set(re.findall(r'<arg name="(\w+)"', LAUNCH))
    told = set(re.findall(r"\b(\w+):=", PAGE))
    assert {"name", "nodes", "host", "certificate", "web", "autostart"} <= told <= known


def test_links_lead_somewhere() -> None:
    links = re.findall(r"\]\(([\w/]+\.md)?(?:#([\w-]+))?\)", PAGE)
    assert links
    for file, part in links:
        text = (ROOT / "docs" / file).read_text(encoding="utf-8") if file else PAGE
        found = re.findall(r"^#+ (.*)$", text, re.MULTILINE)
        heads = {re.sub(r"[^\w -]", "", head.lower()).replace(" ", "-") for head in found}
        assert not part or part in heads, (file, part)
