"""Events that may be broken off: what that means, who wins because of it, and what missions do."""

from __future__ import annotations

from typing import Dict, Optional, Tuple

import pytest
from hypothesis import assume, given, settings

from pursue_gen.diagnostics import PursueError
from pursue_gen.explanation.changes import findings
from pursue_gen.language import check, parse
from pursue_gen.language.scenario import Scenario
from pursue_gen.solving.rules import DEFAULT, REPORTED, Rules, played
from pursue_gen.solving.solution import Solution, solve_scenario
from pursue_gen.synthesis.budget import Budget
from pursue_gen.synthesis.limits import Limits
from pursue_gen.tga import scenario_objective, translate
from pursue_gen.tga.uppaal import read_network, write_network
from pursue_gen.tools.simulation.mission import SimulatedMission
from pursue_gen.tools.simulation.outcome import GOAL, Settings
from pursue_gen.tools.simulation.stage import stage_of
from pursue_gen.vocabulary.words import words_of
from pursue_gen.workspace import Options
from tests.plays import Play
from tests.tga.networks import scenario
from tests.tga.test_unknown_states import won
from tests.whole_stories import stories

GARDEN = """
poi "bench"
poi "tomatoes"
connect bench and tomatoes distance 3
event "prune" location tomatoes duration 20 may_stop
event "answer" location bench
event "call"
agent "bot" controllable mobile 1 location bench can_do prune, answer
agent "gerda" location bench can_do call
assume: gerda does call at_most 2 times
objective: if call then answer within 12
reach_objective: do prune
"""


def solved(text: str) -> Optional[Solution]:
    try:
        return solve_scenario(scenario(text), DEFAULT)
    except PursueError as problem:
        assert problem.diagnostics[0].code in ("SYN020", "SYN021"), problem
        return None


def test_who_may_break_off_keeps_what_is_due_sooner() -> None:
    found = solved(GARDEN)
    assert found is not None
    commands = [command for block in found.strategy.blocks for command in block.commands]
    assert any(command.moves[0].edge.breaks_off for command in commands)
    assert solved(GARDEN.replace(" may_stop", "")) is None


@given(stories(small=True))
@settings(max_examples=20)
def test_who_may_break_off_wins_what_is_won_without(drawn: Tuple[str, Scenario]) -> None:
    text, story = drawn
    assume(" may_stop" in text)
    if won(parse(text.replace(" may_stop", ""), "story.pur", "story")):
        assert won(story), text


def test_a_lost_one_says_that_it_would_do() -> None:
    lost = scenario(GARDEN.replace(" may_stop", ""))
    changes = findings(lost, Rules(), Budget(Limits(states=20_000))).changes
    assert "prune that may be broken off (may_stop)" in [change.sentence for change in changes]


def test_what_is_broken_off_has_not_happened() -> None:
    """Calls without end keep the robot from ever pruning."""
    assert solved(GARDEN.replace("assume: gerda does call at_most 2 times\n", "")) is None


def test_it_is_decided_by_who_does_it_and_the_end_is_not() -> None:
    network = played(translate(scenario(GARDEN)), Rules(REPORTED))
    bot = network.automaton("bot")
    (stop,) = (edge for edge in bot.edges if edge.breaks_off)
    (end,) = (edge for edge in bot.edges if edge.sent == "pruneDONE")
    assert (stop.source, stop.target, stop.sent) == ("doing_prune_in_tomatoes", "tomatoes", "pruneSTOP")
    assert (stop.controllable, stop.is_end, end.controllable, end.is_end) == (True, False, False, True)
    assert stop.guard.since == 1, "there is a rest between two steps"
    words = words_of(scenario(GARDEN), network)
    assert (words.sentence("bot", stop), words.command("bot", stop)) == ("bot breaks off prune", "bot: break off prune")


def taken(story: Play, *words: str) -> Dict[str, int]:
    """The variables after these words of the robot, each as soon as it may be."""
    for word in words:
        delay = next(delay for delay, agent, able in story.moves() if (agent, able) == ("bot", word))
        assert story.take("bot", word, delay)
        story.check()
    return story.position.values


def test_it_is_the_turn_again_of_what_was_broken_off() -> None:
    text = GARDEN.replace('agent "bot"', 'rule "round": (prune or answer) before wash\nevent "wash"\nagent "bot"')
    story = Play(scenario(text.replace("prune, answer", "prune, answer, wash")))
    there = "bot_bench2tomatoes", "bot_going_bench_to_tomatoes2tomatoes", "prune"
    assert taken(story, *there)["Pround"] != 0
    assert taken(story, "pruneSTOP")["Pround"] == 0
    assert taken(story, "prune", "pruneDONE")["Pround"] != 0


def test_each_robot_has_its_turn_again() -> None:
    text = GARDEN.replace('agent "bot"', 'rule "round" for each robot: prune before answer\nagent "bot"')
    story = Play(scenario(text))
    taken(story, "bot_bench2tomatoes", "bot_going_bench_to_tomatoes2tomatoes", "prune", "pruneSTOP", "prune")


def test_a_charge_that_is_broken_off_counts_for_nothing() -> None:
    text = GARDEN + "battery bot capacity 40 uses 1 per unit recharges 1 per unit at tomatoes\n"
    story = Play(scenario(text))
    there = taken(story, "bot_bench2tomatoes", "bot_going_bench_to_tomatoes2tomatoes")["Lbot"]
    assert taken(story, "prune", "pruneSTOP")["Lbot"] == there < taken(story, "prune", "pruneDONE")["Lbot"]


def test_that_somebody_is_doing_it_ends_with_it() -> None:
    text = GARDEN.replace("call then answer within 12", "bot at tomatoes then not bot doing prune within 30")
    edges = translate(scenario(text)).automaton("obj").edges
    assert {edge.channel for edge in edges if edge.target == "idle"} >= {"pruneDONE", "pruneSTOP"}


def test_missions_break_it_off_and_are_won() -> None:
    found = solved(GARDEN)
    assert found is not None
    stage = stage_of(scenario(GARDEN), found, Options(reaction=found.reaction))
    stopped = 0
    for seed in range(1, 9):
        mission = SimulatedMission(stage, Settings("random", until=200.0), seed, None)
        outcome = mission.run()
        assert (outcome.end, outcome.problems) == (GOAL, ())
        stopped += sum(state.event == "pruneSTOP" for state in mission.recorder.states)
    assert stopped


@pytest.mark.parametrize(
    ("event", "said"),
    [
        ('event "prune" location tomatoes may_stop', "prune takes no time"),
        ('event "prune" collaborative together location tomatoes duration 20 may_stop', "prune is collaborative"),
    ],
)
def test_what_cannot_be_broken_off(event: str, said: str) -> None:
    text = GARDEN.replace('event "prune" location tomatoes duration 20 may_stop', event)
    text = text.replace("can_do call", "can_do call reacts_to prune") if "together" in event else text
    found = [finding for finding in check(parse(text, "x.pur", "x")) if finding.code == "PML433"]
    assert [said in finding.message for finding in found] == [True]


def test_two_names_for_one_word_are_refused() -> None:
    text = GARDEN.replace('event "call"', 'event "call"\nevent "pruneSTOP"')
    found = check(parse(text.replace("prune, answer", "prune, answer, pruneSTOP"), "x.pur", "x"))
    assert "PML105" in [finding.code for finding in found]


def test_uppaal_reads_it_back() -> None:
    story = scenario(GARDEN)
    made = translate(story)
    again = read_network(write_network(made, scenario_objective(story)), "x.xml")
    assert again == made
    assert [edge.breaks_off for _, edge in again.edges] == [edge.breaks_off for _, edge in made.edges]
