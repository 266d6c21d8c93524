"""Patrols for tests: corridors of rooms, and random ones."""

from __future__ import annotations

from typing import Tuple

from hypothesis import strategies as st

from pursue_gen.language import parse
from pursue_gen.solving.options import DEFAULT as OPTIONS
from pursue_gen.solving.rules import Rules, played
from pursue_gen.solving.tours import won_by_tours
from pursue_gen.synthesis.strategy import Strategy
from pursue_gen.tga import scenario_objective, translate
from pursue_gen.tga.network import Network, Objective

Game = Tuple[Network, Objective]


def game_of(text: str) -> Game:
    """The default game of a scenario."""
    scenario = parse(text, "patrol.pur", "patrol")
    return played(translate(scenario), Rules()), scenario_objective(scenario)


def tours_of(text: str) -> Tuple[Network, Objective, Strategy]:
    """The game, and a proven strategy with tours for it."""
    network, objective = game_of(text)
    found = won_by_tours(network, objective, Rules().reaction, OPTIONS)
    assert found is not None
    return network, objective, found.strategy


def corridor(rooms: int, robots: int, every: str, patrolled: str = "") -> str:
    """Rooms along a corridor, each to be visited again and again by any robot."""
    numbers = range(1, rooms + 1)
    lines = [f'poi "{kind}{n}"' for kind in ("hall", "room") for n in numbers]
    lines += [f"connect hall{n} and hall{n + 1} distance 3" for n in numbers[:-1]]
    lines += [f"connect hall{n} and room{n} distance 2" for n in numbers]
    part = -(-rooms // robots)
    lines += [f'agent "bot{k + 1}" controllable mobile 1 location hall{k * part + 1}' for k in range(robots)]
    places = patrolled or ", ".join(f"room{n}" for n in numbers)
    return "\n".join([*lines, f"objective: patrol {places}{every} by any robot\n"])


@st.composite
def small_patrols(draw: st.DrawFn, least: int = 3) -> str:
    """A tree of up to four places, one or two robots, and places that any of them, or one of them, has to visit."""
    size, many = draw(st.integers(least, 4)), draw(st.integers(1, 2))
    names = "abcd"[:size]
    lines = [f'poi "{name}"' for name in names]
    for k in range(1, size):
        other = names[draw(st.integers(0, k - 1))]
        lines.append(f"connect {other} and {names[k]} distance {draw(st.integers(1, 4))}")
    for k in range(many):
        lines.append(f'agent "bot{k + 1}" controllable mobile {draw(st.integers(1, 2))} '
                     f"location {draw(st.sampled_from(names))}")  # fmt: skip
    places = draw(st.lists(st.sampled_from(names), min_size=2, max_size=3, unique=True))
    lines.append(f"objective: patrol {', '.join(places)} every {draw(st.integers(8, 50))} by any robot")
    if many > 1 and draw(st.booleans()):
        lines.append(f"objective: patrol {draw(st.sampled_from(names))} every {draw(st.integers(8, 50))} by bot1")
    return "\n".join(lines) + "\n"


