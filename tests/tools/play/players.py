"""Games for tests: boards that are won or lost, and somebody who does anything at any moment."""

from __future__ import annotations

from fractions import Fraction
from functools import lru_cache
from pathlib import Path
from typing import List, Optional, Tuple

from hypothesis import strategies as st

from pursue_gen.language import parse
from pursue_gen.language.scenario import Scenario
from pursue_gen.solving.rules import IDEAL, Rules
from pursue_gen.tools.play.counter import CounterPlay
from pursue_gen.tools.play.session import GameOf, Session, session_of
from pursue_gen.tools.play.state import GRAIN, PlannedMove, PlayState
from pursue_gen.tools.play.world import Offer, StrategyPlay
from pursue_gen.vocabulary.words import words_of

SCENARIOS = Path(__file__).resolve().parents[3] / "scenarios"

CAGE = """
poi "cage"
poi "yard"
poi "exit"
connect cage and yard distance 4
connect yard and exit distance 3
event "catch" collaborative
agent "keeper" controllable mobile 1 location yard can_do catch
agent "lion" mobile 1 location cage reacts_to catch
reach_objective: do catch
"""
"""Lost: a lion as fast as its keeper gets away through the door at the other end, or stays where it is."""

LATE = """
poi "desk"
poi "hall"
connect desk and hall distance 5
event "ring" location hall
event "open" location desk
agent "porter" controllable mobile 1 location desk can_do open
agent "guest" location hall can_do ring
rule "turns": ring before open
objective: if ring then open within {deadline}
"""
"""Won: the porter need only stay. Lost with a deadline that is shorter than its rest and its reaction."""


def read(name: str) -> Scenario:
    """One of the scenarios of the project, by its path below scenarios/; or one from above."""
    texts = {"cage": CAGE, "late": LATE.format(deadline=1)}
    if name in texts:
        return parse(texts[name], f"{name}.pur", name)
    file = SCENARIOS / f"{name}.pur"
    text = file.read_text(encoding="utf-8")
    return parse(text, str(file), file.stem)


def changed(name: str, old: str, new: str) -> Scenario:
    """A scenario of the project with another text somewhere."""
    file = SCENARIOS / f"{name}.pur"
    text = file.read_text(encoding="utf-8")
    assert old in text
    return parse(text.replace(old, new), str(file), file.stem)


@lru_cache(maxsize=None)
def game(name: str, ideal: bool = False, old: str = "", new: str = "") -> GameOf:
    """The game of a scenario, solved once."""
    scenario = changed(name, old, new) if old else read(name)
    return session_of(scenario, IDEAL if ideal else Rules()).game


def session(name: str, old: str = "", new: str = "") -> Session:
    """A new session of it."""
    played = game(name, old=old, new=new)
    return Session(played, words_of(played.setup.scenario, played.setup.network), played.setup.beginning())


def world(name: str, seed: int, ideal: bool = False) -> StrategyPlay:
    """A game against the strategy."""
    played = game(name, ideal)
    assert isinstance(played, StrategyPlay)
    return StrategyPlay(played.setup, played.advisor, seed)


def robots(name: str, old: str = "", new: str = "") -> CounterPlay:
    """A game against the counter-strategy."""
    played = game(name, old=old, new=new)
    assert isinstance(played, CounterPlay)
    return played


def moments(offer: Offer, now: Fraction, share: int) -> Fraction:
    """A moment in the offer's window (or in its first 40 time units): one of its ends, or anything between."""
    first = offer.open_.earliest(GRAIN)
    assert first is not None
    last = offer.open_.latest()
    last = first + 40 if last is None else last
    moment = first + Fraction(int((last - first) * share / 10 / GRAIN)) * GRAIN
    return now + (moment if offer.open_.holds(moment) else first)


@st.composite
def whims(draw: st.DrawFn, most: int) -> List[Tuple[int, int]]:
    """What somebody does who does anything: numbers that `do` makes something of."""
    return draw(st.lists(st.tuples(st.integers(0, 11), st.integers(0, 10)), max_size=most))


def do(played: GameOf, table: PlayState, whim: Optional[Tuple[int, int]]) -> PlayState:
    """The table after that whim: an offer at a moment, a wait of some length, or (None) a wait for what comes."""
    if whim is None:
        return played.advance(table)
    kind, share = whim
    if kind >= 8:
        return played.advance(table, table.now + Fraction(share * share, 8))
    offers = played.offers(table)
    if not offers:
        return played.advance(table)
    offer = offers[kind % len(offers)]
    planned = played.planned(table, PlannedMove(offer.agent, offer.word, moments(offer, table.now, share)))
    return played.advance(planned)
