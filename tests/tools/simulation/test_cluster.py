"""Missions on the workers of a Dask cluster are those of one machine."""

from __future__ import annotations

import builtins
import contextlib
import pickle
import subprocess
import sys
from typing import Any, Callable, Dict, Iterator, List

import pytest
from stages import SCENARIOS, solved

from pursue_gen.diagnostics import PursueError
from pursue_gen.tools.simulation.cluster import AHEAD, cluster, outcomes_on, version
from pursue_gen.tools.simulation.outcome import Settings
from pursue_gen.tools.simulation.runs import SHARE, Case, outcomes
from pursue_gen.workspace import Options


class Done:
    """A share that was played."""

    def __init__(self, found: Any) -> None:
        self._found = found

    def result(self) -> Any:
        return self._found


class FakeClient:
    """Stands for distributed.Client: two workers in this process, which get pickled data as over a network."""

    def __init__(self, workers: int = 2, versions: str = "") -> None:
        self.workers, self.versions = workers, versions or version()
        self.shares: List[int] = []
        self.open = 0

    def nthreads(self) -> Dict[str, int]:
        return {f"tcp://worker{number}": 1 for number in range(self.workers)}

    def scatter(self, data: Any, broadcast: bool = False) -> Any:
        assert broadcast
        return pickle.loads(pickle.dumps(data))

    def submit(self, function: Callable[..., Any], *args: Any, pure: bool) -> Done:
        assert not pure, "the same seeds of two campaigns would be taken for one"
        self.shares.append(len(args[1]))
        return Done(pickle.loads(pickle.dumps(function(*args))))

    def run(self, function: Callable[..., Any]) -> Dict[str, str]:
        return dict.fromkeys(self.nthreads(), self.versions)


@contextlib.contextmanager
def connected(client: FakeClient) -> Iterator[FakeClient]:
    yield client


def case() -> Case:
    scenario, won = solved("thesis/scenario_1")
    return Case(scenario, won, Options(reaction=won.reaction), Settings("random", ("loss", "late")))


def test_the_workers_play_the_missions_of_one_machine_in_their_order() -> None:
    client, seeds = FakeClient(), range(5, 5 + 2 * SHARE + 7)
    found = list(outcomes_on(connected(client), case(), seeds))
    assert found == list(outcomes(case(), seeds, 1))
    assert [outcome.seed for outcome in found] == list(seeds)
    assert client.shares == [SHARE, SHARE, 7]


def test_no_more_shares_are_sent_than_the_workers_have_room_for() -> None:
    client = FakeClient()
    first = next(outcomes_on(connected(client), case(), range(1, 10**6)))
    assert first.seed == 1
    assert len(client.shares) == 2 * AHEAD


@pytest.mark.parametrize(
    ("client", "message"),
    [
        (FakeClient(workers=0), "the Dask scheduler has no workers"),
        (FakeClient(versions="0.0.1"), "a Dask worker has 0.0.1 on tcp://worker0"),
    ],
)
def test_workers_that_cannot_be_used_are_refused(client: FakeClient, message: str) -> None:
    with pytest.raises(PursueError, match=message) as refused:
        next(outcomes_on(connected(client), case(), range(3)))
    assert refused.value.exit_status == 5
    assert client.shares == []


def test_without_distributed_the_message_tells_what_to_install(monkeypatch: pytest.MonkeyPatch) -> None:
    found = builtins.__import__

    def missing(name: str, *args: Any, **more: Any) -> Any:
        if name == "distributed":
            raise ImportError("No module named 'distributed'")
        return found(name, *args, **more)

    monkeypatch.setattr(builtins, "__import__", missing)
    with pytest.raises(PursueError) as refused, cluster("tcp://127.0.0.1:1"):
        pass
    assert refused.value.exit_status == 6
    assert "pip install 'pursue-gen[cluster]'" in str(refused.value.diagnostics[0].hint)


def test_the_simulation_does_not_import_distributed_unless_it_is_asked_to() -> None:
    code = "import sys, pursue_gen.tools.simulation.cluster; sys.exit('distributed' in sys.modules)"
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0


def test_an_address_without_a_scheduler_is_refused() -> None:
    pytest.importorskip("distributed")
    nowhere = "tcp://127.0.0.1:1"
    with pytest.raises(PursueError, match=f"no Dask scheduler at {nowhere}") as refused, cluster(nowhere):
        pass
    assert refused.value.exit_status == 5


def test_two_workers_of_a_real_cluster_give_the_same_table() -> None:
    distributed = pytest.importorskip("distributed")
    words = [str(SCENARIOS / "thesis" / "scenario_1.pur"), "--runs", "90", "--faults", "loss,late", "--json"]
    command = [sys.executable, "-m", "pursue_gen", "sim", *words]
    with distributed.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as local:
        there = subprocess.run([*command, "--scheduler", local.scheduler_address], capture_output=True, check=False)
    here = subprocess.run(command, capture_output=True, check=False)
    assert there.returncode == here.returncode == 0, there.stderr
    assert there.stdout == here.stdout
