"""Random plays of random scenarios: the network permits what the statements permit, no more and no less."""

from __future__ import annotations

from typing import Tuple

from hypothesis import assume, given, settings
from hypothesis import strategies as st

from pursue_gen.diagnostics import Severity
from pursue_gen.language import check, parse
from pursue_gen.language.scenario import Scenario
from tests.plays import Play
from tests.whole_stories import stories


@given(stories(), st.integers(0, 10**6))
@settings(max_examples=25)
def test_the_network_permits_what_the_statements_permit(drawn: Tuple[str, Scenario], seed: int) -> None:
    _, scenario = drawn
    Play(scenario).run(30, seed)


@given(stories(), st.sampled_from(("0.1", "0.5", "2.5")), st.integers(0, 10**6))
@settings(max_examples=25)
def test_agents_rest_as_long_as_the_scenario_says(drawn: Tuple[str, Scenario], rest: str, seed: int) -> None:
    scenario = parse(f"rest {rest}\n{drawn[0]}", "story.pur", "story")
    assume(all(finding.severity is not Severity.ERROR for finding in check(scenario)))
    Play(scenario).run(30, seed)
