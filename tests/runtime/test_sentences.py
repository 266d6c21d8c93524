"""Nodes mark the names in what they say; who shows it to people puts labels there, and nowhere else."""

from __future__ import annotations

import re
from typing import Any, Dict, List, Tuple

import pytest
from hypothesis import given
from hypothesis import strategies as st

from pursue_runtime.model import Model
from pursue_runtime.sentences import as_sentence, in_words, marked, quoted
from pursue_runtime.state import format_state, parse_state
from pursue_runtime.ui.environment import TraceEnvironment
from pursue_runtime.ui.mission_view import MissionView
from tests.runtime.observer.test_mission import CHASE, SEVERAL, Journey
from tests.runtime.observer.test_uncovered import COVER
from tests.runtime.texts import read


def verdict(labels: Dict[str, str], *words: str) -> str:
    """What people read at the end of a mission with these labels."""
    text = SEVERAL + f"labels: {labels}\n"
    made, view = Journey(text), MissionView(Model(read(text)), TraceEnvironment(()))
    states: List[Any] = [made.hear(word, float(moment)) for moment, word in enumerate(("_start_", *words))]
    for state in states:
        view.on_state(state, state.stamp)
    told = view.verdict()
    assert told is not None
    return told[1]


@pytest.mark.parametrize(("labels", "says"), [
    ({}, "bot does fall (broken: avoid fall)"),
    ({"bot": "Porter 1", "fall": "drop the parcel"}, "Porter 1 does drop the parcel (broken: avoid fall)"),
    ({"bot": "{fall}", "fall": "bot: {0!r} }{"}, "{fall} does bot: {0!r} }{ (broken: avoid fall)"),
    ({"does": "never", "broken": "never", "bot": "Tom"}, "Tom does fall (broken: avoid fall)"),
])  # fmt: skip
def test_what_has_lost_a_mission_is_told_with_the_labels_of_who_did_it_and_what(
    labels: Dict[str, str], says: str
) -> None:
    assert verdict(labels, "wave", "fall").endswith(f": {says}.")


# What is marked

NAMES = st.from_regex(r"[A-Za-z][A-Za-z0-9_]{0,8}", fullmatch=True)
WORDS = "the strategy does not say what to do then is late its way and looking for another plan state command".split()


@given(
    st.lists(st.one_of(st.tuples(st.just(quoted), st.text(max_size=9)), st.tuples(st.just(marked), NAMES)), max_size=9),
    st.dictionaries(NAMES, st.text(max_size=9)),
)
def test_a_sentence_is_read_with_the_names_or_with_labels_for_them_alone(
    parts: List[Tuple[Any, str]], labels: Dict[str, str]
) -> None:
    labels.update({text: "{Porter 1}" for part, text in parts[:3] if part is marked})
    shown = lambda name: labels.get(name, name)
    made = "".join(part(text) for part, text in parts)
    assert in_words(made) == "".join(text for _, text in parts)
    assert in_words(made, shown) == "".join(shown(text) if part is marked else text for part, text in parts)
    assert as_sentence(made) == made, "another program's sentence keeps its marks"


@given(st.text(alphabet="{}ab!:. ", max_size=12))
def test_any_text_can_be_shown_and_be_part_of_a_sentence(text: str) -> None:
    assert in_words(quoted(text), str.upper) == text
    assert in_words(as_sentence(text)) == in_words(text)
    assert in_words(f"{as_sentence(text)} {marked('bot')}").endswith(" bot"), "the rest of the sentence can be read"


@pytest.mark.parametrize("text", ["{", "}", "{}", "{0}", "{bot.name}", "{bot[0]}", "{bot!r}", "{bot:9}", "{'seq': 3}"])
def test_a_text_that_is_no_sentence_is_shown_as_it_is(text: str) -> None:
    assert in_words(text, str.upper) == in_words(as_sentence(text), str.upper) == text


# What the observer says


def late(agent: str, place: str) -> Journey:
    """A mission that holds as this agent is late on its way to this place."""
    renamed = [re.sub(r"\bbot\b", agent, re.sub(r"\bb\b", place, text)) for text in (CHASE, COVER)]
    made = Journey(*renamed, on_uncovered="plan", controllers=("one",), lost_after=8.0)
    made.hear("_start_", 0.0)
    made.hear("bot_a2b", 2.0)
    moment, state = made.tick_from(2.0)
    while state is None or state.status == "running":
        moment, state = made.tick_from(moment)
    return made


@given(st.sampled_from(WORDS), st.sampled_from(WORDS), st.text(min_size=1, max_size=9))
def test_a_name_that_is_a_word_of_the_sentence_has_its_label_where_it_is_meant(
    agent: str, place: str, label: str
) -> None:
    place = f"{place}_" if place == agent else place
    made = late(agent, place)
    says = "{} is late on its way from a to {}, and the strategy does not say what to do then; looking for another plan"
    assert in_words(made.mission.reason) == says.format(agent, place)
    labels = {agent: label, place: "{0}", "a": "a"}
    assert in_words(made.mission.reason, labels.__getitem__) == says.format(label, "{0}")
    assert not [text for _, text in made.logs if "{" in text]


def test_what_other_programs_say_stays_as_it_is() -> None:
    made = late("bot", "b")
    state = made.hear("bot:_failed_ on its way to {b}: aborted: bot {bot} is stuck {in mud", 9.0)
    says = "has failed on its way to {b}: aborted: bot {bot} is stuck {in mud; looking for another plan"
    assert in_words(state.reason, str.upper) == f"BOT {says}"
    (state,) = made.mission.on_no_plan(made.mission.plan_request.number, "no {'bot': 3} at {b}", 9.0)
    assert state.status == "stopped"
    assert in_words(state.reason, str.upper).endswith("; no other plan: no {'bot': 3} at {b}")


def test_a_stop_of_a_journal_of_before_there_were_marks_has_its_reason() -> None:
    made = Journey()
    made.hear("_start_", 0.0)
    (state,) = made.mission.stop("the observer was restarted, and its journal is not complete ({'at: bot)", 1.0)
    says = "the observer was restarted, and its journal is not complete ({'at: bot)"
    assert in_words(state.reason, str.upper) == says
    assert f" reason={says}\n" in format_state(state), "the text of the state is for people"
    assert in_words(parse_state(format_state(state)).reason) == says
