"""Patrols and escorts by one of several: what they are read as, what is wrong with them, what is shown and proposed."""

from __future__ import annotations

from typing import List

import pytest

from pursue_gen.language.checks import check_reading
from pursue_gen.language.draft import Draft
from pursue_gen.language.formatter import format_text
from pursue_gen.language.parser import parse, read
from pursue_gen.language.scenario import Scenario
from pursue_gen.language.sentences import objective_words
from pursue_gen.language.writer import scenario_text
from pursue_gen.tga import translate
from pursue_gen.tools.lsp.completion import complete

FLOOR = """\
poi "hall"
poi "a"
poi "b"
connect hall and a distance 3
connect hall and b distance 3
group "guards": bot1, bot2
agent "bot1" label "Ada" controllable mobile 1 location hall
agent "bot2" controllable mobile 1 location hall
agent "bot3" controllable location hall
agent "visitor" mobile 4 location hall
{}
"""
PATROL, ESCORT = "objective: patrol a, b every 30 by {}", "objective: escort visitor at a within 9 by {}"


def scenario(statement: str) -> Scenario:
    return parse(FLOOR.format(statement), "x.pur", "x")


def codes(statement: str) -> List[str]:
    return [one.code for one in check_reading(read(FLOOR.format(statement), "x.pur"))]


@pytest.mark.parametrize("statement", [PATROL, ESCORT])
def test_one_of_several_is_read_and_written(statement: str) -> None:
    story = scenario(statement.format("bot1 or bot2"))
    assert [ref.name for ref in story.safety[0].who.named] == ["bot1", "bot2"]  # type: ignore[attr-defined]
    assert story.safety[0].text.endswith("by bot1 or bot2") and "by bot1 or bot2" in scenario_text(story)
    assert "by bot1 or bot2\n" in format_text(FLOOR.format(statement.format("bot1 or bot2")), "x.pur")
    assert codes(statement.format("bot1 or bot2")) == []
    assert scenario(statement.format("any of guards")).safety[0].text == story.safety[0].text


def test_who_counts_in_the_network_and_who_does_not() -> None:
    made = translate(scenario(PATROL.format("bot1 or bot2")))
    channels = {edge.channel for edge in made.automaton("obj").edges if edge.channel is not None}
    assert {channel.split("_")[0] for channel in channels} == {"bot1", "bot2"}
    assert translate(scenario(PATROL.format("bot2"))) != made == translate(scenario(PATROL.format("any of guards")))


def test_sentences() -> None:
    assert objective_words(scenario(PATROL.format("bot1 or bot2")))[0].startswith("Ada or bot2 is at a at least every")
    said = objective_words(scenario(ESCORT.format("bot1 or bot2")))[0]
    assert said.startswith("Whenever visitor is at a without Ada or bot2, Ada or bot2 is there within")


@pytest.mark.parametrize(
    ("statement", "code"),
    [
        (PATROL.format("bot1 or bot1"), "PML267"),
        (ESCORT.format("any of guards or bot2"), "PML267"),
        (ESCORT.format("bot1 or visitor"), "PML173"),
        (PATROL.format("bot1 or bot4"), "PML110"),
        (PATROL.format("bot1 or bot3"), "PML230"),
        (PATROL.format("bot1 or"), "PML010"),
        (PATROL.format("guards"), "PML409"),
        (PATROL.format("all of guards"), "PML411"),
    ],
)
def test_what_is_wrong_with_it_is_said(statement: str, code: str) -> None:
    assert code in codes(statement)


def test_a_group_in_the_place_of_one_is_told_how_to_write_it() -> None:
    (finding,) = check_reading(read(FLOOR.format(PATROL.format("guards")), "x.pur"))
    assert finding.hint.startswith("write any of guards")


@pytest.mark.parametrize("statement", [PATROL, ESCORT])
def test_editors_propose_agents_behind_or(statement: str) -> None:
    text = FLOOR.format(statement.format("bot1 or ")).rstrip("\n") + " "
    proposed = [item.label for item in complete(Draft.of(text, "x.pur"), len(text) - 1)]
    assert proposed[0] == "bot2" and not {"hall", "any"} & {*proposed}
    text = FLOOR.format(statement.format("any ")).rstrip("\n")
    assert {"of", "robot"} <= {item.label for item in complete(Draft.of(text, "x.pur"), len(text))}
