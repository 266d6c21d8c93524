"""Games of many agents: with few of the robots, and in stages.

Where a game is not decided with little work, it may be won by some of the robots while the others stand still, or in
stages, a subgoal after the other, each in a game of those who matter to it (see `proof.stages`). Whatever wins so wins
the game, in which it is proven; where nothing does, nothing is known.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Collection, Dict, FrozenSet, Iterator, List, Mapping, Optional, Sequence, Set, Tuple

from pursue_gen.outcomes import LimitHit, NotProven
from pursue_gen.proof.checker import LIMIT, verify
from pursue_gen.proof.relaxed_reachability import Extent, is_controllers, live
from pursue_gen.proof.stage_entry import Known, at_start
from pursue_gen.proof.stages import after_stage, is_sure, stage_objective
from pursue_gen.solving.found import Found, stats_of_all
from pursue_gen.solving.options import SolveOptions
from pursue_gen.solving.proving import prove
from pursue_gen.solving.subgoals import Subgoal, commanded_agents, protections, subgoals
from pursue_gen.synthesis.budget import Budget
from pursue_gen.synthesis.cone import cone_of_influence
from pursue_gen.synthesis.solve import Stats
from pursue_gen.synthesis.strategy import Block, Place, Strategy, with_edges
from pursue_gen.tga.begin import BEGIN, beginning_in
from pursue_gen.tga.ending import ending_at, owner_of
from pursue_gen.tga.ends import is_agent
from pursue_gen.tga.network import Automaton, Edge, Kind, Network, Objective
from pursue_gen.tga.part import part_of

_FIRST = 60_000_000
"""The work spent on a game in one piece first, a second or so: divided by the size of a zone. Not measured."""

WORK = 60_000_000
"""The work that is spent on games with some of the robots, and on those of stages. Measured on six visitors who must be
met, and on a delivery by twenty robots."""

_GAME = 8_000_000
"""The work of one game of these. Measured on the same scenarios."""

_MOST = 4
"""So many robots at most make a team. Measured on the same scenarios."""

def little_work(network: Network) -> int:
    """The work that is spent on a game in one piece before anything else is tried."""
    return max(1, _FIRST // (len(network.clocks) + 1) ** 2)


def won_by_some(network: Network, objective: Objective, reaction: Fraction, options: SolveOptions) -> Optional[Found]:
    """A proven strategy for some of the robots, or one in stages; None where none is found with little work."""
    budget = Budget(replace(options.limits, work=WORK), options.progress, options.engine, whole=True)
    search = _StagesSearch(network, objective, reaction, options, budget)
    try:
        strategy = search.found()
    except (NotProven, LimitHit):
        return None
    return None if strategy is None else Found(strategy, search.stats())


def has_parts(network: Network, objective: Objective) -> bool:
    """False where `won_by_some` has nothing to try: there is one robot, and one subgoal."""
    robots = commanded_agents(network)
    if len(robots) != 1 or len(objective.goal) != 1:
        return True
    goals = subgoals(network, objective.goal[0])
    return len(goals) > 1 or not goals[0].agents.issuperset(robots) or bool(protections(network, objective.bad))


def works_in_parallel(network: Network, goal: Place) -> bool:
    """True if some subgoals of the goal can be met at the same time."""
    return any(len(stage) > 1 for stage in _grouped(subgoals(network, goal)))


@dataclass(frozen=True)
class _Subtask:
    """A part of a stage: the game in which the agents `doers` come to `goal` (None: the whole game, of an objective
    without a goal or with several locations).

    `milestones`: what was reached in the stages before. `ending`: robots of no other part whose movement or action is
    still going on, and has to be ended here.
    """

    goal: Optional[Place]
    doers: FrozenSet[str]
    milestones: Tuple[Place, ...] = ()
    ending: FrozenSet[str] = frozenset()


class _StagesSearch:
    def __init__(
        self, network: Network, objective: Objective, reaction: Fraction, options: SolveOptions, budget: Budget
    ) -> None:
        self._network, self._objective, self._reaction = network, objective, reaction
        self._options, self._budget = options, budget
        self._taken = network.taken_over
        self._robots = commanded_agents(network)
        self._subgoals: List[Subgoal] = []
        self._variables = dict(network.variables)
        self._verdicts: List[Stats] = []

    def stats(self) -> Stats:
        """What all the games took."""
        return stats_of_all(self._verdicts)

    def found(self) -> Optional[Strategy]:
        """The first strategy that is found; raises PursueError at a limit."""
        if len(self._objective.goal) != 1:
            return self._proven((), self._part(_Subtask(None, frozenset(self._robots)), at_start(self._network)))
        (goal,) = self._objective.goal
        goals = subgoals(self._network, goal)
        first = protections(self._network, self._objective.bad)
        self._subgoals = [*first, *goals]
        if len(goals) == 1:
            blocks = self._part(_Subtask(goal, goals[0].agents), at_start(self._network))
            if blocks is not None:
                return self._proven((), blocks)
        for stages in self._orders(first, goals):
            strategy = self._in_stages(stages)
            if strategy is not None:
                return strategy
        return None

    def _orders(self, first: Sequence[Subgoal], goals: Sequence[Subgoal]) -> Iterator[List[List[Subgoal]]]:
        """The orders in which subgoals may be met. Subgoals that rule out what is to be avoided come first."""
        before = [[goal] for goal in first]
        one_by_one = [[goal] for goal in goals]
        together = _grouped(goals)
        if first:
            yield before + together
        if first and together != one_by_one:
            yield before + one_by_one
        if not self._objective.avoids and together != one_by_one:
            yield together
        if len(goals) > 1:
            yield one_by_one

    def _in_stages(self, stages: Sequence[Sequence[Subgoal]]) -> Optional[Strategy]:
        """A strategy that meets the subgoals stage by stage; those that are met when their stage begins are left
        out."""
        known = at_start(self._network)
        milestones: List[Place] = []
        blocks: List[Block] = []
        met: List[Tuple[Place, ...]] = []
        for stage in stages:
            own: Dict[Place, List[Block]] = {}
            ending = self._under_way(known).difference(*(goal.agents for goal in stage))
            for goal in (goal for goal in stage if not is_sure(known, goal.place)):
                found = self._part(_Subtask(goal.place, goal.agents, tuple(milestones), ending), known)
                if not found:
                    return None
                own[goal.place] = found
                ending = frozenset()
                blocks += found
            following = after_stage(self._network, known, own) if own else known
            if following is None:
                return None
            known = following
            milestones += own
            met += [tuple(own)] if own else []
        return self._proven(met, blocks)

    def _proven(self, stages: Sequence[Sequence[Place]], blocks: Optional[Sequence[Block]]) -> Optional[Strategy]:
        """The strategy of these blocks, if it wins the game."""
        if blocks is None:
            return None
        strategy = Strategy(tuple(blocks), stages=tuple(map(tuple, stages)))
        limits = self._options.limits
        report = verify(self._network, self._objective, strategy, self._reaction, LIMIT, limits=limits)
        return strategy if report.ok else None

    def _under_way(self, known: Known) -> FrozenSet[str]:
        """The robots that may be in the middle of a movement or action whose end the controller commands."""
        return frozenset(
            automaton.name
            for automaton in self._network.automata
            if automaton.name in self._robots
            for edge in automaton.edges
            if edge.source in known.extent.places[automaton.name] and edge.is_end and is_controllers(edge, self._taken)
        )

    def _part(self, part: _Subtask, known: Known) -> Optional[List[Block]]:
        """The blocks of a part of a stage; None where no team wins it with little work."""
        for team in self._teams(part, known):
            found = self._with_team(part, team, known)
            if found is not None:
                return found
        return None

    def _teams(self, part: _Subtask, known: Known) -> Iterator[FrozenSet[str]]:
        """The teams to try, the smallest first: some of the `doers`, and all robots that the safety part depends on."""
        guards: FrozenSet[str] = frozenset()
        alive, extent = self._alive(part, self._robots, known)
        wanted = self._objective if part.goal is None else stage_objective(self._objective, part.goal, extent)
        if part.goal is not None and wanted.reaches and wanted.avoids:
            safe = replace(self._objective, kind=Kind.SAFETY, goal=())
            matter = {automaton.name for automaton in cone_of_influence(alive, safe).automata}
            guards = frozenset(matter.intersection(self._robots))
        some = [name for name in self._robots if name in part.doers]
        sizes = [size for size in range(1, _MOST + 1) if size < len(some)]
        sizes += [len(some)] if len(some) <= _MOST + 1 else []
        # With all robots the game of the only stage is the one in one piece, for which there is more work.
        is_only = not part.milestones and (part.goal is None or (part.goal,) == self._objective.goal)
        teams = (guards.union(some[:size]) for size in sizes)
        yield from (team for team in teams if not (is_only and team.issuperset(self._robots)))

    def _with_team(self, part: _Subtask, team: Collection[str], known: Known) -> Optional[List[Block]]:
        """The blocks of the part for this team; None where it does not win with little work."""
        alive, extent = self._alive(part, team, known)
        wanted = self._objective
        owner = None if part.goal is None else owner_of(self._network, part.goal[0])
        if part.goal is not None:
            wanted = stage_objective(wanted, ending_at(alive, part.goal, owner).goal, extent)
        cone = cone_of_influence(alive, wanted)
        reached = {name for name, _ in part.milestones}
        names = {a.name for a in cone.automata} | reached.intersection(known.owned) | part.ending
        variables = {name for name, _ in cone.variables} | reached.difference(known.owned)
        game = part_of(alive, names, variables.union(v for name in names for v in known.owned[name]))
        starts = known.states(game)
        if starts is None:
            return None
        changed: Mapping[Tuple[str, Edge], Edge] = {}
        if part.goal is not None:
            game, _, changed = ending_at(game, part.goal, owner)
        game = beginning_in(game, starts) if part.milestones else game
        try:
            verdict = self._budget.verdict(game, wanted, self._reaction, min(1.0, _GAME / max(1, self._budget.work)))
            self._verdicts.append(verdict.stats)
            if verdict.strategy is None:
                return None
            how = self._reaction, verdict.ranks, self._options
            proven = prove(game, wanted, verdict.strategy, *how, otherwise=verdict.cautious)
        except (NotProven, LimitHit):
            if self._budget.used_up:
                raise
            return None
        own = {(name, there): here for (name, here), there in changed.items()}
        return list(with_edges(_without_begin(proven), own))

    def _alive(self, part: _Subtask, team: Collection[str], known: Known) -> Tuple[Network, Extent]:
        """What can happen in a stage in which only this team gets commands, except those that undo a milestone or meet
        another subgoal. Commands of objectives are allowed in the last stage only."""
        undoing: Set[str] = set()
        fixed: Dict[str, int] = {}
        for name, place in (subgoal.place for subgoal in self._subgoals):
            if name in self._variables:
                fixed[name] = int(place)
            elif (name, place) != part.goal:
                undoing |= _received(self._network.automaton(name))
        if part.goal is not None and part.goal[0] not in self._variables:
            undoing -= _received(self._network.automaton(part.goal[0]), part.goal[1])
        is_last = part.goal is None or (part.goal,) == self._objective.goal
        allowed = {
            (automaton.name, edge)
            for automaton in self._network.automata
            for edge in automaton.edges
            if automaton.name in team
            or (automaton.name in part.ending and edge.is_end)
            or (is_last and not is_agent(automaton))
            if is_controllers(edge, self._taken)
            and edge.channel not in undoing
            and all(fixed.get(name, value) == value for name, value in edge.assign)
        }
        return live(self._network, allowed, known.extent)


def _grouped(goals: Sequence[Subgoal]) -> List[List[Subgoal]]:
    """The subgoals in stages: those of a stage are for different agents, and need nothing of each other."""
    stages: List[List[Subgoal]] = []
    for goal in goals:
        here = stages[-1] if stages and goal is not goals[-1] else None
        if here is None or any(other.place in goal.before or other.agents & goal.agents for other in here):
            stages.append([goal])
        else:
            here.append(goal)
    return stages


def _received(automaton: Automaton, until: str = "") -> Set[str]:
    """The channels on which an automaton receives, but for those on which it leaves this location."""
    return {edge.received for edge in automaton.edges if edge.received is not None and edge.source != until}


def _without_begin(strategy: Strategy) -> List[Block]:
    """The blocks of a stage in the names of the network itself (see `tga.begin`)."""
    blocks = []
    for block in strategy.blocks:
        places = dict(block.state.locations)
        if places.pop(BEGIN, None) != BEGIN:
            blocks.append(block.with_locations(places.items()))
    return blocks
