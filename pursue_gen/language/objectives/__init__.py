"""What a scenario is to achieve: what always holds, and what is reached once. A module for each kind of objective."""

from __future__ import annotations

import enum
from dataclasses import dataclass
from typing import Mapping, Type

from pursue_gen.language.objectives.avoid import Always, Avoid
from pursue_gen.language.objectives.base import Safety, StatedObjective
from pursue_gen.language.objectives.endurance import Endurance
from pursue_gen.language.objectives.escort import Escort
from pursue_gen.language.objectives.holds import EveryPlaceHolds, EveryWayHolds, LiftHolds, PlaceHolds, WayHolds
from pursue_gen.language.objectives.never_with import NeverWith
from pursue_gen.language.objectives.patrol import Patrol
from pursue_gen.language.objectives.pause import Pause
from pursue_gen.language.objectives.reach import Reach
from pursue_gen.language.objectives.request import Request
from pursue_gen.language.objectives.respond import Respond

__all__ = [
    "Always", "Avoid", "Endurance", "Escort", "EveryPlaceHolds", "EveryWayHolds", "GivenUp", "LiftHolds", "NeverWith",
    "Patrol", "Pause", "PlaceHolds", "Reach", "Request", "Respond", "Safety", "StatedObjective", "WayHolds",
]  # fmt: skip
"""Parts of scenarios: `language.scenario` hands them on."""

KINDS: Mapping[str, Type[Safety]] = {
    "respond": Respond, "avoid": Avoid, "always": Always, "never_with": NeverWith, "patrol": Patrol,
    "place_holds": PlaceHolds, "way_holds": WayHolds, "lift_holds": LiftHolds, "every_place_holds": EveryPlaceHolds,
    "every_way_holds": EveryWayHolds, "pause": Pause, "escort": Escort,
    "request": Request,
}  # fmt: skip
"""The kinds of what always holds, by their rules in the grammar."""


class WhyGivenUp(enum.Enum):
    """Why an optional objective is not promised, in words that follow it."""

    IMPOSSIBLE = "cannot be promised together with the rest"
    TOO_MUCH_WORK = "was too much work to decide"
    REFUSED = (
        "is not decided: the independent checker refuses the strategy that was found for it (please report that, with "
        "the scenario)"
    )


@dataclass(frozen=True)
class GivenUp:
    """An optional objective that is not promised, and why."""

    objective: StatedObjective
    why: WhyGivenUp = WhyGivenUp.IMPOSSIBLE
