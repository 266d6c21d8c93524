"""PuRSUE-ML: from a text to a checked Scenario."""

from pursue_gen.language.checks import check, load
from pursue_gen.language.parser import parse

__all__ = ["check", "load", "parse"]
