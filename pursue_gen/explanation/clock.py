"""An allowance of seconds for many solver runs."""

from __future__ import annotations

import multiprocessing
import time
from fractions import Fraction
from multiprocessing.connection import Connection
from typing import Tuple, Union

from pursue_gen.diagnostics import Diagnostic, PursueError, error
from pursue_gen.synthesis import native
from pursue_gen.synthesis.solve import Verdict, solve
from pursue_gen.tga.network import Network, Objective


class Clock:
    """How much of an allowance of seconds is left; solver runs that are cut off when it is used up."""

    def __init__(self, seconds: float) -> None:
        self._end = time.monotonic() + seconds

    def left(self) -> float:
        """Seconds."""
        return self._end - time.monotonic()

    def verdict(self, network: Network, objective: Objective, reaction: Fraction, share: float = 1.0) -> Verdict:
        """What `solve` says. Raises PursueError with exit status 5 when (that share of) the time left is too short."""
        seconds = self.left() * share
        if seconds <= 0:
            raise _too_short()
        if native.available():
            return solve(network, objective, reaction, seconds=seconds)
        return _apart(network, objective, reaction, seconds)


def _apart(network: Network, objective: Objective, reaction: Fraction, seconds: float) -> Verdict:
    """In a process of its own, because the Python engine knows no limits."""
    context = multiprocessing.get_context("fork")
    mine, its = context.Pipe(duplex=False)
    process = context.Process(target=_send, args=(its, network, objective, reaction), daemon=True)
    process.start()
    its.close()
    try:
        if not mine.poll(seconds):
            raise _too_short()
        result: Union[Verdict, Tuple[Tuple[Diagnostic, ...], int]] = mine.recv()
    except EOFError:
        raise _too_short() from None
    finally:
        process.terminate()
        process.join()
        mine.close()
    if isinstance(result, Verdict):
        return result
    raise PursueError(*result)


def _send(pipe: Connection, network: Network, objective: Objective, reaction: Fraction) -> None:
    try:
        pipe.send(solve(network, objective, reaction, engine="python"))
    except PursueError as problem:
        pipe.send((problem.diagnostics, problem.exit_status))
    except KeyboardInterrupt:
        pass


def _too_short() -> PursueError:
    return PursueError([error("EXP001", "no verdict in the time that was left")], exit_status=5)
