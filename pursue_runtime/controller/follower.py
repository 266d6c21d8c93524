"""Which mission's part the controller plays: that of the states that it hears, and of no other."""

from __future__ import annotations

import time
from typing import Any, Callable, Dict, List, Mapping, NamedTuple, Optional, Tuple

from pursue_runtime.controller.scheduler import CommandScheduler
from pursue_runtime.data import DataError
from pursue_runtime.missions import Missions, Source
from pursue_runtime.state import ENDED, WAITING, SystemState
from pursue_runtime.state_filter import OLD, OTHER, StateFilter
from pursue_runtime.strategy import Strategy
from pursue_runtime.words import Word

OBJECTIVES = ("reachObj", "obj")

Log = Callable[[str, str], None]
"""Takes a level (info, warn, err) and a sentence."""


class Part(NamedTuple):
    """What this controller does in a mission: its strategy (None: it has no part in it), and where the points are."""

    mission: str
    strategy: Optional[Strategy]
    poses: Dict[str, List[float]]

    @property
    def robots(self) -> List[str]:
        """The robots that are commanded."""
        agents = self.strategy.agents if self.strategy is not None else []
        return [agent for agent in agents if agent not in OBJECTIVES]


def read_part(source: Source) -> Part:
    """All of a part from one place. Raises DataError."""
    if source.empty:
        return Part(source.mission, None, {})
    poses = source.read("poses.yaml").get("poses")
    try:
        where = {str(poi): [float(number) for number in pose] for poi, pose in dict(poses or {}).items()}
    except (TypeError, ValueError) as problem:
        raise DataError(f"poses.yaml in {source.folder} lacks or misspells something: {problem!r}") from problem
    if not all(len(pose) == 7 for pose in where.values()):
        raise DataError(f"poses.yaml in {source.folder}: expected x, y, z, qx, qy, qz, qw for each point")
    return Part(source.mission, Strategy(source.read("strategy.yaml")), where)


class Follower:
    """The part that is played. Without one, for the states name a mission that is not here, nothing is commanded.

    `name`: the node's; `package`: under which new plans have its strategy; `again`: it stays where it came too late;
    `clock`: of real time.
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
        self.part: Optional[Part] = None
        self.scheduler: Optional[CommandScheduler] = None
        self.trouble = self._logged = ""
        self._missions, self._name, self._package, self._log = missions, name, package, log
        self._filter = StateFilter("", missions.own.mission, again, clock)
        self._source: Optional[Source] = None  # where the part was read
        self.plan: Optional[Mapping[str, Any]] = None  # the newest, of whatever mission, until it is learned

    def load_current(self) -> None:
        """Reads the part of the mission that is current, before any state is heard. Raises DataError."""
        self._read(self._missions.current())

    def on_state(self, state: SystemState) -> str:
        """A state: the part of its mission is read, if it is another one. What the state is to us (see Hearing)."""
        verdict = self._filter.classify(state)
        if self._filter.clock_set_back and self.part is not None:
            self._log("warn", "the observer's clock was set back: what was known of the mission is forgotten")
            self._use(self.part._replace())  # a new one: what its robots were told is over
        if verdict == OTHER or (verdict != OLD and (self.part is None or self._moved(state))):
            self._change(state.mission)
            verdict = self._filter.classify(state) if self.part else OTHER
        if verdict == OLD and self.scheduler:
            self.scheduler.counts["old"] += 1
        elif verdict != OLD and state.status == WAITING:
            self.plan = None  # new plans are of missions that run
        return verdict

    def reject(self, why: str) -> None:
        """The part that was read cannot be played."""
        if why != self._logged:
            self._log("err", why)
        self._use(None)
        self.trouble = self._logged = why

    def take_plan(self, now: float) -> Optional[Word]:
        """Learns the newest `plan`, if it is for the mission that is played: the word that says that we have it.

        Raises DataError if it cannot be read. One of another mission is kept until the states of that come.
        """
        plan, player = self.plan, self.scheduler
        if plan is None or player is None or self.part is None:
            return None
        if (plan.get("mission") or self._missions.own.mission) != self.part.mission:
            return None
        self.plan = None
        try:
            strategy = Strategy(plan["strategies"][self._package])
        except (KeyError, TypeError) as problem:
            raise DataError(f"it lacks or misspells something: {problem!r}") from problem
        return player.add_plan(int(plan["plan"]), strategy, now)

    def report(self) -> Tuple[Optional[SystemState], Optional[CommandScheduler], Optional[Part], str]:
        """The newest state of whatever mission, what plays, the part, and what is wrong ("": nothing)."""
        state = self._filter.newest
        over = state is not None and state.status in ENDED and not self._filter.joined
        return state, self.scheduler, self.part, self.trouble or ("waits for the next mission" if over else "")

    def _change(self, mission: str) -> None:
        """Plays this mission from now on, if it is here."""
        try:
            source = self._missions.find(mission)
            if source is None:
                raise DataError(f"does not have mission {mission}: send it to this machine")
            self._read(source)
        except DataError as problem:
            self.reject(str(problem))

    def _moved(self, state: SystemState) -> bool:
        """True where the same mission is to be read from another place, while it has not begun."""
        source = self._source
        return state.status == WAITING and source is not None and self._missions.moved(state.mission, source)

    def _read(self, source: Source) -> None:
        self._use(read_part(source))
        self._source = source

    def _use(self, part: Optional[Part]) -> None:
        self.part, self.trouble = part, ""
        self.scheduler = CommandScheduler(part.strategy, self._name) if part and part.strategy is not None else None
        if part:
            self._filter.mission = part.mission
