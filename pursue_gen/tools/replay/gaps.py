"""States that a recording lacks, found by the words that were recorded, and when a state began that was recorded late.

A node may be killed when it has published a state to some nodes only: then the recording holds this state with a later
stamp, as the observer published it again. The text of a state that an acknowledgement follows at once is not published
at all. The clocks that its step resets say how long the state had been there.

It may also be killed when it has published states that the recorder did not receive. The words between the states that
were recorded say what happened meanwhile, and the clocks of the later state when.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Dict, Iterator, List, Mapping, NamedTuple, Optional, Sequence, Tuple

from pursue_gen.synthesis.lookup import Entry
from pursue_gen.tools.replay.finding import NOTE, Finding
from pursue_gen.tools.replay.moves import DiscreteState, Move, Moves, after, place_of
from pursue_gen.tools.replay.orders import Orders, since_for
from pursue_gen.tools.replay.record import MissionRecord, RecordedWord
from pursue_runtime.event_words import FINISH
from pursue_runtime.state import ENDED, LIVE, RUNNING, WAITING, WON, SystemState

EXACT = 0.001
"""Seconds by which a clock may be beside the stamps."""


class Beginnings(NamedTuple):
    """The states with those that were missing, and the seconds by which each number was recorded late."""

    states: Sequence[SystemState]
    late: Mapping[int, float]


def with_beginnings(states: Sequence[SystemState], moves: Moves) -> Beginnings:
    """Add to each state whose first copy is a later one the state as it was when it began."""
    found: List[SystemState] = []
    late: Dict[int, float] = {}
    for state in states:
        before = found[-1] if found else None
        begun = [] if before is None or state.seq != before.seq + 1 else _begun(before, state, moves)
        if begun:
            late[state.seq] = state.stamp - begun[0].stamp
        found += begun or [state]
    return Beginnings(found, late)


def _begun(before: SystemState, state: SystemState, moves: Moves) -> List[SystemState]:
    """The state when it began and, if time has passed since, as it was then; none: it began now, or the clocks do not
    say when.

    The clocks that its step reset say for how long it had been there. The clocks of an end stay as they were then: all
    others say how long ago that was.
    """
    for resets in _resets(before, state, moves):
        kept = [clock for clock in before.clocks if clock not in resets and clock in state.clocks]
        since = [(state.clocks[clock] - before.clocks[clock]) * state.unit for clock in kept]
        over = _one([state.stamp - before.stamp - each for each in since]) if state.status in ENDED else 0.0
        age = _one([state.clocks.get(clock, 0.0) * state.unit for clock in resets])
        if over is None or age is None or not over + age or state.stamp - over - age < before.stamp:
            continue
        shown = state._replace(stamp=state.stamp - over)
        if not age:
            return [shown]
        clocks = {clock: value - age / state.unit for clock, value in state.clocks.items()}
        begun = shown._replace(stamp=shown.stamp - age, clocks=clocks)
        return [begun._replace(status=RUNNING, reason="") if state.status in ENDED else begun, shown]
    return []


def _one(times: Sequence[float]) -> Optional[float]:
    """The one length of time that all of these are, 0 where there is none; None where they do not agree."""
    if not times or max(map(abs, times)) <= EXACT:
        return 0.0
    return min(times) if min(times) > EXACT and max(times) - min(times) <= EXACT else None


def _resets(before: SystemState, state: SystemState, moves: Moves) -> Iterator[Sequence[str]]:
    """The clocks that are reset on the way to this state, for each way."""
    if before.status == WAITING:
        yield moves.network.clocks
    elif state.event and moves.knows(place_of(before)):
        for move in moves.of(place_of(before), state.event, state.agent):
            place, resets = after(move, place_of(before))
            if place == place_of(state):
                yield resets


AROUND = 0.25
"""Seconds by which the recorder's clock may be beside the observer's."""

Since = Mapping[Entry, int]
"""For blocks that hold in a state the number of the first state of which what they decided stands; else: its own."""

OBSERVER = "observer"
"""The node that shows the states, and says when the mission is over."""

LONGEST = 5
"""The most states that are looked for in one gap."""


class _Step(NamedTuple):
    """A step of a play: its word, where it leads, and the clocks that it resets."""

    word: RecordedWord
    agent: str
    place: DiscreteState
    resets: Tuple[str, ...]


def completed(
    record: MissionRecord, moves: Moves, orders: Mapping[int, Orders], goal: Sequence[Tuple[str, str]]
) -> Tuple[MissionRecord, List[Finding]]:
    """The record with the states that it lacks, as far as they follow from the others and from words, and a note for
    each of them.

    `orders`: the strategies by the number of their plan, as far as they are known.
    """
    known = {state.seq for state in record.states}
    states, late = with_beginnings(with_missing(record.states, record.words, moves, orders), moves)
    whole = with_end(states, record.words, goal)
    text = "recorded {:.2f} s after it began: its first message is missing"
    notes = [Finding(NOTE, "recorded late", seq, text.format(passed)) for seq, passed in late.items()]
    text = "not recorded: the words that were recorded lead to it"
    notes += [Finding(NOTE, "not recorded", seq, text) for seq in sorted({s.seq for s in states} - known)]
    text = "no state was recorded that says how it ended: its observer said that the goal is reached"
    notes += [Finding(NOTE, "not recorded", state.seq, text) for state in whole[len(states) :]]
    return replace(record, states=tuple(whole)), notes


def with_missing(
    states: Sequence[SystemState], words: Sequence[RecordedWord], moves: Moves, orders: Mapping[int, Orders]
) -> Sequence[SystemState]:
    """Add the states that are missing between two others, where the recorded words lead from one to the other.

    `orders`: the strategies by the number of their plan, as far as they are known.
    """
    found: List[SystemState] = []
    since: Since = {}
    for state in states:
        plays = _Plays(moves, orders.get(state.plan))
        gap = [state]
        if found and found[-1].seq + 1 < state.seq <= found[-1].seq + LONGEST + 1:
            gap = [*_missing(found[-1], since, state, words, plays), state]
        for each in gap:
            since = plays.since_in(each, found[-1], since) if found else {}
            found.append(each)
    return found


def _missing(
    before: SystemState, since: Since, state: SystemState, words: Sequence[RecordedWord], plays: _Plays
) -> List[SystemState]:
    """The states between these two; none where no play of the words fits."""
    if before.status not in LIVE or before.plan != state.plan or not plays.moves.knows(place_of(before)):
        return []
    between = [word for word in words if before.stamp - AROUND <= word.at <= state.stamp + AROUND and word.event]
    for steps in plays.to(state, place_of(before), before.seq, since, between):
        made = _states(before, state, steps)
        if made:
            return made
    return []


def with_end(
    states: Sequence[SystemState], words: Sequence[RecordedWord], goal: Sequence[Tuple[str, str]]
) -> Sequence[SystemState]:
    """Add that the mission was won where no recorded state says so: it is at the goal, if there is one, and the
    observer has said that it is over."""
    last = states[-1]
    said = any(word.event == FINISH and word.node == OBSERVER and word.at >= last.stamp - AROUND for word in words)
    if not said or last.status not in LIVE or any(last.locations[name] != there for name, there in goal):
        return states
    return [*states, last._replace(status=WON)]


class _Plays:
    """Plays of words: a command counts as long as what was decided in the state of its number stands."""

    def __init__(self, moves: Moves, orders: Optional[Orders]) -> None:
        self.moves, self._orders = moves, orders

    def to(
        self, state: SystemState, place: DiscreteState, seq: int, since: Since, words: Sequence[RecordedWord]
    ) -> Iterator[List[_Step]]:
        """The plays of these words, in their order, that lead from the place of this number to the state."""
        if seq == state.seq:
            if place == place_of(state):
                yield []
            return
        for number, word in enumerate(words):
            counts = word.seq is None or max(since_for(word.agent, self._orders, since, seq)) <= word.seq <= seq
            if not counts or (seq + 1 == state.seq and word.event != state.event):
                continue
            for move in self.moves.of(place, word.event, word.agent):
                there, resets = after(move, place)
                for others in self.to(state, there, seq + 1, self._after(move, place, since, seq), words[number + 1 :]):
                    yield [_Step(word, move[0][0], there, resets), *others]

    def since_in(self, state: SystemState, before: SystemState, since: Since) -> Since:
        """For each block that holds in this state the number of the state in which was decided what stands."""
        if state.seq == before.seq:
            return since
        place, known = place_of(before), (RUNNING, RUNNING, state.plan, before.seq + 1)
        if (before.status, state.status, before.plan, state.seq) != known or not self.moves.knows(place):
            return {}
        for move in self.moves.of(place, state.event, state.agent):
            if after(move, place)[0] == place_of(state):
                return self._after(move, place, since, before.seq)
        return {}

    def _after(self, move: Move, place: DiscreteState, since: Since, seq: int) -> Since:
        return {} if self._orders is None else self._orders.after(move, place, self.moves, since, seq, seq + 1)


def _states(before: SystemState, state: SystemState, steps: Sequence[_Step]) -> List[SystemState]:
    """The states on the way of a play, but the last; none where its clocks are not those of the state."""
    zeros = {clock: before.stamp - value * before.unit for clock, value in before.clocks.items()}
    ends = {clock: state.stamp - value * state.unit for clock, value in state.clocks.items()}
    last = {clock: number for number, step in enumerate(steps) for clock in step.resets}
    if any(abs(zeros[clock] - ends.get(clock, zero)) > EXACT for clock, zero in zeros.items() if clock not in last):
        return []
    known = [_moment([ends[clock] for clock in step.resets if last[clock] == n]) for n, step in enumerate(steps)]
    if None in known:
        return []
    made: List[SystemState] = []
    moment = before.stamp
    for number, step in enumerate(steps):
        latest = min([each for each in known[number:] if each], default=state.stamp)
        moment = known[number] or min(max(moment, step.word.at), latest)
        if latest < moment - EXACT or (made and moment < made[-1].stamp - EXACT) or moment < before.stamp - EXACT:
            return []
        zeros.update(dict.fromkeys(step.resets, moment))
        made.append(
            before._replace(
                seq=before.seq + number + 1,
                stamp=moment,
                locations=dict(step.place.locations),
                values=dict(step.place.values),
                clocks={clock: (moment - zero) / state.unit for clock, zero in zeros.items()},
                event=step.word.event,
                agent=step.agent,
                status=RUNNING,
                reason="",
                commanded=step.word.seq is not None,
            )
        )
    return made[:-1]


def _moment(resets: Sequence[float]) -> Optional[float]:
    """The one moment at which clocks were reset; 0 where none was, None where they do not agree."""
    if not resets:
        return 0.0
    return min(resets) if max(resets) - min(resets) <= EXACT else None
