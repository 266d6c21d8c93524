"""Which word led to which state, and why the others led to nothing."""

from __future__ import annotations

import bisect
import math
from dataclasses import dataclass
from typing import Dict, FrozenSet, List, Mapping, Optional, Sequence, Set, Tuple

from pursue_gen.tools.replay.finding import NOTE, WORLD, Finding
from pursue_gen.tools.replay.moves import EXACT, Moves, place_of
from pursue_gen.tools.replay.record import MissionRecord, RecordedWord
from pursue_runtime.event_words import (
    BACK,
    BLOCKED,
    DISPLACED,
    FAILED,
    FINISH,
    FREE,
    HELD,
    ORDERED,
    PING,
    PLANNED,
    RESUME,
    START,
    STOP,
    STUCK,
)
from pursue_runtime.locations import end_of, part_of
from pursue_runtime.sentences import in_words
from pursue_runtime.state import ENDED, HOLDING, WAITING, SystemState

CONTROL = (START, PING, STOP, FINISH)
REPORTS = {BLOCKED: WORLD, STUCK: WORLD, FREE: NOTE, HELD: WORLD, RESUME: NOTE, DISPLACED: WORLD, BACK: NOTE}
"""Reports about robots and ways, which move no automaton, and what they are in the findings."""

APART = 60.0
"""Seconds by which the recorder may have received a report earlier or later than the observer: links may be cut."""


class Arrivals:
    """In which states automata came to their locations."""

    def __init__(self, states: Sequence[SystemState]) -> None:
        self._numbers: Dict[str, List[int]] = {}
        here: Dict[str, str] = {}
        for state in states:
            for name, location in state.locations.items():
                if here.get(name, location) != location:
                    self._numbers.setdefault(name, []).append(state.seq)
            here.update(state.locations)

    def are_after(self, word: RecordedWord, agent: str, seq: int) -> bool:
        """True for a report of what the agent had begun before it came to where it is in the state of this number."""
        numbers = self._numbers.get(agent, [])
        place = bisect.bisect(numbers, seq)
        return word.as_of is not None and place > 0 and word.as_of < numbers[place - 1]


@dataclass(frozen=True)
class WordMatches:
    """The word of each step (by the number of its state), the states by number, and the words that led to nothing.

    `standing`: the numbers of the states in which what was decided before them stands.
    """

    words: Mapping[int, RecordedWord]
    states: Mapping[int, SystemState]
    unmatched: Tuple[RecordedWord, ...]
    standing: FrozenSet[int]
    arrivals: Arrivals

    def of(self, seq: int) -> Optional[RecordedWord]:
        """The word that led to this state."""
        return self.words.get(seq)


def match_words(
    record: MissionRecord, steps: Sequence[Tuple[SystemState, SystemState, SystemState]], moves: Moves
) -> WordMatches:
    """A command is for the number of the state before it (the second of a step), or of one before that back to the
    first, if the plan has seen nothing new since; of several reports the one nearest to the state counts.

    What several do together ends with the last of their reports; the others are matched as well.
    """
    received: Dict[Tuple[str, Optional[int]], List[Tuple[float, int]]] = {}
    for place, word in enumerate(record.words):
        received.setdefault((word.event, word.seq), []).append((word.moment, place))
    for words in received.values():
        words.sort()
    used: Set[int] = set()
    ago, later = (math.inf, EXACT) if record.is_exact else (APART, APART)  # no word comes after what it leads to
    found: Dict[int, RecordedWord] = {}
    arrivals = Arrivals(record.states)
    for since, before, state in steps:
        numbers = (*range(before.seq, since.seq - 1, -1), None)
        ends = [(end_of(state.event), None)] if end_of(state.event) else []
        for words in (received.get(key, []) for key in (*((state.event, number) for number in numbers), *ends)):
            near = words[bisect.bisect(words, (state.stamp - ago,)) : bisect.bisect(words, (state.stamp + later,))]
            members = moves.sharing(place_of(before), state.event, state.agent) or (state.agent,)
            nearest: Dict[str, int] = {}
            for _, place in sorted(near, key=lambda entry: abs(entry[0] - state.stamp)):
                word = record.words[place]
                agent = word.agent or state.agent
                if agent in members and place not in used and not arrivals.are_after(word, agent, before.seq):
                    nearest.setdefault(agent, place)
            if nearest:
                used.update(nearest.values())
                found[state.seq] = record.words[next(iter(nearest.values()))]
                break
    states: Dict[int, SystemState] = {}
    for state in record.states:
        states.setdefault(state.seq, state)
    left = [word for place, word in enumerate(record.words) if place not in used and not _control(word)]
    standing = frozenset(before.seq for since, before, _ in steps if since.seq != before.seq)
    return WordMatches(found, states, tuple(left), standing, arrivals)


def _control(word: RecordedWord) -> bool:
    return word.text in CONTROL or word.event in (PLANNED, ORDERED, FAILED, *REPORTS)


def unmatched_words(record: MissionRecord, said: WordMatches, moves: Moves) -> List[Finding]:
    """Why each word that led to nothing did; and the words that steer the mission itself."""
    found: List[Finding] = []
    stamps = [state.stamp for state in record.states]

    def now(word: RecordedWord) -> SystemState:
        return record.states[max(0, bisect.bisect(stamps, word.at + 1e-6) - 1)]

    for word in record.words:
        if word.text == STOP:
            found.append(Finding(NOTE, "stop", now(word).seq, f"{_sender(word)} published {STOP}"))
        elif word.event in REPORTS:
            kind = "way" if word.event in (BLOCKED, FREE) else "robot"
            text = f"{_sender(word)} published {in_words(word.text)}"
            found.append(Finding(REPORTS[word.event], kind, now(word).seq, text))
        elif word.event == FAILED:
            found.append(Finding(WORLD, "failed", now(word).seq, f"{word.agent} cannot carry out its order"))
    for word in said.unmatched:
        seq, why = _why(now(word), word, said, moves)
        found.append(Finding(NOTE, "dropped", seq, f"{word.text[:80]!r} of {_sender(word)} led to nothing: {why}"))
    return found


def _sender(word: RecordedWord) -> str:
    return word.node or "an unknown node"


def _why(now: SystemState, word: RecordedWord, said: WordMatches, moves: Moves) -> Tuple[int, str]:
    """The state that it met, and the reason."""
    if not word.event:
        return now.seq, "it is no word"
    if word.seq is None:
        meant = (move for end in (word.event, part_of(word.event)) for move in moves.of(place_of(now), end, word.agent))
        doer = next((move[0][0] for move in meant), "")
        agent = word.agent or doer
        if said.arrivals.are_after(word, agent, now.seq):
            return now.seq, f"it reports the end of what {agent} had begun before state {now.seq}"
        if moves.sharing(place_of(now), word.event, word.agent):
            return now.seq, "it was noted, and others had not finished yet"
        return now.seq, _impossible(now, word, moves) or "its moment had not come, or the observer did not receive it"
    number = word.seq + 1
    while number in said.standing:
        number += 1
    state, following = said.states.get(word.seq), said.states.get(number)
    taken = [said.of(each) for each in range(word.seq + 1, number + 1)]
    if state is None:
        return word.seq, f"state {word.seq} is not in the recording"
    if any(each is not None and (each.agent, each.event) == (word.agent, word.event) for each in taken):
        return word.seq, "it was published again, and had been taken"
    if following is not None:
        what = f"{following.event} by {following.agent}" if following.event else "another status"
        return word.seq, f"{what} came first"
    return word.seq, _impossible(state, word, moves) or "the mission ended first, or its moment was over"


def _impossible(state: SystemState, word: RecordedWord, moves: Moves) -> str:
    """Why the word cannot be taken there, whatever the clocks; "" where it can."""
    if state.status == WAITING or state.status in ENDED:
        return f"the mission was {state.status}"
    if state.status == HOLDING and word.seq is not None:
        return "the mission held"
    place = place_of(state)
    if next(moves.of(place, word.event, word.agent), None) is None:
        return f"it cannot happen in state {state.seq}; possible: {', '.join(moves.possible(place)) or 'nothing'}"
    return ""
