"""What was recorded of a mission (bag or journal) → findings and a verdict against its scenario, without ROS."""

from __future__ import annotations

from pursue_gen.tools.replay.check import Findings, check
from pursue_gen.tools.replay.game import Game, game_of
from pursue_gen.tools.replay.read import read_recording
from pursue_gen.tools.replay.record import MissionRecord

__all__ = ["Findings", "Game", "MissionRecord", "check", "game_of", "read_recording"]
