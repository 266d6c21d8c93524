"""From drives to a scenario: a robot whose speed the model does not know drives all ways, calibrate makes windows of
that, and these hold later drives."""

from __future__ import annotations

from pathlib import Path
from random import Random

import pytest

from pursue_gen.language import load
from pursue_runtime.drives.session import Plan, Session
from pursue_runtime.drives.tour import Way
from tests.cli.test_commands import pursue
from tests.runtime.drives.test_session import PLACES, RESULT, WAYS, Robot
from tests.tools.calibration.drive_bags import write_drives

FLOOR = """\
poi "a"
poi "b"
poi "c"
connect a and b distance 2
connect b and c distance 2
event "fetch" location c
agent "bot" controllable mobile 1 location a can_do fetch
reach_objective: do fetch
"""


class Noisy(Robot):
    """A robot that never takes the same time twice."""

    def __init__(self, session: Session, seed: int) -> None:
        super().__init__(session)
        self.random = Random(seed)

    def takes(self, way: Way) -> float:
        return super().takes(way) * self.random.lognormvariate(0.0, 0.1) + self.random.uniform(0.0, 0.5)


@pytest.mark.parametrize("times", [10, 25])
def test_windows_from_some_drives_hold_99_percent_of_later_ones(tmp_path: Path, times: int) -> None:
    session = Session("bot", PLACES, "a", Plan(WAYS, times), RESULT, lambda level, text: None)
    robot = Noisy(session, seed=3)
    robot.run()
    assert session.is_complete
    (tmp_path / "floor.pur").write_text(FLOOR, encoding="utf-8")
    bag = write_drives(tmp_path / "drives.bag", robot.drives)
    copy = tmp_path / "copy.pur"
    done = pursue("calibrate", tmp_path / "floor.pur", bag, "-o", copy)
    assert done.status == 0 and "with the proposal: won" in done.out
    windows = {travel.way: travel.window for travel in load(str(copy)).travels}
    assert set(windows) == set(WAYS)
    later = [(way, robot.takes(way)) for way in WAYS for _ in range(1000)]
    held = sum(windows[way][0] < time <= windows[way][1] for way, time in later)
    assert held >= 0.99 * len(later)
