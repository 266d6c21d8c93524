"""Where robots move: their ways, and the places that hold one of them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import AbstractSet, Mapping, NamedTuple

Ways = Mapping[str, Mapping[str, int]]
"""From each place the places to which a way leads, and how long that takes at most."""


class Move(NamedTuple):
    """A robot goes from one place to the next."""

    robot: str
    origin: str
    target: str


@dataclass(frozen=True)
class Floor:
    """For each robot its ways; `single`: the places that hold one robot at a time, from the moment at which it sets off
    for the place until it sets off from there."""

    ways: Mapping[str, Ways]
    single: AbstractSet[str]
