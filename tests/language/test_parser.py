"""A text becomes the scenario that its author meant."""

from __future__ import annotations

import re
import string
from pathlib import Path
from typing import List

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from pursue_gen.diagnostics import PursueError, Span, render
from pursue_gen.language import check, load, parse
from pursue_gen.language.kinds import KEYWORDS
from pursue_gen.language.parser import read
from pursue_gen.language.scenario import Avoid, Both, Choice, Connection, NeverWith, Reach, Ref, Respond, Sequence

from .texts import STATEMENTS, text

POI = 'poi "a"\n'


def test_the_sample_of_these_tests_is_sound() -> None:
    assert check(parse(text(), "test.pur")) == ()


def test_every_field_is_read() -> None:
    scenario = parse(text(), "folder/test.pur")
    assert (scenario.name, scenario.file, scenario.text) == ("test", "folder/test.pur", text())
    way = scenario.connections[0]
    ends = (Span("folder/test.pur", 3, 9, 3, 10), Span("folder/test.pur", 3, 15, 3, 16))
    assert way == Connection("a", "b", 3, Span("folder/test.pur", 3, 1, 3, 27), ends)
    work, hand, rest = scenario.events
    assert (work.location.name if work.location else None, work.duration, work.collaborative) == ("b", 3, False)
    assert (hand.location, hand.duration, hand.collaborative) == (None, None, True)
    (state,) = scenario.states
    assert (state.name, state.initially) == ("tired", False)
    assert [ref.name for ref in state.true_if + state.false_if] == ["work", "rest"]
    (need,) = scenario.dependencies
    assert (need.event.name, need.state.name, need.value) == ("hand", "tired", True)
    bot, man = scenario.agents
    assert (bot.controllable, bot.human, bot.mobile, bot.location.name) == (True, False, 2, "a")
    assert bot.is_robot and not man.is_robot and man.mobile is None
    assert [ref.name for ref in man.reacts_to] == ["hand"]
    assert isinstance(scenario.safety[0], Respond) and scenario.safety[0].deadline == 20
    assert isinstance(scenario.reach[0], Reach) and scenario.reach[0].after == 4
    assert rest.name == "rest"


def test_spans_point_at_names_in_the_text() -> None:
    scenario = parse(POI + 'agent "bot" location a', "test.pur")
    assert scenario.agents[0].span == Span("test.pur", 2, 7, 2, 12)
    assert scenario.agents[0].location.span == Span("test.pur", 2, 22, 2, 23)


@pytest.mark.parametrize(
    "source",
    [
        'poi"a"event"e"agent"bot"location a can_do e objective:avoid e',
        '// (: /* "\npoi /* here */ "a" /* two\nlines */\nevent "e" // "x\nagent "bot"\nlocation\na can_do\ne\n'
        "objective :avoid e",
        'poi "a"\r\nevent "e"\r\nagent "bot" location a can_do e\r\nobjective: avoid e\r\n',
        'poi "a" event "e" agent "bot" location a can_do e objective: avoid e control : A[]not(obj.lose)\n',
        'poi "a" event "e" agent "bot" location a can_do e\nobjective: avoid e\n\n control : A[]not(obj.lose)',
    ],
)
def test_layout_comments_and_a_query_behind_the_objective_change_nothing(source: str) -> None:
    scenario = parse(source, "test.pur")
    assert [poi.name for poi in scenario.pois] == ["a"]
    assert [agent.name for agent in scenario.agents] == ["bot"]
    assert isinstance(scenario.safety[0], Avoid)


def test_and_joins_parts_of_a_rule() -> None:
    (rule,) = parse(text(rule='rule "order": (work and rest) before hand'), "test.pur").rules
    assert isinstance(rule.body, Sequence) and isinstance(rule.body.first, Both)
    assert [part.name for part in (rule.body.first.first, rule.body.first.second) if isinstance(part, Ref)] == [
        "work", "rest",
    ]  # fmt: skip


@pytest.mark.parametrize("word", ["before", "or", "and"])
def test_one_word_joins_several_parts_of_a_rule_without_brackets(word: str) -> None:
    def body(words: str) -> str:
        (rule,) = parse(text(rule=f'rule "order": {words}'), "test.pur").rules
        return re.sub(r"Span\([^)]*\)", "", repr(rule.body))

    assert body(f"work {word} rest {word} hand") == body(f"(work {word} rest) {word} hand")
    other = "or" if word == "before" else "before"
    nested = body(f"work {word} ((rest {other} hand) {word} more) {word} less")
    assert nested == body(f"(work {word} ((rest {other} hand) {word} more)) {word} less")


def test_a_rule_of_many_parts_is_read_and_written_without_brackets_within_brackets() -> None:
    events = [f"e{number}" for number in range(500)]
    (rule,) = read(f'rule "order": {" or ".join(events)}', "test.pur").partial.rules
    (again,) = read(rule.text, "test.pur").partial.rules
    assert [ref.name for ref in rule.events] == [ref.name for ref in again.events] == events


def test_a_rule_is_for_all_or_for_each() -> None:
    source = text(rule="""
        rule "one": work before hand
        rule "two" for each robot: work before hand
        rule "three" for each
            agent: work before hand
    """)
    scenario = parse(source, "test.pur")
    assert [rule.each for rule in scenario.rules] == ["", "robot", "agent"]
    bound = [scenario.bound_by(rule) for rule in scenario.rules]
    assert [[agent.name for agent in agents] for agents in bound] == [[], ["bot"], ["bot"]]


def test_each_and_robot_may_be_names() -> None:
    source = 'poi "robot" event "each" agent "bot" controllable location robot can_do each\nagent "man" location robot'
    assert [agent.name for agent in parse(source, "test.pur").agents] == ["bot", "man"]


def test_rules_nest() -> None:
    body = parse('rule "r": ((a or b) or c) before (d or e)', "test.pur").rules[0].body
    assert isinstance(body, Sequence)
    assert isinstance(body.first, Choice) and isinstance(body.first.first, Choice)
    assert isinstance(body.first.second, Ref) and body.first.second.name == "c"
    assert isinstance(body.second, Choice)


@pytest.mark.parametrize(
    ("sets", "true_if", "false_if"),
    [
        ("", [], []),
        (", true_if a, b", ["a", "b"], []),
        (", false_if a", [], ["a"]),
        (", true_if a false_if b", ["a"], ["b"]),
    ],
)
def test_a_state_may_lack_either_list(sets: str, true_if: List[str], false_if: List[str]) -> None:
    (state,) = parse(f'state "s" : initially true{sets}', "test.pur").states
    assert state.initially
    assert ([ref.name for ref in state.true_if], [ref.name for ref in state.false_if]) == (true_if, false_if)


def test_together_is_a_word_behind_collaborative_and_a_name_everywhere_else() -> None:
    source = text(
        event_hand='event "hand" collaborative together location together duration 4',
        event_rest='event "rest" poi "together" connect together and a distance 1',
    )
    hand = next(event for event in parse(source, "test.pur").events if event.name == "hand")
    assert hand.together and hand.is_shared and hand.location is not None and hand.location.name == "together"
    assert not any(event.is_shared for event in parse(text(), "test.pur").events)


def test_one_way_is_a_word_behind_a_distance_and_a_name_everywhere_else() -> None:
    source = text(connect='connect a and b distance 3 one_way poi "one_way" connect b and one_way distance 2')
    there, back = parse(source, "test.pur").connections
    assert (there.directions, back.directions) == ((("a", "b"),), (("b", "one_way"), ("one_way", "b")))


def test_a_window_has_one_number_or_two() -> None:
    one, two = parse('event "a" duration 3 event "b" duration 3 to 5', "test.pur").events
    assert (one.duration, one.latest, one.window) == (3, None, (3, 4))
    assert (two.duration, two.latest, two.window) == (3, 5, (3, 5))


def test_how_often_an_event_can_happen() -> None:
    often, twice = parse('event "a" duration 3 event "b" duration 3 to 5 at_most 2 times', "test.pur").events
    assert (often.at_most, twice.at_most, twice.window) == (None, 2, (3, 5))


@pytest.mark.parametrize("agent", ["bot", '"bot"'])
def test_an_agent_has_its_own_time_for_a_way(agent: str) -> None:
    scenario = parse(text(more=f"travel {agent} from a to b takes 5 to 8"), "test.pur")
    bot, man = scenario.agents
    (travel,) = scenario.travels
    assert (travel.agent.name, travel.way, travel.window) == ("bot", ("a", "b"), (5, 8))
    assert (scenario.movements(bot), scenario.movements(man)) == ({("a", "b"): (5, 8), ("b", "a"): (6, 7)}, {})


def test_words_of_younger_statements_are_names_everywhere_else() -> None:
    """The statement is cut there only where one can begin."""
    source = """
        poi "hall" poi "to" poi "takes"
        connect hall and to distance 1 connect to and takes distance 2
        event "travel" location
            to
        event "walk" event "times"
        rule "r":
            travel before walk
        agent "bot" controllable mobile 1 location hall can_do walk,
            travel
        agent "travel2" mobile 1 location takes can_do times
        travel bot from hall to to takes 3
        objective: if times then
            travel within 20
        reach_objective: do
            travel
    """
    scenario = parse(source, "test.pur")
    assert [ref.name for ref in scenario.agents[0].can_do] == ["walk", "travel"]
    assert scenario.travels[0].way == ("hall", "to") and len(scenario.reach) == 1
    assert check(scenario) == ()


def test_human_is_a_word_before_controllable_and_a_name_everywhere_else() -> None:
    scenario = parse(
        'agent "human" location a agent "nurse" human controllable mobile 3 location a\n'
        "objective: human never_with nurse",
        "test.pur",
    )
    human, nurse = scenario.agents
    assert (human.name, human.human, human.controllable) == ("human", False, False)
    assert (nurse.human, nurse.controllable, nurse.is_robot) == (True, True, False)
    assert isinstance(scenario.safety[0], NeverWith) and scenario.safety[0].first.name == "human"


def test_after_and_within_are_optional() -> None:
    forms = (("", 0, None), (" after 3", 3, None), (" within 9", 0, 9), (" after 3 within 9", 3, 9))
    for words, after, within in forms:
        (reach,) = parse(f"reach_objective: do e{words}", "test.pur").reach
        assert ([ref.name for ref in reach.events], reach.after, reach.within) == (["e"], after, within)


def test_several_things_may_be_to_do() -> None:
    (reach,) = parse("reach_objective: do e and f and together after 3", "test.pur").reach
    assert ([ref.name for ref in reach.events], reach.after) == (["e", "f", "together"], 3)


def test_there_may_be_as_many_objectives_as_wanted_in_any_order() -> None:
    text = "reach_objective: do e\nobjective: avoid f\nreach_objective: do g\nobjective: a never_with b"
    scenario = parse(text, "test.pur")
    assert [safety.span.line for safety in scenario.safety] == [2, 4]
    assert [reach.span.line for reach in scenario.reach] == [1, 3]
    assert scenario.objectives == (*scenario.safety, *scenario.reach)


def test_load_takes_the_name_from_the_file(tmp_path: Path) -> None:
    (tmp_path / "my_floor.pur").write_text("\ufeff" + text(), encoding="utf-8")
    assert load(tmp_path / "my_floor.pur").name == "my_floor"


def test_load_raises_what_check_finds(tmp_path: Path) -> None:
    path = tmp_path / "floor.pur"
    path.write_text(text(agent_bot='agent "bot" controllable mobile 2 location x can_do work, hand'))
    with pytest.raises(PursueError) as caught:
        load(path)
    assert [finding.code for finding in caught.value.diagnostics] == ["PML110"]
    assert caught.value.exit_status == 3


def test_load_lets_warnings_pass(tmp_path: Path) -> None:
    path = tmp_path / "floor.pur"
    path.write_text(text(agent_man='agent "man" human location b can_do rest reacts_to hand'))
    assert [finding.code for finding in check(load(path))] == ["PML180"]


def test_files_that_cannot_be_read_are_reported(tmp_path: Path) -> None:
    (tmp_path / "picture.pur").write_bytes(b"\xff\xd8\xff")
    for path, code in ((tmp_path / "none.pur", "PML001"), (tmp_path, "PML001"), (tmp_path / "picture.pur", "PML002")):
        with pytest.raises(PursueError) as caught:
            load(path)
        assert [finding.code for finding in caught.value.diagnostics] == [code]


WORDS = [*KEYWORDS.values(), "a", "bot", '"a"', '"bot"', '"', "//[1,2,3,0,0,0,1]", "//", "/*", "*/", ",", ":", "(", ")"]
WORDS += ["3", "-1", "0", "99999999999999999999", "control : A<>x", "\n", " ", "²", "é", "\x00", "\u2028"]


def _survives(source: str) -> None:
    """Reading and checking raise nothing but PursueError, and what they find can be shown."""
    reading = read(source, "test.pur")
    assert reading.scenario is not None or reading.diagnostics
    for finding in reading.diagnostics + (check(reading.scenario) if reading.scenario is not None else ()):
        assert finding.message and finding.code.startswith("PML")
        assert render(finding, source)
    try:
        parse(source, "test.pur")
    except PursueError as problem:
        assert problem.diagnostics


@given(st.text())
def test_any_text_is_read_or_reported_what_is_wrong(source: str) -> None:
    _survives(source)


@given(st.lists(st.sampled_from(WORDS), max_size=40).map(" ".join))
def test_any_words_of_the_language_in_any_order_are_read_or_reported(source: str) -> None:
    _survives(source)


@given(st.data())
def test_a_sound_scenario_with_a_slip_is_read_or_reported(data: st.DataObject) -> None:
    source = text()
    start = data.draw(st.integers(0, len(source)))
    end = data.draw(st.integers(start, min(len(source), start + 12)))
    slip = data.draw(st.sampled_from(["", *WORDS]) | st.text(max_size=4))
    _survives(source[:start] + slip + source[end:])


def test_brackets_have_a_depth_that_they_may_not_pass() -> None:
    _survives('rule "r": ' + "(" * 5000 + "a before b" + ")" * 5000)
    _survives("connect a and b distance " + "9" * 5000)


NAMES = st.text(string.ascii_letters + string.digits + "_", min_size=1, max_size=8).map(lambda name: "n" + name)


@given(st.lists(NAMES, min_size=8, max_size=8, unique=True), st.integers(1, 10**6), st.booleans())
@settings(max_examples=50)
def test_names_and_numbers_come_out_as_they_went_in(names: List[str], number: int, controllable: bool) -> None:
    p, q, e, f, rule, state, bot, man = names
    statements = [
        f'poi "{p}"',
        f'poi "{q}"',
        f"connect {p} and {q} distance {number}",
        f'event "{e}" location {q} duration {number}',
        f'event "{f}" collaborative',
        f'rule "{rule}": {e} before {f}',
        f'state "{state}": initially {"true" if controllable else "false"}, true_if {e} false_if {f}',
        f"stateDependency: {e} only_if {state} is_false",
        f'agent "{bot}" {"controllable" if controllable else ""} mobile {number} location {p} can_do {e}, {f}',
        f'agent "{man}" location {p} reacts_to {f}',
        f"objective: if {e} then {f} within {number}",
    ]
    scenario = parse("\n".join(statements), "test.pur")
    assert [poi.name for poi in scenario.pois] == [p, q]
    assert [(way.a, way.b, way.distance) for way in scenario.connections] == [(p, q, number)]
    assert [(event.name, event.duration) for event in scenario.events] == [(e, number), (f, None)]
    assert [rule.name for rule in scenario.rules] == [rule]
    assert [(part.name, part.initially) for part in scenario.states] == [(state, controllable)]
    assert [(agent.name, agent.controllable) for agent in scenario.agents] == [(bot, controllable), (man, False)]
    assert [ref.name for ref in scenario.agents[0].can_do] == [e, f]
    assert isinstance(scenario.safety[0], Respond) and scenario.safety[0].deadline == number


def test_every_statement_of_the_sample_may_stand_alone() -> None:
    for statement in STATEMENTS.values():
        assert read(statement, "test.pur").diagnostics == ()
