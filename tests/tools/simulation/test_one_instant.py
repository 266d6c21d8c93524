"""Events that fall on one instant: the judge accepts every order that the model permits."""

from __future__ import annotations

import pytest

from pursue_gen.language import load
from pursue_gen.solving.solution import Rules, solve_scenario
from pursue_gen.tools.simulation import connections
from pursue_gen.tools.simulation.mission import SimulatedMission
from pursue_gen.tools.simulation.opponents import Opponent
from pursue_gen.tools.simulation.outcome import GOAL, Settings
from pursue_gen.tools.simulation.stage import Stage, stage_of
from pursue_gen.workspace import Options
from pursue_runtime.event_words import Word

LOCKED_SHOP = """
poi "yard"
poi "counter"
connect yard and counter distance 4
event "lock" location yard duration 3
event "unlock" location counter
event "ring" location counter
event "deliver" location counter
rule "order": lock before deliver
state "open": initially true, true_if unlock false_if lock
stateDependency: ring only_if open is_true
agent "bot" controllable mobile 1 location yard can_do lock, unlock, deliver
agent "guest" location counter can_do ring
reach_objective: do deliver
"""
"""A guest may ring while the shop is open; the robot closes it."""


class TiedMission(SimulatedMission):
    """Messages take no time, and the guest rings at the instant of the robot's command: its timer goes off before the
    command is received, and the report is received after it."""

    def publish_word(self, node: str, word: Word, latest: float) -> None:
        """Lets the guest act at the instant at which this word is received."""
        if word.event == "lock":
            self.events.schedule(self.events.now, self._ring)
        super().publish_word(node, word, latest)

    def _ring(self) -> None:
        self._word = "guest:ring"
        self._act()


@pytest.fixture(scope="module")
def shop(tmp_path_factory: pytest.TempPathFactory) -> Stage:
    path = tmp_path_factory.mktemp("shop") / "shop.pur"
    path.write_text(LOCKED_SHOP)
    scenario = load(path)
    won = solve_scenario(scenario, Rules())
    return stage_of(scenario, won, Options(reaction=won.reaction))


def test_a_call_that_a_command_of_the_same_instant_rules_out_is_no_failure(
    shop: Stage, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(Opponent, "next", lambda *_: None)
    monkeypatch.setattr(connections, "drawn_share", lambda draw: 0.0)
    outcome = TiedMission(shop, Settings("random"), 1, None, record=True).run()
    play = "\n".join(outcome.play)
    assert "guest reports guest:ring" in play
    assert (outcome.end, outcome.reason) == (GOAL, ""), play
    assert outcome.problems == ()
