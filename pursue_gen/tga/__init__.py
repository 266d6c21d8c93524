"""Scenario → network of timed game automata, and UPPAAL's files for it."""

from pursue_gen.tga.ends import ends_reported

__all__ = ["ends_reported"]
