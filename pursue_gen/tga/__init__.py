"""Scenario → network of timed game automata, and UPPAAL's files for it."""

from pursue_gen.tga.ends import ends_reported
from pursue_gen.tga.objectives import scenario_objective
from pursue_gen.tga.translate import translate, translation_notes

__all__ = ["ends_reported", "scenario_objective", "translate", "translation_notes"]
