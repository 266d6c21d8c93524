"""What nodes without ROS leave open."""

from __future__ import annotations

import os
from typing import Any, Callable, Dict, Iterator

import pytest

from pursue_runtime.observer.records import MarkFile, RecordFile
from pursue_runtime.reader.store import Store
from pursue_runtime.simulator.clock import ClockFile

OPEN = {RecordFile: "_descriptor", MarkFile: "_descriptor", Store: "_lock", ClockFile: "_file"}
"""What keeps a file open as long as its process lives, and the attribute that has its descriptor."""


@pytest.fixture(autouse=True)
def _close_the_files_of_the_killed(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """Close after a test what it has left open: it "kills" a node by making another one, and the files of a process
    that is killed are closed by the system."""
    made: Dict[int, Any] = {}

    def noting(kind: type) -> Callable[..., None]:
        begin = kind.__init__  # type: ignore[misc]

        def init(self: Any, *args: Any, **options: Any) -> None:
            begin(self, *args, **options)
            made[id(self)] = self

        return init

    def close(self: Store) -> None:
        made.pop(id(self), None)
        closes(self)

    closes = Store.close
    for kind in OPEN:
        monkeypatch.setattr(kind, "__init__", noting(kind))
    monkeypatch.setattr(Store, "close", close)
    yield
    for one in made.values():
        descriptor = getattr(one, OPEN[type(one)], None)
        if descriptor is not None:
            os.close(descriptor)
