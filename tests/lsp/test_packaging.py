"""The extension for VS Code passes its own tests and can be packaged, where npm and its packages can be had."""

from __future__ import annotations

import os
import shutil
import subprocess
import zipfile
from pathlib import Path
from typing import Dict

import pytest

from .scenarios import ROOT

VSCODE = ROOT / "editors" / "vscode"
OFFLINE = ("ENOTFOUND", "EAI_AGAIN", "ECONNREFUSED", "ETIMEDOUT", "ECONNRESET", "ENOTCACHED", "network", "proxy")
SECONDS = 240


def npm(folder: Path, *words: str) -> "subprocess.CompletedProcess[str]":
    environment: Dict[str, str] = {**os.environ, "PURSUE_SCENARIOS": str(ROOT / "scenarios"), "CI": "1"}
    return subprocess.run(
        ["npm", *words],
        cwd=str(folder),
        env=environment,
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        timeout=SECONDS,
        check=False,
    )


pytestmark = pytest.mark.slow  # the first time npm fetches its packages


@pytest.fixture(scope="module")
def installed(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A copy of the extension with its packages: those of the checkout, or fresh ones."""
    if shutil.which("npm") is None:
        pytest.skip("npm is not installed")
    folder = tmp_path_factory.mktemp("editors") / "vscode"
    shutil.copytree(str(VSCODE), str(folder), ignore=shutil.ignore_patterns("node_modules", "*.vsix"))
    if (VSCODE / "node_modules").is_dir():
        (folder / "node_modules").symlink_to(VSCODE / "node_modules")
        return folder
    try:
        done = npm(folder, "ci", "--ignore-scripts", "--no-audit", "--no-fund", "--prefer-offline")
    except subprocess.TimeoutExpired:
        pytest.skip(f"npm did not get its packages in {SECONDS} seconds")
    if done.returncode and any(word in done.stdout for word in OFFLINE):
        pytest.skip("npm cannot reach its packages")
    assert done.returncode == 0, done.stdout
    return folder


def test_its_own_tests_pass(installed: Path) -> None:
    done = npm(installed, "test")
    assert done.returncode == 0, done.stdout
    assert "# fail 0" in done.stdout and "# tests 0" not in done.stdout


def test_the_package_holds_what_it_needs_and_no_more(installed: Path) -> None:
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
