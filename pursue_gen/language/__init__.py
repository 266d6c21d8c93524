"""PuRSUE-ML: from a text to a checked Scenario."""

from pursue_gen.language.checks import check
from pursue_gen.language.parser import load, parse

__all__ = ["check", "load", "parse"]
