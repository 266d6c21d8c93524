"""The contract of a solver's engine: a compiled game and limits in, one outcome out."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import ClassVar, Collection, Optional, Tuple

from pursue_gen.synthesis.game import Game, RawBlock
from pursue_gen.synthesis.limits import NO_LIMITS, Limits, Listener


@dataclass(frozen=True)
class Stats:
    """What exploring and deciding a game took: the name of the engine, discrete states, zones of the result, seconds.

    `symbolic_states` are zones whose successors were computed, as other tools count them; 0: not counted. `work`: as
    `Limits.work` counts it.
    """

    engine: str
    discrete_states: int
    zones: int
    seconds: float
    symbolic_states: int = 0
    work: int = 0


@dataclass(frozen=True)
class Outcome:
    """Who wins, and how.

    `won`: the controller wins from every position at the start. `blocks`: its strategy, empty where it loses: one block
    for each discrete state that a play by it can come to (others may have one), canonical zones in the game's scale,
    pairwise disjoint; commands stand in the order in which their zones were won. `ranks` (of a reach game, where the
    engine keeps them): per block and zone a number that every step of the game lowers, across discrete states.
    """

    won: bool
    blocks: Tuple[RawBlock, ...]
    ranks: Optional[Tuple[Tuple[int, ...], ...]]
    stats: Stats

    def __post_init__(self) -> None:
        assert self.won or not self.blocks
        assert self.ranks is None or len(self.ranks) == len(self.blocks)


class Engine(ABC):
    """A solver of compiled games. All engines give the same verdicts; their strategies may differ.

    Engines are values: budgets of an engine's own (numbers of steps, never seconds) are its fields, and nothing is kept
    from one game to the next.
    """

    name: ClassVar[str]
    """What verdicts call it."""

    def holds(self, game: Game) -> bool:
        """True if its numbers can hold all times and values of the game."""
        return True

    def giving_first(self, work: int) -> Engine:
        """The engine that gives a game at least so much work as it is, before anything else is tried in turn."""
        return self

    def guess(
        self,
        game: Game,
        limits: Limits = NO_LIMITS,
        progress: Optional[Listener] = None,
        late: Collection[str] = (),
        turns: bool = False,
    ) -> Outcome:
        """Try simple policies in a safety game that it `holds`: each robot does one duty after the other, by itself.

        `won` if one keeps from all that is to be avoided; else nothing is known of the game. Zones in which to wait may
        overlap, and those of commands, too. `late`: the automata of patrols; policies by which these wait until they
        are due. `turns`: only policies by which robots leave their homes in turns. `progress` and what it raises: as
        `solve`. An engine need not know any policy.
        """
        return not_guessed(self)

    @abstractmethod
    def solve(
        self,
        game: Game,
        limits: Limits = NO_LIMITS,
        progress: Optional[Listener] = None,
        soonest: bool = False,
    ) -> Outcome:
        """Decide a game that it `holds`.

        `progress` is called a few times a second from the calling thread; what it raises ends the search, as does
        KeyboardInterrupt. `soonest` (reach): with all moves, and what is nearer to the goal in time is won first, so
        that the strategy is quick; that may be much more work. Raises PursueError (SYN010, exit status 5) at one of the
        limits, and where the system gives no more memory.
        """


def not_guessed(engine: Engine) -> Outcome:
    """The outcome where no policy was tried."""
    return Outcome(False, (), None, Stats(engine.name, 0, 0, 0.0))
