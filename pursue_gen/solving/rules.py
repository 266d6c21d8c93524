"""Which game is played on a network: who controls the ends, how late commands take effect, how late agents end."""

from __future__ import annotations

from dataclasses import dataclass, field
from fractions import Fraction
from typing import Mapping

from pursue_gen.tga import ends_reported
from pursue_gen.tga.network import Network

REPORTED, CONTROLLABLE = "reported", "controllable"


@dataclass(frozen=True)
class Rules:
    """The parameters of a game.

    `ends`: who controls the end of a controllable agent's movement or action, "reported" (the robot reports it) or
    "controllable" (the original's game). `reaction`: the delay within which a command takes effect, in time units.
    `slack`: how many time units later than the model an agent may end, per agent.
    """

    ends: str = REPORTED
    reaction: Fraction = Fraction(1, 10)
    slack: Mapping[str, int] = field(default_factory=dict)


DEFAULT = Rules()
"""The game that robots play where nothing else is asked for."""

IDEAL = Rules(CONTROLLABLE, Fraction(0))
"""The game that UPPAAL-TIGA plays."""


def played(network: Network, rules: Rules) -> Network:
    """The network with the ends and the slack of the rules."""
    return ends_reported(network, rules.slack) if rules.ends == REPORTED else network


def rules_text(rules: Rules) -> str:
    """The parameters in one line, such as `ends reported, reaction 0.1, bot1 late by 2`."""
    slack = "".join(f", {agent} late by {units}" for agent, units in rules.slack.items())
    return f"ends {rules.ends}, reaction {float(rules.reaction):g}{slack}"
