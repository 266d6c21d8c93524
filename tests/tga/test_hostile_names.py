"""Names that look like those that the generator makes: refused by `check`, with a place, or fit for a network."""

from __future__ import annotations

import re
from typing import Dict

from hypothesis import given
from hypothesis import strategies as st

from pursue_gen.diagnostics import Severity
from pursue_gen.language.parser import read
from pursue_gen.solving.inputs import findings_of
from pursue_gen.tga import scenario_objective, translate
from pursue_gen.tga.uppaal_read import read_network
from pursue_gen.tga.uppaal_write import WORDS, renamed, uppaal_names, write_network
from tests.whole_stories import stories

_NAMES = (
    "a",
    "b",
    "c",
    "load",
    "drop",
    "ride",
    "wave",
    "sing",
    "call",
    "r0",
    "r1",
    "open",
    "bot1",
    "bot2",
    "nurse",
    "guest",
)
_LOOK_ALIKES = (
    "assume1", "assume2", "assume1count", "Cassume1", "assume3", "obj", "obj1", "obj2", "Cobj", "Cobj2", "Pobj",
    "reachObj", "reachObj2", "Creach", "reach", "CreachObj", "states", "base", "idle", "atRisk", "lose", "win", "late",
    "unlocked", "did_1_2", "initial_location", "going_a_to_b", "doing_load_in_a", "loadDONE", "Bride", "load_count",
    "Pload_count", "load_count_1", "Cbot1", "Pbot1", "Wbot1", "Lbot1", "Sopen", "Pr0", "Pr0_bot1", "r00f", "r01f",
    "bot1_a2b", "bot1_going_a_to_b2b", "a_to_b", "b_to_c", "load_in_a", "a_in_b", "a2b", "b2a", "going_", "bot1_",
)  # fmt: skip


@st.composite
def disguised(draw: st.DrawFn) -> str:
    """The text of a whole scenario in which some names are others, that look as if they were generated."""
    text, _ = draw(stories())
    hostile = st.sampled_from((*_LOOK_ALIKES, *sorted(WORDS)))
    names: Dict[str, str] = draw(st.dictionaries(st.sampled_from(_NAMES), hostile, min_size=1, max_size=5))
    return re.sub(r"\b\w+\b", lambda word: names.get(word[0], word[0]), text)


@given(disguised())
def test_what_check_passes_becomes_a_network(text: str) -> None:
    reading = read(text, "story.pur", "story")
    errors = [finding for finding in findings_of(reading) if finding.severity is Severity.ERROR]
    assert all(finding.span is not None and finding.hint for finding in errors)
    if errors or reading.scenario is None:
        return
    network, objective = translate(reading.scenario), scenario_objective(reading.scenario)
    written = renamed(network, uppaal_names(network))
    assert read_network(write_network(network, objective), "TGA.xml") == written
