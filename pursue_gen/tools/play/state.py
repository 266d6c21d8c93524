"""The play at which a game is played: frozen positions with exact times, and the steps that lead from one to the next.

A play remembers how its discrete state was entered, and what was decided before: what the strategy decides, and when,
follows from that, however often it is computed in between.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Iterator, Optional, Tuple

from pursue_gen.explanation.policy import Window, longest, window, within
from pursue_gen.explanation.position import Position
from pursue_gen.language.scenario import Scenario
from pursue_gen.solving.rules import Rules, played
from pursue_gen.synthesis.compile_game import compile_game
from pursue_gen.synthesis.game import Game, JointMove, initial_state, is_bad, is_goal, joint_moves
from pursue_gen.synthesis.strategy import Command, Strategy, with_automata_of
from pursue_gen.tga import scenario_objective, translate
from pursue_gen.tga.event_words import event_word
from pursue_gen.tga.network import Network, Objective

GRAIN = Fraction(1, 1000)
"""Time units after a moment that is itself just too early; moments that people name are multiples of it."""

RUNNING, WON, LOST, STUCK = "running", "won", "lost", "stuck"
"""How it stands. WON: the goal is reached; LOST: the robots have lost; STUCK: an uncontrollable agent
ought to move and cannot, so that nothing goes on (a safety objective holds for ever then)."""

ROBOTS, OTHERS, CHANCE = "robots", "others", "chance"
"""Who did something: the robots' side; the others' side, on purpose; a movement or an action that just ended."""


@dataclass(frozen=True)
class Setup:
    """What stays the same: the scenario, its rules, the game (without a reaction delay)."""

    scenario: Scenario
    rules: Rules
    network: Network
    objective: Objective
    game: Game

    @property
    def agents(self) -> Tuple[str, ...]:
        """All agents, in order of declaration."""
        return tuple(agent.name for agent in self.scenario.agents)

    @property
    def movers(self) -> Tuple[str, ...]:
        """The automata whose moves people see: agents, and states of which it is found out what they are."""
        return (*self.agents, *self.scenario.facts)

    @property
    def safety(self) -> bool:
        """True where there is nothing to reach, and so no end but by losing."""
        return not self.objective.reaches

    def owner(self, move: JointMove) -> str:
        """The automaton that moves."""
        return self.game.automata[move.owner].name

    def word(self, move: JointMove) -> str:
        """What the move is called on the topics."""
        return event_word(self.owner(move), self.game.origins[move.edges[0]])

    def is_end(self, move: JointMove) -> bool:
        """True for the end of a movement or an action."""
        return self.game.origins[move.edges[0]].is_end

    def beginning(self) -> PlayState:
        """The play at time 0."""
        return PlayState(Position(initial_state(self.game), (Fraction(0),) * len(self.game.clocks)))

    def open_moves(self, play: PlayState, controllable: bool) -> Iterator[Tuple[JointMove, Window]]:
        """The moves of one side from here on, with the delays (from now) after which they can be made."""
        here = play.position
        for move in joint_moves(self.game, here.state):
            if move.controllable == controllable:
                open_ = window(self.game, here, move)
                if open_.earliest(GRAIN) is not None:  # else it is over, or would break an invariant
                    yield move, open_

    def own_window(self, play: PlayState, move: JointMove) -> Window:
        """The delays (from now) in which a move can be made as far as its own automaton goes.

        Another agent that has to move before ends the state of the game, but not what this one may do.
        """
        game, here = self.game, play.position
        mine = game.automata[move.owner].invariants[here.state.locations[move.owner]]
        return within(game, here, (*((clock, 0, bound) for clock, bound in mine), *move.bounds))

    def last_moment(self, play: PlayState) -> Optional[Fraction]:
        """The time until which some agent has to move; None: none has to."""
        room = longest(self.game, play.position)
        return None if room is None else play.now + room

    def taken(self, play: PlayState, move: JointMove, moment: Fraction, by: str) -> PlayState:
        """The play after a move at a moment. Plans that cannot be carried out any more are dropped.

        Where the objective can be lost by nobody's doing then, as where two meet that must not, it is lost at once.
        """
        there = play.entry.after(move, moment - play.since)
        status = WON if is_goal(self.game, there.state) else LOST if is_bad(self.game, there.state) else RUNNING
        deed = PlayedMove(moment, self.owner(move), self.word(move), by, there, move.edges)
        fresh = PlayState(there, moment, moment, status, (*play.deeds, deed))
        lost = None if fresh.over else self._broken(fresh)
        if lost is not None:
            return self.taken(fresh, lost, moment, OTHERS)
        kept = (plan for plan in play.plans if not (plan.agent == deed.agent and plan.word == deed.word))
        return replace(fresh, plans=() if fresh.over else tuple(plan for plan in kept if self.possible(fresh, plan)))

    def _broken(self, play: PlayState) -> Optional[JointMove]:
        """The move of an objective that is broken now, as the observer of a mission takes it; None where none is."""
        watching = {name for name, _ in self.objective.bad}
        for move, open_ in self.open_moves(play, False):
            edge = self.game.origins[move.edges[0]]
            if self.owner(move) in watching and edge.sync is None and open_.holds(Fraction(0)):
                return move if is_bad(self.game, move.target) else None
        return None

    def possible(self, play: PlayState, plan: PlannedMove) -> bool:
        """True if the plan can still be carried out, unless something else happens before."""
        return any(
            (self.owner(move), self.word(move)) == (plan.agent, plan.word)
            and self.own_window(play, move).holds(plan.at - play.now)
            for move in joint_moves(self.game, play.position.state)
        )

    def overdue(self, play: PlayState) -> Tuple[str, ...]:
        """The automata at their bounds now that the others' side cannot move: then the robots ought to."""
        here, game = play.position, self.game
        bound = {
            number
            for number, automaton in enumerate(game.automata)
            for clock, limit in automaton.invariants[here.state.locations[number]]
            if game.time(limit) == here.clocks[clock - 1]
        }
        able = {move.owner for move, open_ in self.open_moves(play, False) if open_.holds(Fraction(0))}
        return tuple(game.automata[number].name for number in sorted(bound - able))

    def ended(self, play: PlayState) -> PlayState:
        """The play where time cannot go on and no agent can move as it must: who is to blame has lost.

        With a goal to reach, it is not reached: the robots have lost. Else whoever is overdue and could only be moved
        by the robots' side has lost it for them.
        """
        names = self.overdue(play)
        ours = {agent.name for agent in self.scenario.agents if agent.controllable}
        blame = not self.safety or any(name in ours or name not in self.agents for name in names)
        return replace(play, status=LOST if blame else STUCK)


@dataclass(frozen=True)
class PlayedMove:
    """A joint move that was made: when (time units since the start), by which automaton, whose doing it was."""

    at: Fraction
    agent: str
    word: str
    by: str
    after: Position
    edges: Tuple[int, ...]


@dataclass(frozen=True)
class PlannedMove:
    """What a person wants an agent to do at a moment (time units since the start)."""

    agent: str
    word: str
    at: Fraction


@dataclass(frozen=True)
class StandingDecision:
    """What the block of this number (from 1) has decided, and when (time units since the start)."""

    number: int
    command: Command
    at: Fraction


@dataclass(frozen=True)
class PlayState:
    """`entry` is the position at the time `since`, when the last move was made; now it is `now`.

    `standing`: what blocks of the strategy had decided before that move, if it changed nothing that matters to them;
    the others decide anew at `since`.
    """

    entry: Position
    since: Fraction = Fraction(0)
    now: Fraction = Fraction(0)
    status: str = RUNNING
    deeds: Tuple[PlayedMove, ...] = ()
    plans: Tuple[PlannedMove, ...] = ()
    standing: Tuple[StandingDecision, ...] = ()

    @property
    def position(self) -> Position:
        """The position now."""
        return self.entry.later(self.now - self.since)

    @property
    def over(self) -> bool:
        """True when the game has ended."""
        return self.status != RUNNING

    def passed(self, moment: Fraction) -> PlayState:
        """The play at a later moment, when nothing has happened in between."""
        assert moment >= self.now
        return replace(self, now=moment)


def setup_of(scenario: Scenario, rules: Rules, strategy: Optional[Strategy] = None) -> Setup:
    """The setup of a scenario; `strategy`: the one that is played, whose automata are in the network.

    Raises PursueError where the scenario has no objective."""
    network, objective = played(translate(scenario), rules), scenario_objective(scenario)
    network = network if strategy is None else with_automata_of(network, strategy)
    return Setup(scenario, rules, network, objective, compile_game(network, objective))
