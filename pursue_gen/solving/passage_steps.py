"""From one play, step by step, to a strategy with orders of passage that does the same in every play.

What a robot does next follows from where it is, whose turn it is there and at the place to which it goes, and from what
else its step needs: rules, states and objectives that the step, or another one of its visit, tests or changes. Nothing
here has to be right: what it makes is proven (`proof.passages`).
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from typing import AbstractSet, Dict, Iterable, Iterator, List, Mapping, Optional, Sequence, Set, Tuple, Union

from pursue_gen.language.symbols import UNDER_WAY, Role, role_of
from pursue_gen.synthesis.strategy import Block, Command, Constraint, DiscreteState, Move, Strategy
from pursue_gen.tga.network import Edge, Network
from pursue_gen.tga.passages import Passage, with_passages

Value = Union[str, int]


@dataclass(frozen=True)
class Step:
    """A joint move of a play: the sender's edge, those of all that receive it, and what was so before."""

    sender: str
    edge: Edge
    receivers: Tuple[Tuple[str, Edge], ...]
    before: Mapping[str, Value]

    def concerned(self, others: AbstractSet[str] = frozenset()) -> List[str]:
        """The automata and variables that it tests, and the automata that it changes; without what receivers test of
        `others`."""
        tested = (name for _, edge in self.receivers for name in edge.tested if name not in others)
        return list(dict.fromkeys((self.sender, *(name for name, _ in self.receivers), *self.edge.tested, *tested)))

    @property
    def moves(self) -> Tuple[Tuple[str, Edge], ...]:
        """All automata that take part, with their edges."""
        return ((self.sender, self.edge), *self.receivers)


class Play:
    """A play in a network, without times: ends of movements and actions come before anything else is commanded."""

    def __init__(self, network: Network) -> None:
        self.now: Dict[str, Value] = {automaton.name: automaton.initial for automaton in network.automata}
        self.now.update(network.variables)
        self.steps: List[Step] = []
        self._ends: Dict[Tuple[str, str], List[Edge]] = {}
        self._heard = network.receivers
        for name, edge in network.edges:
            if edge.received is None and edge.is_end:
                self._ends.setdefault((name, edge.source), []).append(edge)

    def take(self, sender: str, edge: Edge) -> bool:
        """The joint move of an edge, and the ends that follow from it; False where it cannot be made, or does not end.
        """
        if self.now[sender] != edge.source or not edge.guard.holds(self.now):
            return False
        receivers: Dict[str, Edge] = {}
        for name, other in self._heard.get(edge.channel, ()):
            if name != sender and other.source == self.now[name] and other.guard.holds(self.now):
                receivers[name] = other
        step = Step(sender, edge, tuple(receivers.items()), dict(self.now))
        self.now[sender] = edge.target
        self.now.update((name, other.target) for name, other in receivers.items())
        for _, one in step.moves:
            self.now.update(one.assign)
        self.steps.append(step)
        for name in (sender, *receivers):
            if role_of(str(self.now[name])) in UNDER_WAY:
                ends = self._ends.get((name, str(self.now[name])), [])
                if not any(self.take(name, end) for end in ends) and role_of(str(self.now[name])) in UNDER_WAY:
                    return False
        return True


def passages_of(
    network: Network, steps: Iterable[Step], single: AbstractSet[str], again: bool = False
) -> Tuple[Passage, ...]:
    """The orders in which robots are at places in a play: at those that hold one, and where the visits of a robot have
    to be told apart. `again`: the play begins again where it has ended, with all robots where they began."""
    steps = list(steps)
    visits: Dict[Tuple[str, str], List[str]] = {}

    def visit(place: str, robot: str) -> None:
        visits.setdefault((place, "" if place in single else robot), []).append(robot)

    moving = {step.sender for step in steps if step.edge.enters is Role.WAY}
    for automaton in network.automata:
        if automaton.name in moving:
            visit(automaton.initial, automaton.name)
    for step in steps:
        if step.edge.leaves is Role.WAY:
            visit(step.edge.target, step.sender)
    entered = {step.edge.target for step in steps if step.edge.leaves is Role.WAY}
    begun = {(a.initial, "" if a.initial in single else a.name) for a in network.automata if a.name in moving}
    if again:  # who comes home has been there at the start
        visits = {who: robots[:-1] if who in begun else robots for who, robots in visits.items()}
    told_apart = (
        len(robots) > 1 or (place in entered and not robot) or (again and (place, robot) in begun)
        for (place, robot), robots in visits.items()
    )
    passed = (item for item, apart in zip(visits.items(), told_apart) if apart)
    return tuple(Passage(place, tuple(robots), again) for (place, _), robots in passed)


def strategy_of(
    network: Network, play: Sequence[Tuple[str, Edge]], single: AbstractSet[str], again: bool = False
) -> Optional[Strategy]:
    """The strategy that does what a play does, given by its commands, over and over if `again`; None where that cannot
    be told apart."""
    first = Play(network)
    if not all(first.take(*command) for command in play):
        return None
    passages = passages_of(network, first.steps, single, again)
    network = with_passages(network, passages)
    if not {passage.name for passage in passages} <= {automaton.name for automaton in network.automata}:
        return None
    second = Play(network)
    if not all(second.take(*command) for command in play):
        return None
    # Who goes round need not know where others are: that they are nowhere near follows from whose turn it is.
    others = frozenset(_positions(second.steps) if again else ())
    return Strategy(_Blocks(network, second.steps, passages, others).all(), passages=passages)


def _positions(steps: Iterable[Step]) -> Iterator[str]:
    """The variables that say where robots are."""
    for step in steps:
        if step.edge.leaves is Role.WAY or step.edge.enters is Role.WAY:
            yield from (name for name, _ in step.edge.assign)


class _Blocks:
    def __init__(
        self, network: Network, steps: Sequence[Step], passages: Sequence[Passage], others: AbstractSet[str]
    ) -> None:
        self._steps, self._others = steps, others
        self._automata = [automaton.name for automaton in network.automata]
        self._variables = [name for name, _ in network.variables]
        self._passages = {passage.name: passage for passage in passages}
        self._at: Dict[str, List[Passage]] = {}
        for passage in passages:
            self._at.setdefault(passage.place, []).append(passage)

    def all(self) -> Tuple[Block, ...]:
        """A block for each command, and one to wait in for each location of those who are commanded."""
        commanded = [number for number, step in enumerate(self._steps) if step.edge.controllable]
        senders = list(dict.fromkeys(self._steps[number].sender for number in commanded))
        blocks: Dict[DiscreteState, Block] = {}
        for name in senders:
            moves = (edge for step in self._steps for who, edge in step.moves if who == name)
            for place in (place for edge in moves for place in (edge.source, edge.target)):
                state = self._state([name], {name: place})
                blocks.setdefault(state, Block(state, ((),), ()))
        for number, named in self._named(commanded).items():
            state = self._state(named, self._steps[number].before)
            blocks[state] = _block(state, self._steps[number])
        return tuple(blocks.values())

    def _named(self, commanded: Sequence[int]) -> Dict[int, Set[str]]:
        """What the block of each command names: what it tests and changes, for which visit its sender is there, and
        what tells it from other commands there."""
        named: Dict[int, Set[str]] = {}
        alike: Dict[Tuple[str, str], List[int]] = {}
        for number in commanded:
            step = self._steps[number]
            named[number] = {*step.concerned(self._others), *self._held(step)}
            for end in self._steps[number + 1 :]:  # what it is done for may come with its end
                if end.edge.leaves not in UNDER_WAY:
                    break
                named[number].update(end.concerned(self._others) if end.sender == step.sender else ())
            others = alike.setdefault((step.sender, step.edge.source), [])
            for other in others:
                earlier = self._steps[other]
                shared = named[number] & named[other]
                if step.edge != earlier.edge and all(step.before[name] == earlier.before[name] for name in shared):
                    apart = self._changed_between(other, number)
                    named[number] |= apart
                    named[other] |= apart
            others.append(number)
        return named

    def _changed_between(self, one: int, other: int) -> Set[str]:
        """An automaton or a variable that the sender changes between the two steps; nothing where there is none."""
        sender, before, after = self._steps[one].sender, self._steps[one].before, self._steps[other].before
        own = (step for step in self._steps[one:other] if step.sender == sender)
        concerned = (name for step in own for name in step.concerned() if name not in self._passages)
        return set(next(([name] for name in concerned if name != sender and before[name] != after[name]), ()))

    def _held(self, step: Step) -> List[str]:
        """The orders of passage that tell which visit it is that the sender makes where it is."""
        return [each.name for each in self._at.get(step.edge.source, ()) if step.sender in each.robots]

    def _state(self, named: Iterable[str], values: Mapping[str, Value]) -> DiscreteState:
        names = set(named)
        return DiscreteState(
            tuple((name, str(values[name])) for name in self._automata if name in names),
            tuple((name, int(values[name])) for name in self._variables if name in names),
        )


def _block(state: DiscreteState, step: Step) -> Block:
    """Waits until the guard's clocks are past their bounds."""
    bounds = [(bound.clock, Fraction(bound.bound), bound.op == ">") for bound in step.edge.guard.clocks]
    zone = tuple(Constraint(None, clock, -bound, strict) for clock, bound, strict in bounds)
    wait = tuple((Constraint(clock, None, bound, not strict),) for clock, bound, strict in bounds)
    moves = tuple(Move(name, edge) for name, edge in step.moves)
    return Block(state, wait, (Command((zone,), moves),))
