"""Which mission's part a controller plays: always that of the states it receives."""

from __future__ import annotations

import time
from typing import Any, Callable, List, Mapping, NamedTuple, Optional, Tuple

from pursue_runtime.controller.scheduler import CommandScheduler
from pursue_runtime.data import DataError, reading
from pursue_runtime.event_words import Word
from pursue_runtime.missions import Missions, Source
from pursue_runtime.poses import POSES, Poses, read_poses
from pursue_runtime.sentences import Log
from pursue_runtime.state import ENDED, LIVE, WAITING, SystemState
from pursue_runtime.state_checks import OLD, OTHER, REFUSED, StateFilter, strategy_problem
from pursue_runtime.strategy import Strategy


class MissionPart(NamedTuple):
    """A controller's part of a mission: its strategy (None: it has no part in it), and its robots' poses."""

    mission: str
    strategy: Optional[Strategy]
    poses: Poses

    @property
    def robots(self) -> List[str]:
        """Return the robots that the strategy commands."""
        if self.strategy is None:
            return []
        return [agent for agent in self.strategy.agents if agent not in self.strategy.objectives]


def read_part(source: Source) -> MissionPart:
    """Read a part from one source. Raises DataError."""
    if source.empty:
        return MissionPart(source.mission, None, Poses({}, {}, {}, {}, {}))
    try:
        poses = read_poses(source.read(POSES))
    except DataError as problem:
        raise DataError(f"in {source.folder}: {problem}") from problem
    return MissionPart(source.mission, Strategy(source.read("strategy.yaml")), poses)


class Follower:
    """Follows the mission of the received states. Without data for that mission, nothing is commanded. `filter` says
    which of them count.

    `name`: the node's; `package`: under which new plans have its strategy; `again`: it waits for the
    next mission where it came too late; `clock`: of real time.
    """

    def __init__(
        self,
        missions: Missions,
        name: str,
        package: str,
        log: Log,
        again: bool = False,
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        self.part: Optional[MissionPart] = None
        self.scheduler: Optional[CommandScheduler] = None
        self.trouble = self._logged = ""
        self._missions, self._name, self._package, self._log = missions, name, package, log
        self.filter = StateFilter("", missions.own.mission, again, clock)
        self.filter.check = self._problem
        self._source: Optional[Source] = None  # where the part was read
        self.plan: Optional[Mapping[str, Any]] = None  # the newest, of whatever mission, until it is learned

    def load_current(self) -> None:
        """Read the part of the current mission, before any state is received. Raises DataError."""
        self._read(self._missions.current())

    def on_state(self, state: SystemState) -> str:
        """Take a state, read the part of its mission if that is another one, and return its class (see StateFilter)."""
        refused, verdict = self.filter.refused, self.filter.classify(state)
        if verdict == REFUSED:
            if self.filter.refused != refused:
                self._log("err", f"refused {self.filter.refused}")
            return verdict
        if self.filter.clock_set_back and self.part is not None:
            self._log("warn", "the observer's clock was set back: earlier states do not count any more")
            self._use(self.part._replace())  # a new scheduler: earlier commands are over
        if verdict == OTHER or (verdict != OLD and (self.part is None or self._moved(state))):
            self._change(state.mission)
            verdict = self.filter.classify(state) if self.part else OTHER
        if verdict == OLD and self.scheduler:
            self.scheduler.counts["old"] += 1
        elif verdict != OLD and state.status == WAITING:
            self.plan = None  # new plans are of missions that run
        return verdict

    def reject(self, why: str) -> None:
        """Play nothing: the part that was read cannot be used, for the reason `why`."""
        if why != self._logged:
            self._log("err", why)
        self._use(None)
        self.trouble = self._logged = why

    def take_plan(self, now: float) -> Optional[Word]:
        """Use the newest `plan` if it is for the mission that is played; return the word that acknowledges it.

        Raises DataError if it cannot be read. One of another mission is kept until the states of that come.
        """
        plan, player = self.plan, self.scheduler
        if plan is None or player is None or self.part is None:
            return None
        if (plan.get("mission") or self._missions.own.mission) != self.part.mission:
            return None
        self.plan = None
        with reading("it"):
            strategy = Strategy(plan["strategies"][self._package])
        return player.add_plan(int(plan["plan"]), strategy, now)

    def report(self) -> Tuple[Optional[SystemState], Optional[CommandScheduler], Optional[MissionPart], str]:
        """Return the newest state of any mission, the scheduler, the part, and what is wrong ("": nothing)."""
        state = self.filter.newest
        over = state is not None and state.status in ENDED and not self.filter.joined
        return state, self.scheduler, self.part, self.trouble or ("waits for the next mission" if over else "")

    def _change(self, mission: str) -> None:
        """Switch to this mission, if it is on this machine."""
        try:
            source = self._missions.find(mission)
            if source is None:
                raise DataError(f"does not have mission {mission}: send it to this machine")
            self._read(source)
        except DataError as problem:
            self.reject(str(problem))

    def _moved(self, state: SystemState) -> bool:
        """Return True if the same mission has to be read from another source, while it has not begun."""
        source = self._source
        return state.status == WAITING and source is not None and self._missions.moved(state.mission, source)

    def _read(self, source: Source) -> None:
        self._use(read_part(source))
        self._source = source

    def _problem(self, state: SystemState) -> str:
        """Return why the strategy cannot decide in a state of its mission, "" if it can."""
        strategy = self.part.strategy if self.part else None
        return strategy_problem(strategy, state) if strategy is not None and state.status in LIVE else ""

    def _use(self, part: Optional[MissionPart]) -> None:
        self.part, self.trouble = part, ""
        self.scheduler = CommandScheduler(part.strategy, self._name) if part and part.strategy is not None else None
        if part:
            self.filter.mission = part.mission
