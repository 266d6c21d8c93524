"""A game as a person has it: what they type in, what they read. Nothing here knows a terminal.

Every reply leads to another session; the one before stays as it was, which is all that `undo` needs. A scenario is a
game against its strategy, or against a counter-strategy.
"""

from __future__ import annotations

import re
from dataclasses import dataclass, field, replace
from fractions import Fraction
from pathlib import Path
from typing import Callable, Dict, List, Optional, Sequence, Tuple, Union

from pursue_gen.diagnostics import PursueError
from pursue_gen.language.numbers import time_text
from pursue_gen.language.scenario import Scenario
from pursue_gen.language.sentences import objective_words, promise_words
from pursue_gen.language.times import unit_name
from pursue_gen.outcomes import Lost
from pursue_gen.solving.optional import promised
from pursue_gen.solving.options import SolveOptions
from pursue_gen.solving.rules import Rules
from pursue_gen.solving.solution import solve_scenario
from pursue_gen.synthesis.limits import NO_LIMITS, Limits, Listener
from pursue_gen.tools.play.counter import CounterPlay, counter_game
from pursue_gen.tools.play.saving import save
from pursue_gen.tools.play.situation import ending, overview, situation, window_text
from pursue_gen.tools.play.state import RUNNING, PlannedMove, PlayState, Setup, setup_of
from pursue_gen.tools.play.world import Advisor, Holding, Offer, StrategyPlay
from pursue_gen.vocabulary.words import Words, words_of

GameOf = Union[StrategyPlay, CounterPlay]

_MOMENT = r"(\d{1,6}(?:\.\d{0,3})?)"
_NUMBER = re.compile(rf"(\d{{1,4}})(?:\s*(?:@|at)\s*{_MOMENT})?")
_WAIT = re.compile(rf"wait(?:\s+(?:(@|at|until)\s*)?{_MOMENT})?")

HELP = (
    "2            do number 2 of the list as soon as possible",
    "2 @ 3.5      do it at the time 3.5 (times count from the start)",
    "wait         until something happens",
    "wait 2       for 2 units of time, or until something happens",
    "wait @ 7     until the time 7, or until something happens",
    "cancel       forget what is planned for later",
    "undo, redo   take a step back, or forward again",
    "map          where the agents are, and the ways with their distances",
    "why          what the strategy says here, and which of its blocks says so",
    "log          everything that has happened so far",
    "save FILE    write the game down: a trace for the node UI; with the ending .jsonl a journal for pursue-gen replay",
    "help, quit   this list; the end. Enter alone shows the list of what can be done again.",
)


@dataclass(frozen=True)
class Session:
    """A game in progress; `past` and `future` are for undo and redo, the nearest play last."""

    game: GameOf
    words: Words
    play: PlayState
    past: Tuple[PlayState, ...] = ()
    future: Tuple[PlayState, ...] = ()

    @property
    def setup(self) -> Setup:
        """The setup."""
        return self.game.setup


@dataclass(frozen=True)
class Reply:
    """The lines to print, and how the session goes on; `over`: it has ended."""

    session: Session
    lines: Tuple[str, ...]
    over: bool = field(default=False)


def opening(session: Session) -> Tuple[str, ...]:
    """The first lines."""
    setup = session.setup
    wants = (f"{setup.scenario.name}. What is wanted:", *(f"  {wish}" for wish in objective_words(setup.scenario)))
    wants += tuple(f"  ({sentence}.)" for sentence in promise_words(setup.scenario))
    if setup.scenario.assumed:
        wants += ("What is assumed of others:", *(f"  {a.clause}." for a in setup.scenario.assumed))
    if isinstance(session.game, StrategyPlay):
        plays = f"a strategy of {session.game.advisor.size} blocks plays the robots."
        first = ("The robots can see to it, whatever others do.", f"You play all other agents, {plays}")
    else:
        first = (
            "The robots cannot be sure of it.",
            "You play the robots; the program plays the others, and can always prevent it.",
        )
    unit = unit_name(session.setup.scenario.unit)
    hint = f"Times are in {unit} from the start. Type help for what you can say."
    return (*wants, *first, hint, "", *shown(session))


def shown(session: Session) -> Tuple[str, ...]:
    """Where everything stands, what comes next, and what the person can do."""
    setup, play = session.setup, session.play
    if play.over:
        return (ending(setup, play),)
    lines = [f"Time {time_text(play.now)}", *situation(setup, session.words, play)]
    if isinstance(session.game, StrategyPlay):
        lines.append(_intention(session, session.game))
    lines += _planned(session)
    said = choices(session)
    lines.append("You can do:" if said else "There is nothing for you to do here but to wait.")
    widest = max((len(what) for what, _ in said), default=0)
    lines += [f"  {number:>2}  {what:<{widest}}  {when}" for number, (what, when) in enumerate(said, start=1)]
    return tuple(lines)


def choices(session: Session) -> Tuple[Tuple[str, str], ...]:
    """What the person can do, in the order of its numbers: what, and when that is possible."""
    return tuple(_offered(session, offer) for offer in session.game.offers(session.play))


def _offered(session: Session, offer: Offer) -> Tuple[str, str]:
    edge = session.setup.game.origins[offer.move.edges[0]]
    when = window_text(session.play.now, offer.open_)
    drawn = "" if offer.drawn is None else f" (comes at {time_text(offer.drawn)} if you say nothing)"
    return session.words.command(offer.agent, edge), when + drawn


def _intention(session: Session, world: StrategyPlay) -> str:
    play, event = session.play, world.strategy_event(session.play)
    while event is not None and session.setup.owner(event.move) not in session.setup.movers:
        play = session.setup.taken(play, event.move, event.at, event.by)  # a person sees no difference
        event = None if play.over else world.strategy_event(play)
    if event is None:
        return "The strategy waits for what others do."
    what = session.words.sentence(session.setup.owner(event.move), session.setup.game.origins[event.move.edges[0]])
    return f"The strategy: {what} at {time_text(event.at)}, if nothing else happens before."


def _planned(session: Session) -> List[str]:
    """What the person has typed for later."""
    known = {(offer.agent, offer.word): _offered(session, offer)[0] for offer in session.game.offers(session.play)}
    plans = [plan for plan in session.play.plans if (plan.agent, plan.word) in known]
    return [f"Planned: {known[plan.agent, plan.word]} at {time_text(plan.at)}." for plan in plans]


# What a person types --------------------------------------------------------------------------------------------------


def answer(session: Session, text: str) -> Reply:
    """What follows from a line that was typed. A line that cannot be understood changes nothing, and is explained."""
    line = " ".join(text.split())
    word, _, rest = line.partition(" ")
    simple: Dict[str, Callable[[Session], Reply]] = {
        "": lambda s: Reply(s, shown(s)),
        "help": lambda s: Reply(s, HELP),
        "?": lambda s: Reply(s, HELP),
        "undo": _undo,
        "redo": _redo,
        "map": lambda s: Reply(s, tuple(overview(s.setup, s.words, s.play))),
        "why": lambda s: Reply(s, tuple(_why(s))),
        "log": lambda s: Reply(s, tuple(_described(s, 0)) or ("nothing has happened yet",)),
        "cancel": lambda s: _moved(s, replace(s.play, plans=())),
        "quit": lambda s: Reply(s, (farewell(s),), True),
    }
    simple["exit"] = simple["quit"]
    if line.lower() in simple:
        return simple[line.lower()](session)
    if word.lower() == "save":
        return _save(session, rest)
    number, wait = _NUMBER.fullmatch(line), _WAIT.fullmatch(line.lower())
    if session.play.over and (number or wait):
        return Reply(session, ("The game is over: undo takes a step back, quit ends.",))
    if number:
        return _do(session, int(number.group(1)), number.group(2))
    if wait:
        return _wait(session, wait.group(1) is not None, wait.group(2))
    if word.lower() == "wait" or word.isdigit():
        return Reply(
            session,
            (
                f"'{line}' is not clear. For example: wait, wait 2, wait @ 7, 2, 2 @ 3.5 "
                "(a moment has at most three decimals).",
            ),
        )
    known = "a number from the list, wait, undo, map, why, help, quit"
    return Reply(session, (f"'{line[:60]}' is not known here. Say {known} …",))


def _do(session: Session, number: int, moment: Optional[str]) -> Reply:
    play, offers = session.play, session.game.offers(session.play)
    if not 1 <= number <= len(offers):
        some = f"the list has 1 to {len(offers)}" if offers else "there is nothing to do but to wait"
        return Reply(session, (f"There is no number {number}: {some}.",))
    offer = offers[number - 1]
    what = _offered(session, offer)[0]
    if moment is None:
        delay = offer.open_.earliest(Fraction(1, 1000))
        assert delay is not None, "what is offered can be done"
        at = play.now + delay
    else:
        at = Fraction(moment)
        if at < play.now:
            return Reply(session, (f"It is {time_text(play.now)} already: name a later time, or undo.",))
        if not offer.open_.holds(at - play.now):
            return Reply(session, (f"Not at {moment}: '{what}' is possible {window_text(play.now, offer.open_)}.",))
    planned = session.game.planned(play, PlannedMove(offer.agent, offer.word, at))
    return _moved(session, _advanced(session, planned))


def _wait(session: Session, absolute: bool, amount: Optional[str]) -> Reply:
    play = session.play
    if amount is None:
        after = _advanced(session, play)
        if after == play:
            return Reply(session, ("Nothing will ever happen if you only wait.", *_hopeless(session)))
        return _moved(session, after)
    until = Fraction(amount) if absolute else play.now + Fraction(amount)
    if until < play.now:
        return Reply(session, (f"It is {time_text(play.now)} already.",))
    return _moved(session, _advanced(session, play, until))


def _advanced(session: Session, play: PlayState, until: Optional[Fraction] = None) -> PlayState:
    """The play when something has happened that a person would notice, or at the time `until`."""
    while True:
        before, play = play, session.game.advance(play, until)
        silent = len(play.deeds) > len(before.deeds) and play.deeds[-1].agent not in session.setup.movers
        if play.over or not silent:
            return play


def _hopeless(session: Session) -> Tuple[str, ...]:
    if isinstance(session.game, CounterPlay):
        return ("The others need not do anything: do something, or quit.",)
    return ("The strategy has nothing to do as long as no other agent does: do something, or quit.",)


def _moved(session: Session, play: PlayState) -> Reply:
    """The session at another play, with what has happened in between."""
    fresh = replace(session, play=play, past=(*session.past, session.play), future=())
    lines = _described(fresh, len(session.play.deeds)) + _missed(session, play)
    return Reply(fresh, (*lines, *_again(fresh, session), *shown(fresh)))


def _described(session: Session, first: int) -> List[str]:
    """What has happened, from that step on."""
    lines = []
    for deed in session.play.deeds[first:]:
        if deed.agent in session.setup.movers:
            said = session.words.sentence(deed.agent, session.setup.game.origins[deed.edges[0]])
            lines.append(f"{time_text(deed.at):>9}  {said}")
    return lines


def _missed(before: Session, play: PlayState) -> List[str]:
    """Plans that came to nothing: something else was faster, and now they are not possible any more."""
    done = {(deed.agent, deed.word) for deed in play.deeds[len(before.play.deeds) :]}
    kept = {(plan.agent, plan.word) for plan in play.plans}
    known = {(offer.agent, offer.word): _offered(before, offer)[0] for offer in before.game.offers(before.play)}
    gone = [plan for plan in before.play.plans if (plan.agent, plan.word) not in done | kept]
    return [
        f"           {known[plan.agent, plan.word]}: not possible any more"
        for plan in gone
        if (plan.agent, plan.word) in known
    ]


def _again(session: Session, before: Session) -> List[str]:
    """In a game that need not end: that it goes round in circles."""
    if not isinstance(session.game, CounterPlay) or len(session.play.deeds) == len(before.play.deeds):
        return []
    since = session.game.repeats(session.play)
    if since is None:
        return []
    return [f"Everything is as it was at {time_text(since)}: like this it goes on for ever, without the goal."]


def _undo(session: Session) -> Reply:
    if not session.past:
        return Reply(session, ("This is where it began.",))
    fresh = replace(session, play=session.past[-1], past=session.past[:-1], future=(*session.future, session.play))
    return Reply(fresh, shown(fresh))


def _redo(session: Session) -> Reply:
    if not session.future:
        return Reply(session, ("There is nothing to do again.",))
    fresh = replace(session, play=session.future[-1], past=(*session.past, session.play), future=session.future[:-1])
    return Reply(fresh, shown(fresh))


def _why(session: Session) -> Sequence[str]:
    game = session.game
    if isinstance(game, CounterPlay):
        text = "There is no strategy for the robots: whatever they do, the others can answer."
        if game.horizon is not None:
            return (text, f"They will have lost by {game.horizon} at the latest.")
        return (text, "After each step of the others the solver still finds the game lost for the robots.")
    holdings = game.advisor.holdings(session.play)
    lines = [line for holding in holdings for line in _block_texts(session, holding, game.advisor.size)]
    return lines or ("The game is over here: the strategy has nothing more to say.",)


def _block_texts(session: Session, holding: Holding, size: int) -> List[str]:
    """What a block says; nothing where it does not know this point."""
    if holding.zone is None:
        return []
    says = "to wait"
    lines = [f"Block {holding.number} of {size} of the strategy holds here."]
    if holding.command is not None:
        first = holding.command.moves[0]
        says = session.words.command(first.automaton, first.edge)
    when = f": {session.words.when(holding.zone)}" if holding.zone else " nothing else happens"
    lines.append(f"It says {says}, as long as{when}.")
    for command in holding.block.commands:
        if command is not holding.command:
            first = command.moves[0]
            said = session.words.command(first.automaton, first.edge)
            when = " or ".join(session.words.when(zone) for zone in command.zones)
            lines.append(f"At other moments here: {said}, as long as: {when}.")
    return lines


def _save(session: Session, name: str) -> Reply:
    if not name:
        return Reply(session, ("save needs the name of a file: save game.yaml, or save game.jsonl",))
    if Path(name).exists():
        return Reply(session, (f"{name} is there already: name another file.",))
    try:
        return Reply(session, (save(session.setup, session.play, Path(name)),))
    except PursueError as problem:
        return Reply(session, tuple(finding.message for finding in problem.diagnostics))


def farewell(session: Session) -> str:
    """How it stood when the person left."""
    play, setup = session.play, session.setup
    if play.status != RUNNING:
        return ending(setup, play)
    at = time_text(play.now)
    if isinstance(session.game, CounterPlay):
        return f"You have left at {at}: the robots have not done it, and could not have been sure of it."
    if setup.safety:
        return f"You have left at {at}: so far the robots have kept it."
    return f"You have left at {at}, before the goal was reached; the robots would have reached it."


def session_of(
    scenario: Scenario,
    rules: Rules,
    seed: int = 1,
    limits: Limits = NO_LIMITS,
    progress: Optional[Listener] = None,
) -> Session:
    """A new game of a scenario: the person plays the others where its objectives can be met, else the robots.

    Raises LimitHit where a limit is hit before it is decided.
    """
    try:
        options = SolveOptions(limits, progress=progress)
        found = promised(scenario, options, lambda some, how: solve_scenario(some, rules, how))
    except Lost:
        setup = setup_of(scenario.giving_up(scenario.optional), rules)
        game: GameOf = counter_game(setup, limits.memory, progress)
    else:
        setup = setup_of(found.scenario, rules, found.solution.strategy)
        game = StrategyPlay(setup, Advisor(setup, found.solution.strategy), seed)
    return Session(game, words_of(setup.scenario, setup.network), setup.beginning())
