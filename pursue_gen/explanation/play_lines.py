"""A counter-play line by line, in the scenario's own words."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from typing import Callable, Dict, Iterator, List, Sequence, Tuple

from pursue_gen.diagnostics import listed
from pursue_gen.explanation.endless import may_repeat
from pursue_gen.explanation.play import CounterStep, Play
from pursue_gen.language import network_names as names
from pursue_gen.language.scenario import Scenario
from pursue_gen.language.symbols import Role
from pursue_gen.language.times import moment
from pursue_gen.synthesis.game import joint_moves
from pursue_gen.tga.assumptions import who_awaited
from pursue_gen.tga.objectives import stated
from pursue_gen.vocabulary.agents import deed
from pursue_gen.vocabulary.losses import loss

_MOST_OTHERS = 3
"""So many of the others' last actions are named in an attempt."""


@dataclass(frozen=True)
class TimedLine:
    """Something that happens at a time (in units since the start); `who` is an agent, or empty."""

    at: Fraction
    who: str
    text: str


def describe(scenario: Scenario, play: Play) -> Tuple[TimedLine, ...]:
    """The play step by step, and at last how it ends."""
    lines: List[TimedLine] = []
    for step in play.steps:
        who, text = _deed(scenario, play, step.owner, step.edges)
        if text:
            lines.append(TimedLine(step.at, who, text + "".join(_remarks(scenario, play, step))))
    return (*lines, *_ending(scenario, play))


@dataclass(frozen=True)
class Attempt:
    """What the robots could begin with, and what comes of it, in words."""

    first: str
    why: str


def attempt(scenario: Scenario, play: Play) -> Attempt:
    """How a play begins that the robots have to begin in a certain way, and what the others do until it is lost."""
    first = "the robots wait"
    if play.first:
        first = " ".join(_deed(scenario, play, play.game.edges[play.first[0]].automaton, play.first))
    others = {agent.name for agent in scenario.agents if not agent.controllable}
    done: List[str] = []
    for step in play.steps:
        who, text = _deed(scenario, play, step.owner, step.edges)
        owner = play.game.automata[step.owner].name
        owner = who_awaited(owner, scenario) or owner
        edge = play.game.origins[step.edges[0]]
        if text and (edge.leaves in (Role.FINDING, Role.SOMEWHERE) or (owner in others and not edge.is_end)):
            done.append(f"{who} {text} at {moment(step.at, scenario.unit)}")
    ending = _ending(scenario, play)[0]
    return Attempt(first, "; ".join([*done[-_MOST_OTHERS:], f"{ending.text} ({moment(ending.at, scenario.unit)})"]))


def _deed(scenario: Scenario, play: Play, owner: int, edges: Sequence[int]) -> Tuple[str, str]:
    """The agent that makes a move, as people read it, and what it does; "" for what is no agent's."""
    name = play.game.automata[owner].name
    name = who_awaited(name, scenario) or name
    done = deed(scenario, name, play.game.origins[edges[0]])
    return scenario.shown(name), "" if done is None else done.does


def _remarks(scenario: Scenario, play: Play, step: CounterStep) -> Iterator[str]:
    """What the step means for a deadline."""
    objectives = stated(scenario)
    for k in step.edges:
        objective = objectives.get(play.game.automata[play.game.edges[k].automaton].name)
        if objective is None or objective.limit is None:
            continue
        limit = objective.limit_in(play.game.origins[k].target)
        if limit is not None and play.game.origins[k].resets:
            yield f" ({objective.words.must} by {moment(step.at + limit, scenario.unit)})"
        elif play.game.origins[k].target == names.IDLE and objective.words.in_time:
            yield f" ({objective.words.in_time})"


def _ending(scenario: Scenario, play: Play) -> Tuple[TimedLine, ...]:
    tell: Dict[str, Callable[[Scenario, Play], str]] = {
        "bad": _loss,
        "overdue": _loss,
        "idle": lambda s, p: f"nobody has to do anything any more{_goal_clause(s, ', and ', ' need never come')}",
        "again": lambda s, p: f"all is as it was at {moment(p.since, s.unit)}, and so it can go on for ever"
        f"{_goal_clause(s, ': ', ' can always be prevented')}",
        "endless": _endless,
        "open": lambda s, p: "and so on: from here, too, it can be prevented whatever the robots do",
    }
    texts = [tell[play.end](scenario, play)]
    if play.end in ("overdue", "idle"):
        texts += _withheld(scenario, play)
    return tuple(TimedLine(play.at, "", text) for text in texts)


def _withheld(scenario: Scenario, play: Play) -> Iterator[str]:
    """At the end, where nobody is at anything: what the others do not do, and need not."""
    game, state = play.game, play.position.state
    agents = {agent.name for agent in scenario.agents}
    if any(a.name in agents and a.invariants[k] for a, k in zip(game.automata, state.locations)):
        return
    # Agents' guards only bound their clocks from below: what is not possible yet will be.
    moves = [move for move in joint_moves(game, state) if game.automata[move.owner].name in agents]
    able = (_deed(scenario, play, move.owner, move.edges) for move in moves if not move.controllable)
    undone = ", ".join(dict.fromkeys(map(" ".join, able)))
    if undone and not any(move.controllable for move in moves):
        yield f"the robots can do nothing before one of these, and none of them needs to happen: {undone}"
    elif undone and play.end == "idle":
        yield f"these could still happen, and need not: {undone}"


def _endless(scenario: Scenario, play: Play) -> str:
    game, state = play.game, play.position.state
    repeated: Dict[str, List[str]] = {}
    for move in joint_moves(game, state):
        edge = game.origins[move.edges[0]]
        if may_repeat(edge) and edge.sync is not None:
            repeated.setdefault(game.automata[move.owner].name, []).append(edge.sync.channel)
    who = ", ".join(
        f"{scenario.shown(name)} with {' and '.join(dict.fromkeys(map(scenario.shown, events)))}"
        for name, events in repeated.items()
    )
    return f"and so on without end, {who}: no time passes, and the robots never get to act"


def _goal_clause(scenario: Scenario, before: str, after: str) -> str:
    wanted = dict.fromkeys(ref.shown for reach in scenario.reach for ref in reach.events)
    return f"{before}{listed(wanted)}{after}" if wanted else ""


def _loss(scenario: Scenario, play: Play) -> str:
    return loss(scenario, play.game, play.position.state, [play.game.automata[k].name for k in play.overdue])
