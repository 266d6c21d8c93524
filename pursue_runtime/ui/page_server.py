"""Connects the node and its pages: sends views to all pages, and passes their requests to the node."""

from __future__ import annotations

import os
import threading
from typing import Any, Dict, List, Mapping, Optional, Protocol, Sequence, Tuple

from pursue_runtime.missions import Source
from pursue_runtime.model import Model
from pursue_runtime.parameters import ParameterError
from pursue_runtime.ui.floor import read_floor
from pursue_runtime.ui.mission_view import reporters
from pursue_runtime.ui.options import Options
from pursue_runtime.ui.page import Facts, Page, read_floor_plan
from pursue_runtime.ui.promise import read_promise
from pursue_runtime.ui.requests import PageRequest, read_request
from pursue_runtime.ui.statuses import read_statuses
from pursue_runtime.ui.strategies import Strategies
from pursue_runtime.ui.waits import AtDoors

STATIC = os.path.join(os.path.dirname(os.path.realpath(__file__)), "static")
"""The folder of the page's files."""


FLOOR = "/floor.png"
"""Where the page finds the picture of the floor plan."""


class PageNode(Protocol):
    """The node that has a page."""

    lock: threading.RLock

    def facts(self) -> Facts:
        """Return the present facts."""

    def on_request(self, request: PageRequest) -> str:
        """Carry out a request of a page; return a remark for the page, "" for none."""


class PageServer:
    """Sends everything new to every page."""

    def __init__(self, page: Page, node: PageNode) -> None:
        self.page, self._node = page, node
        self._shown = 0
        self._real: Dict[str, Dict[str, Any]] = {"positions": {}, "paths": {}}
        self._missions: List[Dict[str, Any]] = []
        self.web: Any = None

    def on_positions(
        self, positions: Mapping[str, Sequence[float]], paths: Mapping[str, Sequence[Sequence[float]]]
    ) -> None:
        """Show where robots really are (x and y in metres, yaw in radians), and the paths that they have planned."""
        self._real = {
            "positions": {name: list(position) for name, position in positions.items()},
            "paths": {name: [list(point) for point in path] for name, path in paths.items()},
        }
        self.web.send({"type": "positions", **self._real})

    def note(self, at: float, text: str, kind: str) -> None:
        """Add an entry to the log of every page."""
        self.page.note(at, text, kind)
        self.show()

    def show_missions(self, missions: List[Dict[str, Any]]) -> None:
        """Show the missions that were played here, where they are others than before."""
        if missions != self._missions:
            self._missions = missions
            self.web.send({"type": "missions", "missions": missions})

    def show(self) -> None:
        """Send the present view to every page."""
        fresh = [entry for entry in self.page.log if entry["n"] > self._shown]
        self._shown = fresh[-1]["n"] if fresh else self._shown
        self.web.send({"type": "view", "view": self.page.view(self._node.facts()), "log": fresh})

    # Called by the server, in its own thread --------------------------------------------------------------------------

    def first_message(self) -> Dict[str, Any]:
        """Return the first message for a page."""
        with self._node.lock:
            view = self.page.view(self._node.facts())
            shown = {"scene": self.page.scene(), "view": view, "log": self.page.log, "missions": self._missions}
            return {"type": "hello", **shown, **self._real}

    def on_message(self, message: Any) -> str:
        """Take a message of a page. Raises ValueError where it is not a request."""
        request = read_request(message)
        with self._node.lock:
            return self._node.on_request(request)

    def present(self) -> Optional[float]:
        """Return the time units since the start; None while the mission does not run, as far as the node knows."""
        with self._node.lock:
            facts = self._node.facts()
        return facts.now if facts.live and facts.answers else None


ADDRESS = "PURSUE_PAGE"
"""In the environment of a node that has begun anew: port and token of its page, so that open pages find it again."""


def format_address(port: int, token: str) -> str:
    """Return what read_address reads."""
    return f"{port} {token}"


def read_address(text: str) -> Tuple[int, str]:
    """Return port and token of the page before this one; 0 and "" where there was none."""
    port, _, token = text.partition(" ")
    return (int(port), token) if port.isdecimal() and int(port) < 2**16 else (0, "")


def open_page(
    model: Model,
    options: Options,
    settings: Mapping[str, Any],
    source: Source,
    node: PageNode,
    strategies: Strategies,
    at_doors: AtDoors,
) -> Optional[PageServer]:
    """Serves a page, where one is wanted, at the address of the one before if the node has begun anew. Raises
    ParameterError and other DataErrors.
    """
    if not options.web:
        return None
    kept = read_address(os.environ.get(ADDRESS, ""))
    port, token = options.port or kept[0], options.token or kept[1]
    try:
        from pursue_runtime.ui.web import Web, WebError
    except ImportError as problem:
        what = f"--web needs tornado, and {problem}: install python3-tornado, or leave --web out"
        raise ParameterError(what) from None
    poses = source.read("poses.yaml")
    people = reporters(model, options.ends, settings)
    words = read_statuses(settings), read_promise(settings)
    floor = read_floor(source.folder) if source.digests is None else None  # it is the workspace's, not a mission's
    page = Page(model, read_floor_plan(poses, settings), people, *words, strategies, floor, at_doors)
    board = PageServer(page, node)
    try:
        board.web = Web(
            STATIC, options.host, port, token, board.first_message, board.on_message, board.present,
            {} if floor is None else {FLOOR: (floor.picture, "image/png")},
        )
    except WebError as problem:
        raise ParameterError(str(problem)) from None
    board.web.generated = bool(board.web.token) and not options.token
    board.web.start()
    return board
