"""Events in parts: what that means, who wins because of it, and what missions do."""

from __future__ import annotations

from typing import Tuple

import pytest

from pursue_gen.explanation.changes import findings
from pursue_gen.language import check, parse
from pursue_gen.solving.rules import DEFAULT, Rules, played
from pursue_gen.synthesis.budget import Budget
from pursue_gen.synthesis.limits import Limits
from pursue_gen.tga import scenario_objective, translate
from pursue_gen.tga.uppaal import read_network, write_network
from pursue_gen.tools.simulation.mission import SimulatedMission
from pursue_gen.tools.simulation.outcome import GOAL, Settings
from pursue_gen.tools.simulation.stage import stage_of
from pursue_gen.vocabulary.statuses import statuses
from pursue_gen.vocabulary.words import words_of
from pursue_gen.workspace import Options
from tests.plays import Play
from tests.tga.networks import scenario
from tests.tga.test_breaking_off import solved, taken

WHOLE = """
poi "bench"
poi "tomatoes"
connect bench and tomatoes distance 3
event "prune" location tomatoes duration 40 may_stop
event "answer" location bench
event "call"
agent "bot" controllable mobile 1 location bench can_do prune, answer
agent "gerda" location bench can_do call
assume: gerda waits 20 between call
objective: if call then answer within 18
reach_objective: do prune
"""
GARDEN = WHOLE.replace("may_stop", "may_stop in 4 parts")
THERE = "bot_bench2tomatoes", "bot_going_bench_to_tomatoes2tomatoes"
BACK = "bot_tomatoes2bench", "bot_going_tomatoes_to_bench2bench"
PART = "prune", "prunePART"


def test_what_is_done_part_by_part_is_done_between_calls() -> None:
    assert solved(GARDEN) is not None
    assert solved(WHOLE) is None
    assert solved(GARDEN.replace("4 parts", "2 parts")) is None, "a part that is broken off is begun from its beginning"


def test_the_parts_are_counted_and_the_last_one_ends_all() -> None:
    story = Play(scenario(GARDEN))
    assert taken(story, *THERE, *PART)["Pprune_parts"] == 1
    assert taken(story, "prune", "pruneSTOP")["Pprune_parts"] == 1, "what is done stays done"
    assert taken(story, *BACK, *THERE, *PART, *PART)["Pprune_parts"] == 3
    assert taken(story, "prune", "pruneDONE")["Pprune_parts"] == 0
    assert [event for _, event in story.course.happened] == ["prune"]


def test_in_rules_it_is_its_turn_until_it_has_happened() -> None:
    text = GARDEN.replace('agent "bot"', 'rule "round": prune before wash\nevent "wash"\nagent "bot"')
    story = Play(scenario(text.replace("prune, answer", "prune, answer, wash")))
    taken(story, *THERE, *PART, *PART, "prune", "pruneSTOP")
    assert story.model.joint_move(story.position, "wash", "bot", timed=False) is None
    taken(story, *PART, "prune", "pruneDONE", "wash")


def test_whoever_can_goes_on_and_two_are_never_at_it() -> None:
    text = GARDEN.replace("reach_", 'agent "bot2" controllable mobile 1 location tomatoes can_do prune\nreach_')
    story = Play(scenario(text))
    taken(story, *THERE, *PART, "prune")
    assert story.model.joint_move(story.position, "prune", "bot2", timed=False) is None
    taken(story, "pruneSTOP")
    delay = next(delay for delay, agent, word in story.moves() if (agent, word) == ("bot2", "prune"))
    assert story.take("bot2", "prune", delay)
    delay = next(delay for delay, agent, word in story.moves() if (agent, word) == ("bot2", "prunePART"))
    assert story.take("bot2", "prunePART", delay) and story.position.values["Pprune_parts"] == 2


def test_how_often_it_happens_counts_its_ends() -> None:
    story = Play(scenario(GARDEN.replace("in 4 parts", "in 2 parts at_most 1 times")))
    taken(story, *THERE, *PART, "prune", "pruneSTOP", "prune", "pruneDONE")
    story.check()
    assert story.model.joint_move(story.position, "prune", "bot", timed=False) is None


def test_a_battery_is_used_and_recharged_by_parts() -> None:
    story = Play(scenario(GARDEN + "battery bot capacity 40 uses 1 per unit recharges 1 per unit at tomatoes\n"))
    there = taken(story, *THERE)["Lbot"]
    assert taken(story, "prune", "pruneSTOP")["Lbot"] == there
    assert taken(story, *PART)["Lbot"] == min(40, there + 10)


@pytest.mark.parametrize(
    ("written", "each", "warned"),
    [
        ("duration 40 may_stop in 4 parts", (10, 10.25), False),
        ("duration 40 to 44 in 4 parts", (10, 11), False),
        ("duration 10 in 3 parts", (3.3, 3.7), True),
    ],
)
def test_each_takes_a_share_of_the_time(written: str, each: Tuple[float, float], warned: bool) -> None:
    story = scenario(WHOLE.replace("duration 40 may_stop", written))
    assert story.events[0].part_window == pytest.approx(each)
    codes = [finding.code for finding in check(story)]
    assert ("PML424" in codes) == warned
    low, high = story.events[0].part_window or (0, 0)
    whole, parts = story.events[0].window or (0, 0), story.events[0].split or 1
    assert low * parts <= whole[0] and high * parts >= whole[1], "it is on the safe side"


@pytest.mark.parametrize(
    ("event", "said"),
    [
        ('event "prune" location tomatoes in 4 parts', "prune takes no time"),
        ('event "prune" collaborative together location tomatoes duration 40 in 4 parts', "prune is collaborative"),
        ('event "prune" location tomatoes duration 40 in 1 parts', "prune has 1 parts: expected 2 to 20"),
        ('event "prune" location tomatoes duration 40 in 21 parts', "prune has 21 parts: expected 2 to 20"),
    ],
)
def test_what_cannot_be_done_in_parts(event: str, said: str) -> None:
    text = WHOLE.replace('event "prune" location tomatoes duration 40 may_stop', event)
    text = text.replace("can_do call", "can_do call reacts_to prune") if "together" in event else text
    found = [finding for finding in check(parse(text, "x.pur", "x")) if finding.code == "PML440"]
    assert [said in finding.message for finding in found] == [True]


def test_two_names_for_one_word_are_refused() -> None:
    text = GARDEN.replace('event "call"', 'event "call"\nevent "prunePART"')
    found = check(parse(text.replace("prune, answer", "prune, answer, prunePART"), "x.pur", "x"))
    assert "PML105" in [finding.code for finding in found]


def test_a_lost_one_says_how_many_parts_would_do() -> None:
    changes = findings(scenario(WHOLE), Rules(), Budget(Limits(states=20_000))).changes
    (parts,) = (change for change in changes if change.what == "parts")
    assert parts.sentence == f"prune in {parts.after} parts, of which each stays done (may_stop in {parts.after} parts)"
    assert parts.after in ("3", "4") and parts.before == "1"


def test_people_read_how_far_it_is() -> None:
    story = scenario(GARDEN)
    network = translate(story)
    (status,) = (each for each in statuses(story, network) if each.of == "prune_parts")
    assert list(status.texts.values()) == [f"{k} of 4 parts" for k in range(4)]
    words = words_of(story, network)
    end = next(edge for edge in network.automaton("bot").edges if edge.sent == "prunePART")
    assert end.is_end and not end.breaks_off
    assert words.sentence("bot", end) == "bot finishes a part of prune"


def test_missions_go_on_with_the_part_that_was_begun() -> None:
    found = solved(GARDEN)
    assert found is not None
    stage = stage_of(scenario(GARDEN), found, Options(reaction=found.reaction))
    for seed in range(1, 9):
        mission = SimulatedMission(stage, Settings("random", until=400.0), seed, None)
        outcome = mission.run()
        assert (outcome.end, outcome.problems) == (GOAL, ())
        events = [state.event for state in mission.recorder.states]
        assert (events.count("prunePART"), events.count("pruneDONE")) == (3, 1)


def test_uppaal_reads_it_back() -> None:
    story = scenario(GARDEN)
    made = translate(story)
    assert read_network(write_network(made, scenario_objective(story)), "x.xml") == made


def test_the_default_game_reports_the_ends_of_parts() -> None:
    network = played(translate(scenario(GARDEN)), DEFAULT)
    ends = [edge for edge in network.automaton("bot").edges if edge.sent == "prunePART"]
    assert ends and not any(edge.controllable for edge in ends)
