"""The person plays whatever the robots' strategy does not control; the strategy plays the robots.

What the person does not decide is drawn: when movements and actions end (anywhere in the model's window), and how late
a command takes effect (at most the promised reaction). A draw depends on the seed and on the number of the step only,
so undoing and doing the same again leads to the same.
"""

from __future__ import annotations

import random
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import List, Optional, Tuple

from pursue_gen.explanation.policy import Window
from pursue_gen.language.symbols import Role
from pursue_gen.synthesis.game import JointMove
from pursue_gen.tools.play.advice import Advisor
from pursue_gen.tools.play.state import CHANCE, GRAIN, OTHERS, ROBOTS, PlannedMove, PlayState, Setup

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
