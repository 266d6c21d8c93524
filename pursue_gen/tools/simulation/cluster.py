"""Simulated missions on the machines of a Dask cluster.

Needs the package `distributed`, which is imported only here. The missions are those of one machine: a mission depends
on its number alone.
"""

from __future__ import annotations

import contextlib
import threading
from collections import deque
from typing import Any, ContextManager, Deque, Iterator, List, Sequence

import pursue_runtime
from pursue_gen.diagnostics import error
from pursue_gen.outcomes import Unavailable, Unfinished
from pursue_gen.tools.simulation.outcome import Outcome
from pursue_gen.tools.simulation.runs import SHARE, Case, MissionRunner

TIMEOUT = 10.0
"""Seconds within which a scheduler has to answer. Not measured."""

AHEAD = 4
"""Shares that each thread of a worker has in its queue, so that it never waits for the next one. Not measured."""


Client = Any
"""`distributed.Client`, whose package has no types."""


@contextlib.contextmanager
def cluster(address: str) -> Iterator[Client]:
    """The client of the scheduler at the address. Raises PursueError if there is none, or without `distributed`."""
    try:
        from distributed import Client as DaskClient
    except ImportError as problem:
        message = f"--scheduler needs the Python package distributed, which is not installed here ({problem})"
        hint = "install it: pip install 'pursue-gen[cluster]', here and on each worker's machine"
        raise Unavailable([error("SIM004", message, hint=hint)]) from None
    try:
        client = DaskClient(address, timeout=TIMEOUT, set_as_default=False)
    except (OSError, ValueError, TimeoutError) as problem:
        hint = "start one with 'dask scheduler', and give its address, such as tcp://10.0.0.5:8786"
        raise Unfinished([error("SIM005", f"no Dask scheduler at {address}: {problem}", hint=hint)]) from None
    try:
        yield client
    finally:
        client.close()


def outcomes_on(client: ContextManager[Client], case: Case, seeds: Sequence[int]) -> Iterator[Outcome]:
    """The outcomes of these missions, in their order, whatever the number of workers.

    Raises PursueError if there is no worker, or one with another version of this program.
    """
    with client as connected:
        _check(connected)
        room = AHEAD * sum(connected.nthreads().values())
        shares = (list(seeds[k : k + SHARE]) for k in range(0, len(seeds), SHARE))
        sent = connected.scatter(case, broadcast=True)
        waiting: Deque[Any] = deque()
        for share in shares:
            waiting.append(connected.submit(play, sent, share, pure=False))
            if len(waiting) >= room:
                yield from waiting.popleft().result()
        while waiting:
            yield from waiting.popleft().result()


_local = threading.local()


def play(case: Case, seeds: Sequence[int]) -> List[Outcome]:
    """The outcomes of these missions, on a worker. Each of its threads makes the stage of a case once."""
    if getattr(_local, "case", None) is not case:
        _local.runner, _local.case = MissionRunner(case), case
    runner: MissionRunner = _local.runner
    return [runner.run(seed) for seed in seeds]


def version() -> str:
    """The version of this program, on a worker."""
    return pursue_runtime.__version__


def _check(client: Client) -> None:
    if not client.nthreads():
        hint = "start one on each machine with 'dask worker ADDRESS --nthreads 1 --nworkers auto'"
        raise Unfinished([error("SIM005", "the Dask scheduler has no workers", hint=hint)])
    try:
        found = client.run(version)
    except ImportError as problem:
        hint = "install pursue-gen in the Python of each worker"
        raise Unfinished([error("SIM005", f"a Dask worker cannot simulate: {problem}", hint=hint)]) from None
    other = sorted({f"{each} on {worker}" for worker, each in found.items() if each != version()})
    if other:
        message = f"this is pursue-gen {version()}, but a Dask worker has {other[0]}"
        raise Unfinished([error("SIM005", message, hint="install the same version on each worker's machine")])
