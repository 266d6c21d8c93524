"""Fixtures that every test may use."""

from __future__ import annotations

import gc
import os
import signal
import unittest
from pathlib import Path
from typing import Any, List, Set, Tuple

import pytest
from hypothesis import HealthCheck, settings
from hypothesis.internal.detection import is_hypothesis_test  # in hypothesis itself later than Python 3.8 gets

ROOT = Path(__file__).resolve().parent.parent

# A shell ignores Ctrl-C for what it runs in the background, and so would all that the tests start.
if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
    signal.signal(signal.SIGINT, signal.default_int_handler)

# Who looks for a fault in the program wants tracebacks; tests want what everybody gets.
os.environ.pop("PURSUE_DEBUG", None)

# A verdict depends on the code alone: not on what else the machine does, and each run draws the same examples.
settings.register_profile(
    "project",
    deadline=None,
    max_examples=40,
    suppress_health_check=[HealthCheck.too_slow, HealthCheck.filter_too_much],
    derandomize=True,
)
settings.register_profile("explore", settings.get_profile("project"), derandomize=False)
settings.load_profile("project")

EXPLORE_FACTOR, FEW = 10, 0.1


def pytest_addoption(parser: pytest.Parser) -> None:
    """Adds `--explore` and `--few`."""
    parser.addoption(
        "--few",
        action="store_true",
        help="property tests draw a tenth of their examples: where they ran before, under another Python",
    )
    parser.addoption(
        "--explore",
        action="store_true",
        help=f"property tests draw new examples on each run, {EXPLORE_FACTOR} times as many; some take minutes",
    )


def pytest_configure(config: pytest.Config) -> None:
    """Loads the profile before any test module is imported: its settings inherit from it.

    Garbage of cycles is collected seldom: by the usual thresholds, a seventh of the time goes to looking for it.
    """
    gc.set_threshold(20_000, 20, 20)
    if config.getoption("--explore"):
        settings.load_profile("explore")


@pytest.hookimpl(tryfirst=True)
def pytest_collection(session: pytest.Session) -> None:
    """With pytest-xdist, each worker compiles other test files, and some collect those on ROS alone."""
    worker = getattr(session.config, "workerinput", None)
    if worker is not None:
        from tests.schedule import collected_by, files_in

        files = files_in(session.config.args)
        if files:
            session.config.args = collected_by(int(worker["workerid"][2:]), worker["workercount"], files)


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(config: pytest.Config, items: List[pytest.Item]) -> None:
    """With `--explore`: multiplies the examples of each property test, those with a number of their own included. With
    `--few`: divides them."""
    items.sort(key=lambda item: str(item.path))  # the same order on all workers
    factor = EXPLORE_FACTOR if config.getoption("--explore") else FEW if config.getoption("--few") else 1
    if factor == 1:
        return
    changed: Set[int] = set()
    for item in items:
        holder, name = _settings_place(item)
        if holder is None or id(holder) in changed:
            continue
        changed.add(id(holder))
        usual = getattr(holder, name, None) or settings.default
        setattr(holder, name, settings(usual, max_examples=max(1, int(factor * usual.max_examples))))


def pytest_collection_finish() -> None:
    """What the collection made is there to the end: the garbage collector need not look at it."""
    gc.collect()
    gc.freeze()


def _settings_place(item: pytest.Item) -> Tuple[Any, str]:
    """Where hypothesis keeps the settings of a test: an object and its attribute; None where it is no property test."""
    if not isinstance(item, pytest.Function) or not is_hypothesis_test(item.obj):
        return None, ""
    if issubclass(item.cls or object, unittest.TestCase):  # a state machine's
        return item.cls, "settings"
    return getattr(item.obj, "__func__", item.obj), "_hypothesis_internal_use_settings"


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


@pytest.fixture(scope="session")
def python38() -> str:
    """A Python 3.8 with the oldest packages that do; the test is skipped where there is none."""
    from tests.python38 import oldest_python

    return oldest_python()


def thesis_scenario(number: str) -> Path:
    """The path of one of the thesis's five scenarios: '1' to '4' or 'catch_the_thief'."""
    stem = number if number.startswith("catch") else f"scenario_{number}"
    return ROOT / "scenarios" / "thesis" / f"{stem}.pur"


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_make_scheduler(config: pytest.Config, log: Any) -> Any:
    """With pytest-xdist, files go to workers as a whole, the longest first."""
    from tests.schedule import LongestFirst  # without pytest-xdist it cannot be imported

    return LongestFirst(config, log)
