"""What the process beside the page does while a person plays a scenario: the commands of `pursue-gen play`."""

from __future__ import annotations

from multiprocessing.connection import Connection
from typing import Any, Dict, List, Sequence

from pursue_gen.language.checks import checked
from pursue_gen.language.symbols import Role, Symbol
from pursue_gen.solving.inputs import settled
from pursue_gen.solving.options import SolveOptions
from pursue_gen.solving.request import SolveRequest
from pursue_gen.solving.rules import Rules
from pursue_gen.synthesis.limits import Limits
from pursue_gen.tools.draw.solve_work import Progressing, Work, working
from pursue_gen.tools.play.session import Session, answer, choices, opening, session_of

_NOT_HERE = ("save", "quit", "exit")


def play(given: Work, pipe: Connection) -> None:
    """Sends {"game": …} for the beginning and after each line that comes; ends where nothing comes any more."""
    with working(pipe):
        session = _begun(given, pipe)
        lines: Sequence[str] = opening(session)
        for turn in range(1, 1_000_000):
            pipe.send({"game": _shown(session, lines, turn)})
            line = str(pipe.recv())
            if line.split()[:1] and line.split()[0].lower() in _NOT_HERE:
                lines = ("A game on the page is not saved; End the game ends it.",)
            else:
                reply = answer(session, line)
                session, lines = reply.session, reply.lines


def _begun(given: Work, pipe: Connection) -> Session:
    progress = Progressing(pipe)
    limits = Limits(given.seconds, given.memory)
    request = SolveRequest(options=SolveOptions(limits=limits, progress=progress))
    scenario = settled(checked(given.text, given.file), request, progress)
    return session_of(scenario, Rules(), 1, limits, progress)


def _shown(session: Session, lines: Sequence[str], turn: int) -> Dict[str, Any]:
    """What the page shows: lines, what can be done, the place that each of these leads to ("": to none), and where
    everybody is: [place], or [from, to] on a way."""
    setup, play_ = session.setup, session.play
    at: Dict[str, List[str]] = {}
    for number, automaton in enumerate(setup.game.automata):
        if automaton.name in setup.agents:
            location = automaton.locations[play_.position.state.locations[number]]
            here = Symbol.of(location)
            if here.parts:  # else nobody has said yet where it starts
                at[automaton.name] = list(here.parts if here.role is Role.WAY else here.parts[-1:])
    said = [] if play_.over else choices(session)
    found: Dict[str, Any] = {"turn": turn, "lines": list(lines), "choices": [list(one) for one in said]}
    return {**found, "to": _destinations(session), "over": play_.over, "at": at}


def _destinations(session: Session) -> List[str]:
    """For each thing that can be done, the place to which somebody sets off with it; "" where nobody does."""
    offers = () if session.play.over else session.game.offers(session.play)
    targets = [Symbol.of(session.setup.game.origins[offer.move.edges[0]].target) for offer in offers]
    return [target.parts[-1] if target.role is Role.WAY else "" for target in targets]
