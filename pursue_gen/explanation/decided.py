"""What is decided of a scenario that is too large as a whole: each objective alone, and as many together as are won.

Each is looked at in its own part of the scenario, with one robot at first, while the others stand still, then with all.
So a number of states stands beside each statement: what it multiplies the others' with, as far as they touch.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Dict, Iterator, List, Optional, Sequence, Tuple

from pursue_gen.diagnostics import Span, lines_in_words
from pursue_gen.explanation.part import game_of, part_of_scenario
from pursue_gen.language.scenario import Scenario, StatedObjective
from pursue_gen.outcomes import LimitHit
from pursue_gen.solving.options import SolveOptions
from pursue_gen.solving.rules import DEFAULT, Rules
from pursue_gen.solving.shares import can_be_shared, won_in_shares
from pursue_gen.solving.subgoals import commanded_agents
from pursue_gen.solving.vacuity import idle
from pursue_gen.solving.without_pauses import verdict_of
from pursue_gen.synthesis.budget import Budget
from pursue_gen.synthesis.compile_game import compile_game
from pursue_gen.synthesis.cone import cone_of_influence
from pursue_gen.synthesis.game import Game, initial_state, is_bad, joint_moves
from pursue_gen.tga.network import Network

_ALONE, _SET = 0.5, 0.25
"""The part of the budget for single objectives, each of which gets as much as each behind it; of what is left then,
what a set of them gets."""

_ONE_ROBOT = 0.3
"""The part of what a game gets for each robot, the others standing still."""

_Statement = Tuple[StatedObjective, ...]


@dataclass(frozen=True)
class Known:
    """What is known of an objective, written as `text` at that place: whether it is won (None: not decided), and how
    many discrete states its own game has (0: not known)."""

    text: str
    span: Span
    won: Optional[bool]
    states: int


@dataclass(frozen=True)
class Decided:
    """Each objective alone; the places of those that are won together, and of the first one that is not decided
    together with them (None: there is none); `lost`: that one is lost with them."""

    alone: Tuple[Known, ...]
    together: Tuple[Span, ...] = ()
    following: Optional[Span] = None
    lost: bool = False


def decided(scenario: Scenario, rules: Rules, budget: Budget) -> Optional[Decided]:
    """What is decided of several objectives, within the budget; None where there is one."""
    statements = tuple(each_statement(scenario))
    if len(statements) < 2:
        return None
    found: List[Tuple[Known, _Statement]] = []
    some = budget.split(_ALONE)
    for number, (text, statement) in enumerate(statements):
        won, states = decided_within(scenario, statement, rules, some, 1 / (len(statements) - number))
        found.append((Known(text, statement[0].span, won, states), statement))
    alone = tuple(known for known, _ in found)
    easy = sorted((pair for pair in found if pair[0].won), key=lambda pair: pair[0].states)
    kept, lost = easy[:1], False
    failed: Optional[Span] = None
    for known, statement in easy[1:]:
        objectives = [each for _, other in kept for each in other]
        won, _ = decided_within(scenario, [*objectives, *statement], rules, budget, _SET)
        if won:
            kept.append((known, statement))
        elif not failed:
            failed, lost = known.span, won is False
    failed = failed or next((known.span for known in alone if known.won is None), None)
    together = sorted((known.span for known in alone if known in dict(kept)), key=lambda span: (span.line, span.column))
    return Decided(alone, tuple(together), failed, lost)


def decided_within(
    scenario: Scenario, objectives: Sequence[StatedObjective], rules: Rules, budget: Budget, share: float
) -> Tuple[Optional[bool], int]:
    """Whether these alone are won (None: not decided with that share of the budget), and the states of their game."""
    try:
        return _verdict(scenario, objectives, rules, budget, share)
    except LimitHit:
        return None, 0


def texts(found: Decided) -> List[str]:
    """What is decided, a line of text for each objective, and one for those that are won together."""
    lines = [f"line {one.span.line}, {one.text}: {_outcome(one)}" for one in found.alone]
    others = {one.span.written for one in found.alone if one.span not in found.together}
    places = [span if span.written in others else span.written for span in found.together]
    some = lines_in_words(places) if places else ""
    together = [f"Won together: {some}."] if len(found.together) > 1 else []
    if some and found.following:
        verdict = "Lost" if found.lost else "Not decided"
        together.append(f"{verdict} together with {'these' if together else some}: {found.following.in_words}.")
    return [*lines, *([" ".join(together)] if together else [])]


def as_json(found: Decided) -> Dict[str, Any]:
    """What is decided as a JSON object: of places the lines, and of one alone the member of a group that is meant."""
    alone = [{"text": k.text, "line": k.span.line, "won": k.won, "states": k.states} for k in found.alone]
    for one, known in zip(alone, found.alone):
        one.update({"member": known.span.member} if known.span.member else {})
    following = found.following.line if found.following else 0
    lines = list(dict.fromkeys(span.line for span in found.together))
    return {"alone": alone, "together": lines, "next_line": following, "lost": found.lost}


def _outcome(one: Known) -> str:
    if one.won is None:
        return "not decided alone"
    return f"alone it is {'won' if one.won else 'lost'}, with {one.states} states"


def _verdict(
    scenario: Scenario, objectives: Sequence[StatedObjective], rules: Rules, budget: Budget, share: float
) -> Tuple[bool, int]:
    network, objective = game_of(part_of_scenario(scenario, objectives, rules), rules)
    for game in _with_one_robot(network):
        try:
            verdict = budget.verdict(cone_of_influence(game, objective), objective, rules.reaction, share * _ONE_ROBOT)
        except LimitHit:
            continue
        if verdict.won:
            return True, verdict.stats.discrete_states
    if can_be_shared(network, objective):
        limits = budget.part(share)
        shared = won_in_shares(network, objective, rules.reaction, SolveOptions(limits))
        budget.spend(limits.work if shared is None else min(limits.work, shared.stats.work))
        if shared is not None:
            return True, shared.stats.discrete_states
    verdict = verdict_of(budget, network, objective, rules.reaction, share)
    return verdict.won, verdict.stats.discrete_states


def _with_one_robot(network: Network) -> Iterator[Network]:
    """The network in which one of several controlled agents gets commands: what is won there is won."""
    robots = commanded_agents(network)
    for robot in robots if len(robots) > 1 else ():
        yield idle(network, set(robots) - {robot})


def each_statement(scenario: Scenario) -> Iterator[Tuple[str, _Statement]]:
    """The objectives of each statement, and its text."""
    found: Dict[Span, List[StatedObjective]] = {}
    for objective in scenario.objectives:
        found.setdefault(objective.span, []).append(objective)
    for some in found.values():
        yield some[0].statement(some).text, tuple(some)


_STATES, _OF_ALL = 2_000, 16_000
"""So many states are counted of a statement, and of all: a quarter of a second. Measured on lab scenarios."""


@dataclass(frozen=True)
class Size:
    """A statement, and what it costs: how many discrete states its own game has, which those of others multiply;
    `more`: that many, and more."""

    span: Span
    states: int
    more: bool

    def in_words(self) -> str:
        """What stands beside the statement."""
        return f"{'over ' if self.more else ''}{self.states:,} states"


def sizes(scenario: Scenario) -> Tuple[Size, ...]:
    """The sizes of the objectives' statements in the default game, in their order, as far as so many states tell. Times
    are left aside, so a game has no more states than are counted here."""
    found: List[Size] = []
    left = _OF_ALL
    for _, statement in each_statement(scenario):
        if left < _STATES:
            break
        network, objective = game_of(part_of_scenario(scenario, statement, DEFAULT), DEFAULT)
        states = _count(compile_game(cone_of_influence(network, objective), objective))
        found.append(Size(statement[0].span, states, states == _STATES))
        left -= states
    return tuple(found)


def _count(game: Game) -> int:
    """The discrete states that moves lead to, whatever the clocks are; _STATES where there are that many or more."""
    start = initial_state(game)
    seen, waiting = {start}, [start]
    while waiting:
        state = waiting.pop()
        for move in () if is_bad(game, state) else joint_moves(game, state):
            if move.target not in seen:
                if len(seen) == _STATES:
                    return _STATES
                seen.add(move.target)
                waiting.append(move.target)
    return len(seen)
