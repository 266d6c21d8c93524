"""An observer that was away counts reports at the time that they carry, before it lets a deadline pass."""

from __future__ import annotations

import os
import signal
import time
from pathlib import Path

import pytest
from launched_mission import EVENTS, launched
from ros_world import Ros, lay_over

from pursue_gen.language import parse
from pursue_gen.solving.rules import Rules
from pursue_gen.solving.solution import solve_scenario
from pursue_gen.tools.replay import check, game_of, read_recording
from pursue_gen.tools.replay.finding import FAULT
from pursue_gen.tools.replay.game import from_workspace
from pursue_gen.tools.replay.journal import Journal, reconstruct
from pursue_gen.tools.replay.moves import Moves
from pursue_gen.workspace import Options, write_workspace
from pursue_runtime.event_words import parse_word

pytestmark = pytest.mark.ros

ERRAND = """
poi "counter"
poi "office"
connect counter and office distance 2
event "stamp" location office duration 6
agent "porter" controllable mobile 1 location counter can_do stamp
reach_objective: do stamp within 22
"""

UNIT, DEADLINE = 0.6, 22


@pytest.fixture(scope="module")
def errand(ros: Ros, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The workspace of the errand."""
    scenario = parse(ERRAND, "errand.pur", "errand")
    won = solve_scenario(scenario, Rules())
    options = Options(reaction=Rules().reaction)
    folder = tmp_path_factory.mktemp("errand") / "ws"
    return lay_over(
        ros, write_workspace(scenario, won.network, won.objective, won.strategy, options, folder)
    )


@pytest.mark.parametrize("then", [signal.SIGKILL, signal.SIGCONT], ids=["killed", "suspended"])
def test_who_was_in_time_has_met_the_deadline_though_the_observer_returns_after_it(
    ros: Ros, errand: Path, tmp_path: Path, then: signal.Signals
) -> None:
    """The observer hears nothing from when the action begins until the deadline has passed; then it is killed, or goes
    on."""
    with launched(ros, errand, tmp_path, ("porter",), mode="still", time_unit=UNIT, record=True) as run:
        begun = run.until_step("stamp")
        start = float(begun["stamp"]) - begun["clocks"]["Creach"] * UNIT
        process = run.kill("observer", signal.SIGSTOP)
        run.until(lambda: [entry for entry in run.of(EVENTS, "simulator") if "stampDONE" in entry["data"]])
        run.until(lambda: time.time() > start + (DEADLINE + 0.5) * UNIT)
        os.kill(process, then)
        assert run.until_over() == "won", run.output()
    ended = (float(run.now()["stamp"]) - start) / UNIT
    words = [parse_word(entry["data"]) for entry in run.of(EVENTS, "simulator")]
    first, *others = [word.at for word in words if word is not None and word.event == "stampDONE"]
    assert first is None and len(set(others)) == 1, "what is published again carries the time of the first"
    home = tmp_path / "home" / "pursue" / "errand"
    game = game_of(from_workspace(errand))
    for path in (home / "mission.bag", *home.glob("journal-*.jsonl")):
        found = read_recording(path)
        if isinstance(found, Journal):
            found = reconstruct(found, Moves(game.network), game.objective)
        findings = check(found, game).findings
        assert not [each for each in findings if each.level == FAULT], (path, findings)
    assert ended < DEADLINE and ended == pytest.approx((others[0] - start) / UNIT, abs=0.01)
