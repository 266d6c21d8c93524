"""The person plays whatever the robots' strategy does not control; the strategy plays the robots.

What the person does not decide is drawn: when movements and actions end (anywhere in the model's window), and how late
a command takes effect (at most the promised reaction). A draw depends on the seed and on the number of the step only,
so undoing and doing the same again leads to the same. What the strategy says (what it does next, when, and which of its
blocks holds) is its advisor's.
"""

from __future__ import annotations

import random
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import AbstractSet, List, Mapping, Optional, Tuple

from pursue_gen.explanation.policy import Window, window
from pursue_gen.explanation.policy import span as delays
from pursue_gen.language.symbols import Role
from pursue_gen.synthesis.game import JointMove, joint_moves
from pursue_gen.synthesis.lookup import blocks_of, facts_of
from pursue_gen.synthesis.strategy import Block, Command, Strategy, Zone
from pursue_gen.tga.network import Edge
from pursue_gen.tools.play.state import CHANCE, GRAIN, OTHERS, ROBOTS, PlannedMove, PlayState, Setup, StandingDecision


@dataclass(frozen=True)
class Decision:
    """The command of a block (by its number) that is due first if nothing happens before, at a time since the start."""

    move: JointMove
    at: Fraction
    number: int
    command: Command


@dataclass(frozen=True)
class Holding:
    """The block that holds: its number (from 1), and the zone in force (None: the strategy does not know this point).

    `command` None: it says to wait.
    """

    number: int
    block: Block
    command: Optional[Command]
    zone: Optional[Zone]


class Advisor:
    """Reads one strategy for one setup."""

    def __init__(self, setup: Setup, strategy: Strategy) -> None:
        self._setup, self.size = setup, len(strategy.blocks)
        self._left_out_clocks = frozenset(strategy.left_out_clocks)
        self._blocks = blocks_of(strategy)
        self._clocks = {automaton.name: automaton.clocks for automaton in setup.network.automata}

    def decision(self, play: PlayState) -> Optional[Decision]:
        """What the strategy decided before the last move, where that stands, or decides first after it; None: it waits
        for what others do."""
        return min(self._decisions(play), key=lambda decision: decision.at, default=None)

    def standing(self, before: PlayState, play: PlayState) -> Tuple[StandingDecision, ...]:
        """What had been decided before a move, and stands after it: the same block holds, and no clock of an automaton
        that it names was reset, but those that the strategy leaves out."""
        game = self._setup.game
        aged = before.entry.later(play.since - before.since)
        reset = {c for c, was, now in zip(game.clocks, aged.clocks, play.entry.clocks) if was != now}
        reset -= self._left_out_clocks
        states = facts_of(game, before.entry.state), facts_of(game, play.entry.state)
        entries = [entry for entry, stands in self._blocks.standing(*states, reset, self._clocks).items() if stands]
        numbers = {number for entry in entries for number, _ in self._blocks.entered(entry)}
        return tuple(
            StandingDecision(decision.number, decision.command, decision.at)
            for decision in self._decisions(before)
            if decision.at <= play.since and decision.number in numbers
        )

    def holdings(self, play: PlayState) -> List[Holding]:
        """What each block that holds says now, or said when it decided what stands; none: the strategy has no block for
        this state."""
        return [self._says(number, block, play) for number, block in self._holding(play)]

    def _holding(self, play: PlayState) -> List[Tuple[int, Block]]:
        return self._blocks.find(facts_of(self._setup.game, play.entry.state))

    def _decisions(self, play: PlayState) -> List[Decision]:
        """What each block that holds has decided or decides first."""
        found = (self._decided(number, block, play) for number, block in self._holding(play))
        return [decision for decision in found if decision is not None]

    def _decided(self, number: int, block: Block, play: PlayState) -> Optional[Decision]:
        game, entry = self._setup.game, play.entry
        named = {name for name, _ in block.state.locations}
        moves = {self._keys(move, named): move for move in joint_moves(game, entry.state) if move.controllable}
        for known in play.standing:
            if known.number == number:
                move = moves.get(_keys_of(known.command))
                return None if move is None else Decision(move, known.at, number, known.command)
        clocks = dict(zip(game.clocks, entry.clocks))
        best: Optional[Decision] = None
        for command in block.commands:
            move = moves.get(_keys_of(command))
            if move is None:
                continue
            open_ = window(game, entry, move)
            for zone in command.zones:
                within = span(zone, clocks)
                delay = None if within is None else within.both(open_).earliest(GRAIN)
                if delay is not None and (best is None or play.since + delay < best.at):
                    best = Decision(move, play.since + delay, number, command)
        return best

    def _says(self, number: int, block: Block, play: PlayState) -> Holding:
        moment = next((known.at for known in play.standing if known.number == number), play.now)
        clocks = dict(zip(self._setup.game.clocks, play.entry.later(moment - play.since).clocks))
        zones: List[Tuple[Optional[Command], Zone]] = [(None, zone) for zone in block.wait]
        zones += [(command, zone) for command in block.commands for zone in command.zones]
        for command, zone in zones:
            within = span(zone, clocks)
            if within is not None and within.holds(Fraction(0)):
                return Holding(number, block, command, zone)
        return Holding(number, block, None, None)

    def _keys(self, move: JointMove, named: AbstractSet[str]) -> Tuple[Tuple[str, ...], ...]:
        """What the named automata do in the move; the first one makes it."""
        game = self._setup.game
        parts = ((game.automata[game.edges[k].automaton].name, game.origins[k]) for k in move.edges)
        keys = [_key(name, edge) for name, edge in parts if name in named]
        return (*keys[:1], *sorted(keys[1:]))


def _keys_of(command: Command) -> Tuple[Tuple[str, ...], ...]:
    first, *others = (_key(move.automaton, move.edge) for move in command.moves)
    return (first, *sorted(others))


def _key(automaton: str, edge: Edge) -> Tuple[str, ...]:
    return automaton, edge.source, edge.target, str(edge.sync), str(edge.guard)


def span(zone: Zone, clocks: Mapping[str, Fraction]) -> Optional[Window]:
    """The delays after which clocks that have these values now are in a zone; None: time does not get there."""
    reached = delays(zone, clocks)
    return None if reached is None or reached.earliest(GRAIN) is None else reached


_STEPS = 100
"""Draws are multiples of 1/100 of a time unit where the window allows it: short to read. Not measured."""


@dataclass(frozen=True)
class Event:
    """What happens next if no agent does anything else: at a time since the start, and by whom it is done."""

    at: Fraction
    move: JointMove
    by: str


@dataclass(frozen=True)
class Offer:
    """Something that can be done from here on, after delays (from now) in `open_`.

    `drawn`: for the end of a movement or an action, when (since the start) it comes unless the person says otherwise.
    """

    agent: str
    word: str
    move: JointMove
    open_: Window
    drawn: Optional[Fraction] = None


@dataclass(frozen=True)
class StrategyPlay:
    """One game of this kind: the setup, the strategy and the seed."""

    setup: Setup
    advisor: Advisor
    seed: int = 1

    def offers(self, play: PlayState) -> Tuple[Offer, ...]:
        """What the person can do now or later, in the order of the agents; ends come last."""
        if play.over:
            return ()
        agents = self.setup.movers
        found: List[Offer] = []
        for move, _ in self.setup.open_moves(play, False):
            owner = self.setup.owner(move)
            if owner in agents:
                drawn = self._drawn(play, move) if self.setup.is_end(move) else None
                found.append(Offer(owner, self.setup.word(move), move, self.setup.own_window(play, move), drawn))
        return tuple(sorted(found, key=lambda offer: (offer.drawn is not None, agents.index(offer.agent))))

    def planned(self, play: PlayState, plan: PlannedMove) -> PlayState:
        """The play with one more thing to be done; it takes the place of what that agent was to do."""
        return replace(play, plans=(*(other for other in play.plans if other.agent != plan.agent), plan))

    def next_event(self, play: PlayState) -> Optional[Event]:
        """What happens first, if anything does. The others win ties, as in the game that was solved."""
        events = [*self._theirs(play), *self._strategy(play)]
        return min(events, key=lambda event: event.at, default=None)

    def advance(self, play: PlayState, until: Optional[Fraction] = None) -> PlayState:
        """The play after what happens next; or at the time `until`, if that comes first.

        Where nothing would ever happen (and no time is named), the play itself.
        """
        event, last = self.next_event(play), self.setup.last_moment(play)
        if event is not None and (until is None or event.at <= until):
            return self._after(play, self.setup.taken(play, event.move, event.at, event.by))
        if last is not None and (until is None or until > last):
            return self.setup.ended(play.passed(last))
        return play if until is None else play.passed(until)

    def _after(self, before: PlayState, play: PlayState) -> PlayState:
        """The play after a move, with what had been decided before it where that stands."""
        return play if self.advisor.decision(before) is None else replace(
            play, standing=self.advisor.standing(before, play)
        )

    def strategy_event(self, play: PlayState) -> Optional[Event]:
        """What the strategy does next, if nothing else happens before."""
        return next(iter(self._strategy(play)), None)

    def _strategy(self, play: PlayState) -> List[Event]:
        decision = self.advisor.decision(play)
        if decision is None:
            return []
        late = self.setup.rules.reaction * self._share("command", len(play.deeds))
        moment = max(_short(decision.at + late, decision.at, decision.at + self.setup.rules.reaction), play.now)
        return [Event(moment, decision.move, ROBOTS)]

    def _theirs(self, play: PlayState) -> List[Event]:
        """What the person has planned; ends without a plan; and what needs no agent and comes at once."""
        plans = {(plan.agent, plan.word): plan.at for plan in play.plans}
        events: List[Event] = []
        for move, open_ in self.setup.open_moves(play, False):
            key = self.setup.owner(move), self.setup.word(move)
            moment: Optional[Fraction] = None
            by = OTHERS
            if key in plans:
                moment = plans[key]
            elif self.setup.is_end(move):
                moment, by = self._drawn(play, move), CHANCE
            elif key[0] not in self.setup.movers:
                delay = open_.earliest(GRAIN)
                moment, by = None if delay is None else play.now + delay, CHANCE
            if moment is not None and open_.holds(moment - play.now):
                events.append(Event(moment, move, by))
        return events

    def _drawn(self, play: PlayState, move: JointMove) -> Optional[Fraction]:
        """When the end of a movement or an action comes by itself; None: it need not come.

        It is drawn when the movement or action begins, and stays so whatever happens meanwhile.
        """
        game, here = self.setup.game, play.position
        bounds = game.automata[move.owner].invariants[here.state.locations[move.owner]]
        if not bounds:
            return None
        high = min(play.now + game.time(bound) - here.clocks[clock - 1] for clock, bound in bounds)
        lows = [play.now - game.time(bound) - here.clocks[j - 1] for i, j, bound in move.bounds if i == 0]
        low = max([*lows, Fraction(0)])
        name, edge = self.setup.owner(move), game.origins[move.edges[0]]
        number = sum(deed.agent == name for deed in play.deeds)
        if edge.leaves is Role.FINDING and any(dict(edge.assign).values()) is not self._is_true(name):
            return None  # it is found to be the other
        if edge.leaves is Role.SOMEWHERE and edge.target != self._start_of(name):
            return None  # it starts elsewhere
        moment = _short(low + (high - low) * self._share(name, number), low, high)
        moment = max(moment, min(low + GRAIN, high))
        return min(max(moment, play.now), high)

    def _start_of(self, agent: str) -> str:
        """Where an agent starts, if the person does not say."""
        (places,) = (each.starts for each in self.setup.scenario.agents if each.name == agent)
        return random.Random(f"{self.seed}/{agent}").choice(places).name

    def _is_true(self, state: str) -> bool:
        """What a state turns out to be, if the person does not say."""
        return random.Random(f"{self.seed}/{state}").random() < 0.5

    def _share(self, name: str, number: int) -> Fraction:
        """Where in a window: each end of it with probability 1/4."""
        draw = random.Random(f"{self.seed}/{name}/{number}")
        kind = draw.randrange(4)
        return Fraction(0) if kind == 0 else Fraction(1) if kind == 1 else Fraction(draw.randrange(1000), 1000)


def _short(moment: Fraction, low: Fraction, high: Fraction) -> Fraction:
    """A moment near this one, in [low, high], with two decimals where that is possible."""
    rounded = Fraction(round(moment * _STEPS), _STEPS)
    return rounded if low < rounded < high else moment
