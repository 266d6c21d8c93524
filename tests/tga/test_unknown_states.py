"""States that are not known at first: who may rely on what before they are found out, and what strategies promise."""

from __future__ import annotations

import random
from pathlib import Path
from typing import Set, Tuple

import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from pursue_gen.diagnostics import PursueError
from pursue_gen.explanation.changes import findings
from pursue_gen.language import load, parse
from pursue_gen.language.conditions import Condition, condition_text
from pursue_gen.language.scenario import Respond, Scenario
from pursue_gen.proof.moves import Arena
from pursue_gen.solving.options import SolveOptions
from pursue_gen.solving.rules import Rules
from pursue_gen.solving.solution import solve_scenario
from pursue_gen.synthesis.budget import Budget
from pursue_gen.synthesis.limits import Limits
from pursue_gen.tga import scenario_objective, translate
from pursue_gen.tga.uppaal import read_network, write_network
from pursue_gen.tools.simulation.meaning import holds
from pursue_gen.vocabulary.words import words_of
from tests.conditions import CONDITIONS, SCENARIO, with_only_if
from tests.plays import model_of
from tests.tga.networks import scenario
from tests.tga.test_conditions import states_of
from tests.whole_stories import stories

ROOT = Path(__file__).resolve().parents[2]
KNOWN = "initially true, true_if open false_if close, paint"
UNKNOWN = (
    "initially unknown, true_if open false_if close, paint shown_by clean",
    "initially unknown seen_at shop, true_if open",
    "initially unknown seen_at yard",
)

LOST = ("SYN020", "SYN021", "SYN022")
"""Codes of verdicts; others are limits."""

SHELF = """
poi "dock"
poi "shelf"
connect dock and shelf distance 4
event "look" location shelf duration 2
event "refill" location shelf duration 3 only_if empty is_true
event "report" location dock only_if empty is_false
state "empty": initially unknown, false_if refill shown_by look
agent "bot" controllable mobile 1 location dock can_do look, refill, report
"""


@given(CONDITIONS, st.sampled_from(["close", "open", "paint", "carry", "way"]), st.sampled_from(UNKNOWN))
@settings(max_examples=20)
def test_robots_begin_what_is_allowed_in_any_case_and_others_what_may_be(
    condition: Condition, what: str, state: str
) -> None:
    text = with_only_if({what: condition_text(condition)}).replace(KNOWN, state)
    story = parse(text, "x.pur")
    controlled = {agent.name: agent.controllable for agent in story.agents}
    network, free = translate(story), Arena(translate(parse(SCENARIO.replace(KNOWN, state), "x.pur")), 1, True)
    variables, names = [name for name, _ in network.variables], [each.name for each in network.automata]
    kept = [variables.index(name) for name, _ in free.network.variables]

    def sent(arena: Arena, places: Tuple[str, ...], values: Tuple[int, ...]) -> Set[Tuple[str, str]]:
        first = [move.moves[0] for move in arena.situation((places, values)).moves]
        return {(move.automaton, move.edge.sync.channel if move.edge.sync else "") for move in first}

    whole = Arena(network, 1, idle_moves=True)
    ways = {f"{name}_{way}" for name in controlled for way in ("hall2shop", "shop2hall")}
    limited = ways if what == "way" else {what}
    for places, values in states_of(network):
        here = dict(zip(names, places)), dict(zip(variables, values))
        told = {name: holds(condition, story, *here, all if its else any) for name, its in controlled.items()}
        possible = sent(free, places, tuple(values[k] for k in kept))
        assert sent(whole, places, values) == {one for one in possible if one[1] not in limited or told[one[0]]}


@given(CONDITIONS, st.booleans(), st.sampled_from(UNKNOWN))
@settings(max_examples=40)
def test_what_is_avoided_is_lost_where_it_may_be_so(condition: Condition, always: bool, state: str) -> None:
    text = SCENARIO.replace(KNOWN, state)
    story = parse(text + f"objective: {'always' if always else 'avoid'} {condition_text(condition)}\n", "x.pur")
    network, broken = translate(story), story.safety[0].breaks.condition
    assert broken is not None
    names, variables = [each.name for each in network.automata], [name for name, _ in network.variables]
    arena = Arena(network, 1, idle_moves=True)
    for places, values in states_of(network):
        locations = dict(zip(names, places))
        if locations["obj"] == "idle":
            lost = any(move.moves[0].edge.target == "lose" for move in arena.situation((places, values)).moves)
            assert lost is holds(broken, story, locations, dict(zip(variables, values)), any)


FORMS = (
    "if light is_true then bot at shelf within 1000",
    "if not light is_true then bot at shelf within 1000",
    "if bot at dock then light is_false within 1000",
    "if bot at shelf and light is_true then bot at dock or light is_false within 1000",
    "if light is_true or kid at shelf then bot on_way within 1000",
    "if kid at shelf then (light is_true and bot at shelf) or (light is_false and bot at dock) within 1000",
)


@pytest.mark.parametrize("form", FORMS)
@given(seed=st.integers(0, 10**6))
@settings(max_examples=15)
def test_a_condition_comes_to_hold_when_it_is_known_that_it_does(form: str, seed: int) -> None:
    """Random plays, against the meaning of conditions said of places and states."""
    story = scenario(SHELF.replace("can_do", "can_do dim, ") + f"""
event "dim"
state "light": initially unknown seen_at shelf, false_if dim
agent "kid" mobile 1 location dock
objective: {form}
""")
    (duty,) = story.safety
    assert isinstance(duty, Respond)
    model, rng = model_of(story), random.Random(seed)
    here, held, due = model.initial(), False, False
    for _ in range(40):
        begun, answered = (
            holds(what, story, here.locations, here.values)  # type: ignore[arg-type]
            for what in (duty.trigger, duty.response)
        )
        due = not answered and (due or (begun and not held))
        held = begun
        assert here.locations["obj"] == ("atRisk" if due else "idle"), here
        able = [each for each in model.possible(here, timed=False) if not each.startswith("obj")]
        moves = model.joint_move(here, rng.choice(able), timed=False)
        assert moves is not None
        here = model.after(moves, here)


def won(story: Scenario) -> bool:
    """Whether it is; what is too large is not looked at."""
    try:
        solve_scenario(story, Rules(), SolveOptions(limits=Limits(states=4000)))
    except PursueError as problem:
        if any(finding.code not in LOST for finding in problem.diagnostics):
            assume(False)
        return False
    return True


@given(stories(small=True))
@settings(max_examples=20)
def test_what_is_won_without_knowing_is_won_by_who_knows(drawn: Tuple[str, Scenario]) -> None:
    """Whatever a state is from the start, a play of who does not know it yet is one of the network."""
    text, story = drawn
    assume("initially unknown" in text)
    assume(not any(isinstance(each, Respond) and "open is_" in each.text for each in story.safety))
    if won(story):
        line = next(line for line in text.splitlines() if "initially unknown" in line)
        known = line.partition(" shown_by")[0].partition(" seen_at")[0]
        sets = ", true_if drop false_if call"
        for value in ("true", "false"):
            name = known.replace("unknown", value).partition(",")[0]
            assert won(parse(text.replace(line, name + sets), "story.pur", "story")), (value, text)


def test_it_is_decided_when_it_is_found_out() -> None:
    network = translate(scenario(SHELF + "reach_objective: do report"))
    fact = network.automaton("empty")
    assert dict(network.variables)["Sempty"] == 2
    found = [(edge.sent, edge.assign, edge.controllable) for edge in fact.edges if edge.sent]
    assert found == [("empty_is_true", (("Sempty", 1),), False), ("empty_is_false", (("Sempty", 0),), False)]
    heard = [(edge.source, edge.received, edge.target) for edge in fact.edges if edge.received]
    shown = ("unknown", "lookDONE", "doing_finding_out")
    assert heard == [shown, ("unknown", "refill", "known"), ("doing_finding_out", "refill", "known")]


def test_it_is_said_in_words() -> None:
    story = scenario(SHELF + "reach_objective: do report")
    network = translate(story)
    words, (true, _) = words_of(story, network), [e for e in network.automaton("empty").edges if e.sent]
    said = [words.place("empty", here) for here in ("unknown", "doing_finding_out", "known")]
    assert said == ["unknown", "being found out", "known"]
    assert words.sentence("empty", true) == "empty is found to be true"
    assert words.texts["Sempty"] == {"0": "false", "1": "true", "2": "unknown"}


def test_a_lost_one_says_what_knowing_it_would_change() -> None:
    search = load(ROOT / "scenarios" / "warehouse" / "hasty_search.pur")
    changes = findings(search, Rules(), Budget(Limits(states=20_000))).changes
    known = [each.sentence for each in changes if each.what == "knowledge"]
    assert known == ["onA known at the start, whatever it is (seen_at desk)"]


def test_a_strategy_has_an_answer_for_both_and_none_without_looking() -> None:
    story = SHELF + "reach_objective: do report within 40"
    assert won(scenario(story))
    assert not won(scenario(story.replace("within 40", "within 20")))
    others = story.replace("can_do look, ", "can_do ") + '\nagent "guest" location shelf can_do look\n'
    assert not won(scenario(others))


def test_a_robot_that_starts_there_sees_it_at_once() -> None:
    story = SHELF.replace("unknown, false_if refill shown_by look", "unknown seen_at dock, false_if refill")
    assert translate(scenario(story + "reach_objective: do report")).automaton("empty").initial == "doing_finding_out"


def test_only_robots_see() -> None:
    story = SHELF.replace("unknown, false_if refill shown_by look", "unknown seen_at shelf")
    story += 'agent "nurse" human controllable mobile 1 location dock\nagent "guest" mobile 1 location dock\n'
    fact = translate(scenario(story + "reach_objective: do look")).automaton("empty")
    assert {edge.sync.channel for edge in fact.edges if edge.source == "unknown" and edge.sync} == {
        "bot_going_dock_to_shelf2shelf"
    }


def test_uppaal_reads_it_back() -> None:
    story = scenario(SHELF + "reach_objective: do report")
    made = translate(story)
    assert read_network(write_network(made, scenario_objective(story)), "x.xml") == made
