"""The frames of the maps: one for all levels of a building, or one for each, where `~map_frame` has `{level}`."""

from __future__ import annotations

from types import MappingProxyType
from typing import Dict, Mapping, Optional

from pursue_runtime.data import DataError

LEVEL = "{level}"
"""Stands in `~map_frame` for the name of a level."""

STOREY = 0.5
"""Metres from the elevation of a level within which a place is on it, and by which a robot may be above or below."""

Levels = Mapping[str, float]
"""level → its elevation in metres."""
NO_LEVELS: Levels = MappingProxyType({})


class MapFrames:
    """Which frame a pose is in, by its height, and on which level what is in a frame is."""

    def __init__(self, map_frame: str, levels: Levels) -> None:
        """Raises DataError where the frame names levels, and there are none."""
        if LEVEL in map_frame and not levels:
            raise DataError(
                f"~map_frame is {map_frame!r}, and poses.yaml has no levels: generate the workspace with --map and the"
                " file of levels"
            )
        several = LEVEL in map_frame
        self.elevations: Dict[str, Optional[float]] = {map_frame: None}
        """frame → the height of all that is in it (metres); None: there is one frame for all heights."""
        if several:
            self.elevations = {map_frame.replace(LEVEL, name): height for name, height in levels.items()}

    def of(self, height: float) -> str:
        """Return the frame for a pose at this height (metres): that of the nearest level."""
        return min(self.elevations, key=lambda frame: abs((self.elevations[frame] or 0.0) - height))

    def elevation(self, frame: str) -> Optional[float]:
        """Return the height of what is in a frame (metres), None where that says nothing of it. Raises KeyError for a
        frame of no map."""
        return self.elevations[frame.lstrip("/")]
