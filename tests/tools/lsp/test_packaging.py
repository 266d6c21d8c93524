"""The extension for VS Code passes its own tests and can be packaged, where npm and its packages can be had."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import zipfile
from pathlib import Path
from typing import Dict, Tuple

import pytest

from .scenarios import ROOT

VSCODE = ROOT / "editors" / "vscode"
OFFLINE = re.compile(
    r"ENOTFOUND|EAI_AGAIN|ECONN|ETIMEDOUT|EHOSTUNREACH|ENETUNREACH|EPROTO|ENOTCACHED|SOCKET|CERT|network|proxy"
    r"|code E(?:401|403|407|429|5\d\d)\b"
)
"""What npm says where it cannot get at its packages, or where the registry does not give them."""
SECONDS, PATIENCE = 240, 1200
"""For getting packages; for what needs no network."""
TESTS, PACKAGER = (18, 17), (20, 18, 1)
"""The oldest Node.js that runs the extension's tests, and the one that makes its package."""


def node() -> Tuple[int, ...]:
    """The version of Node.js; nothing where it or npm is missing."""
    if shutil.which("npm") is None or shutil.which("node") is None:
        return ()
    done = subprocess.run(["node", "--version"], stdout=subprocess.PIPE, text=True, check=False)
    return tuple(map(int, re.findall(r"\d+", done.stdout)[:3]))


def npm(folder: Path, *words: str, seconds: float = PATIENCE) -> "subprocess.CompletedProcess[str]":
    environment: Dict[str, str] = {**os.environ, "PURSUE_SCENARIOS": str(ROOT / "scenarios"), "CI": "1"}
    return subprocess.run(
        ["npm", *words],
        cwd=str(folder),
        env=environment,
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        timeout=seconds,
        check=False,
    )


pytestmark = pytest.mark.slow  # the first time npm fetches its packages


@pytest.fixture(scope="module")
def installed(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A copy of the extension with its packages: those of the checkout, or fresh ones."""
    if node() < TESTS:
        pytest.skip("there is no npm, or its Node.js is too old")
    folder = tmp_path_factory.mktemp("editors") / "vscode"
    shutil.copytree(str(VSCODE), str(folder), ignore=shutil.ignore_patterns("node_modules", "*.vsix"))
    if (VSCODE / "node_modules").is_dir():
        (folder / "node_modules").symlink_to(VSCODE / "node_modules")
        return folder
    try:
        quiet = ("--ignore-scripts", "--no-audit", "--no-fund")
        done = npm(folder, "ci", "--include=dev", "--prefer-offline", *quiet, seconds=SECONDS)
    except subprocess.TimeoutExpired:
        pytest.skip(f"npm did not get its packages in {SECONDS} seconds")
    if done.returncode and OFFLINE.search(done.stdout):
        pytest.skip("npm cannot reach its packages")
    assert done.returncode == 0, done.stdout
    return folder


def test_its_own_tests_pass(installed: Path) -> None:
    done = npm(installed, "test")
    assert done.returncode == 0, done.stdout
    told = dict(re.findall(r"^\S+ (tests|pass|fail) (\d+)$", done.stdout, re.MULTILINE))
    assert told["fail"] == "0" and told["tests"] == told["pass"] != "0"


def test_the_package_holds_what_it_needs_and_no_more(installed: Path) -> None:
    if node() < PACKAGER:
        pytest.skip("Node.js is too old for vsce")
    done = npm(installed, "run", "package")
    assert done.returncode == 0, done.stdout
    with zipfile.ZipFile(str(installed / "pursue-ml.vsix")) as package:
        names = {name[len("extension/") :] for name in package.namelist() if name.startswith("extension/")}
    ours = {name for name in names if not name.startswith("node_modules/")}
    assert ours == {
        "package.json", "extension.js", "language-configuration.json", "readme.md", "LICENSE.txt",
        "syntaxes/pursue.tmLanguage.json", "snippets/pursue.json",
    }  # fmt: skip
    assert "node_modules/vscode-languageclient/node.js" in names
    assert not any("vsce" in name or "textmate" in name for name in names - ours)
