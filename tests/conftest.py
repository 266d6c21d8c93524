"""Fixtures that every test may use."""

from __future__ import annotations

import os
import signal
from pathlib import Path
from typing import Any

import pytest
from hypothesis import HealthCheck, settings

ROOT = Path(__file__).resolve().parent.parent

# A shell ignores Ctrl-C for what it runs in the background, and so would all that the tests start.
if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
    signal.signal(signal.SIGINT, signal.default_int_handler)

# Who looks for a fault in the program wants tracebacks; tests want what everybody gets.
os.environ.pop("PURSUE_DEBUG", None)

# Other work on the machine must not fail a test; in CI a change is judged by the same examples every time.
settings.register_profile(
    "project",
    deadline=None,
    suppress_health_check=[HealthCheck.too_slow, HealthCheck.filter_too_much],
    derandomize=bool(os.environ.get("CI")),
)
settings.load_profile("project")


@pytest.fixture(scope="session")
def project_root() -> Path:
    """The checkout that is tested."""
    return ROOT


@pytest.fixture(scope="session")
def reference_dir() -> Path:
    """The published scenarios with TIGA's outputs; the test is skipped where they are not at hand."""
    folder = Path(os.environ.get("PURSUE_REFERENCE", ROOT.parent / "shared" / "reference")) / "pursue-scenarios"
    if not folder.is_dir():
        pytest.skip(f"the published scenarios are not here ({folder}); set PURSUE_REFERENCE to their folder")
    return folder


def thesis_scenario(number: str) -> Path:
    """The path of one of the thesis's five scenarios: '1' to '4' or 'catch_the_thief'."""
    stem = number if number.startswith("catch") else f"scenario_{number}"
    return ROOT / "scenarios" / "thesis" / f"{stem}.pur"


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_make_scheduler(config: pytest.Config, log: Any) -> Any:
    """With pytest-xdist all tests on ROS run on one worker: they share what they build, and answers must not be late.

    (`--dist loadgroup` is made for this, but does not group anything with pytest 9.)
    """
    from xdist.scheduler import LoadScopeScheduling

    class OneWorkerForRos(LoadScopeScheduling):
        def _split_scope(self, nodeid: str) -> str:
            return "ros" if "tests/ros/" in nodeid else nodeid

    return OneWorkerForRos(config, log)
