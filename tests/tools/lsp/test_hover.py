"""What is told about what one points at."""

from __future__ import annotations

import pytest

from pursue_gen.language.draft import Draft
from pursue_gen.tools.lsp.hover import hover

from .scenarios import SMALL, marked

SMALL_WITH_MORE = SMALL.replace('"man" location', '"man" mobile 5 location')


def told(before: str, text: str = SMALL) -> str:
    found = hover(Draft.of(text, "x.pur"), text.index(before) + len(before))
    return "" if found is None else found.markdown


@pytest.mark.parametrize(
    ("before", "words"),
    [
        ('poi "', ["to b: distance 3", "bot 6 to 7 units of time", "starts here: bot"]),
        ("location ", ["happens here: work", "starts here: man"]),
        ('event "wo', ["at b", "takes 3 to 4 units of time", "done by bot", "its turn comes first in each round"]),
        ('event "wo', ["makes tired true", "must be answered by hand within 20 units of time"]),
        ('event "ha', ["wherever", "takes no time", "takes two", "partner is man", "its turn comes after work"]),
        ('event "ha', ["only while tired is true", "to be achieved once, later than 4 units"]),
        ('rule "', ["work, then hand", "only when it is their turn"]),
        ('state "', ["false at the start", "made true by work", "made false by rest", "hand can happen only while"]),
        ('agent "b', ["a robot", "starts at a", "2 units of time for a unit of distance", "a to b: 6 to 7 units"]),
        ('agent "m', ["nobody controls it", "stays there", "reacts to: hand"]),
        ("distance ", ["3 units of distance", "bot needs 6 to 7"]),
        ("duration ", ["3 to 4 units"]),
        ("mobile ", ["2 units of time for a unit of distance", "a to b: 6 to 7"]),
        ("within ", ["20 units of time later at most"]),
        ("do hand after ", ["later than 4 units"]),
        ("colla", ["takes two at one place", "reacts to it"]),
        ("conn", ["A way between two places", "connect a and b distance 3"]),
    ],
)
def test_plain_words(before: str, words: "list[str]") -> None:
    for word in words:
        assert word in told(before)


def test_in_which_direction_a_way_goes() -> None:
    one_way = SMALL.replace("distance 3", "distance 3 one_way")
    assert "to b: distance 3" in told('poi "', one_way)
    assert "from a only: distance 3" in told('poi "a"\npoi "', one_way)
    assert "to the second only" in told("one_w", one_way)


def test_how_often_an_event_can_happen() -> None:
    rare = SMALL.replace('event "rest"', 'event "rest" at_most 2 times')
    assert "happens at most 2 times" in told('event "re', rare) and "2 times in all" in told("at_most ", rare)


def test_what_a_rule_with_and_says() -> None:
    both = SMALL.replace('"order": work before hand', '"order": (work and rest) before hand')
    assert "(work and rest, in any order), then hand" in told('rule "', both)
    assert "its turn comes after work and rest" in told('event "ha', both)


def test_who_has_its_own_turn_in_a_rule() -> None:
    each = SMALL.replace('rule "order":', 'rule "order" for each robot:')
    assert "each of these has its own turn: bot" in told('rule "', each)
    assert "own turn" in told("for ea", each) and "controllable and not human" in told("each ro", each)


def test_a_robot_says_how_large_it_is() -> None:
    more = SMALL + 'agent "big" controllable radius 0.4 inflation 0.55 location a\n'
    assert "radius 0.4 m, inflation radius 0.55 m on a map" in told('agent "bi', more)
    assert "avoid" in told('agent "big" controllable radius 0.4 infl', more)


def test_a_battery_says_how_many_levels_it_has() -> None:
    more = SMALL + "battery bot capacity 9 uses 1 per unit\n"
    assert "levels; the game has up to" in told("battery bot capacity 9", more)
    assert "What the battery holds" in told("battery bot capa", more) and "a robot" in told("battery b", more)
    assert "battery of 9, uses 1 per unit" in told("battery b", more)


@pytest.mark.parametrize(
    ("says", "words"),
    [
        ("does rest every 20 to 30", "It has happened 30 units of time after the start, or after the last time."),
        ("stays 20 to 30", "It has set off 30 units of time after it came, or after the start."),
    ],
)
def test_the_second_of_two_numbers_is_told_by_the_assumption_that_has_it(says: str, words: str) -> None:
    text = f"{SMALL_WITH_MORE}assume: man {says}\n"
    found = hover(Draft.of(text, "x.pur"), text.rindex("30"))
    assert found is not None and found.markdown == words


def test_a_number_behind_optional_says_what_is_given_up_first() -> None:
    assert "the one with the greatest number" in told("optional 1", SMALL + "optional 1 objective: avoid hand\n")


def test_windows_and_travel_times() -> None:
    more = SMALL.replace("duration 3", "duration 3 to 5") + "travel bot from a to b takes 5 to 8\n"
    assert "takes 3 to 5 units of time" in told('event "wo', more)
    assert "3 to 5 units" in told("duration ", more) and "3 to 5 units" in told("duration 3 to ", more)
    assert "5 to 8 units" in told("takes ", more) and "5 to 8 units" in told("takes 5 to ", more)
    assert "a to b: 5 to 8 units" in told('agent "b', more) and "bot 5 to 8 units" in told('poi "', more)
    assert "Where the agent sets off." in told("travel bot fr", more)
    assert "a robot" in told("travel b", more) and "a place" in told("from ", more)


def test_how_many_things_are_no_time() -> None:
    more = SMALL.replace("duration 3", "duration 3 takes 2 box at_most 4 times") + 'thing "box"\n'
    assert "3 to 4 units" in told("duration ", more) and "So many at one time: 2" in told("takes ", more)
    assert "work takes 2 of it" in told("takes 2 b", more)


def test_when_events_and_ways_are_open() -> None:
    limited = SMALL.replace('event "work" location b duration 3', 'event "work" location b duration 3 only_if man at b')
    limited = limited.replace("distance 3", "distance 3 only_if no robot on_way and tired is_false")
    assert "only while man is at b" in told('event "wo', limited)
    open_while = "only while no robot is on its way and tired is false"
    assert f"to b: distance 3 (bot 6 to 7 units of time), {open_while}" in told('poi "', limited)
    assert f"between a and b {open_while}" in told('state "', limited)
    assert "**man**: nobody controls it" in told("only_if m", limited)
    assert "**b**: a place" in told("man at ", limited)
    assert "the agent stands there" in told("only_if man a", limited)


def test_what_must_never_be() -> None:
    safe = SMALL.replace("if work then hand within 20", "always man at b or tired is_false")
    assert "must never be: not (man is at b or tired is false)" in told('agent "m', safe)
    assert "must never be: not (man is at b or tired is false)" in told('state "', safe)
    apart = SMALL.replace("if work then hand within 20", "bot never_with man at a")
    assert "must never be at a while man is there" in told('agent "b', apart)


def test_for_how_many_there_is_room() -> None:
    room = SMALL.replace("if work then hand within 20", "place b holds 2 agents")
    assert "- holds 2 agents" in told("place ", room)
    assert "No more than 2 at one time." in told("holds ", room)
    way = SMALL.replace("if work then hand within 20", "way a to b holds 1 robot")
    assert "- the way to b holds 1 robot, in both directions together" in told("way ", way)
    few = SMALL.replace("if work then hand within 20", "avoid at_most 1 of bot, man between a and b")
    assert "No more than 1 at one time." in told("at_most ", few)
    assert "**man**" in told("of bot, ", few) and "**a**: a place" in told("between ", few)
    assert "**b**: a place" in told("between a and ", few)


def test_who_is_busy_while_an_event_of_two_lasts() -> None:
    lasting = SMALL.replace('"hand" collaborative', '"hand" collaborative duration 2')
    assert "the partner may leave as soon as it has begun" in told('event "ha', lasting)
    together = lasting.replace("collaborative", "collaborative together")
    assert "both are busy until it ends" in told('event "ha', together)
    assert "busy until it ends" in told("toge", together)


def test_everybody_who_moves_is_named_at_a_distance() -> None:
    assert told("distance ", SMALL_WITH_MORE).endswith(
        "- bot needs 6 to 7 units of time\n- man needs 15 to 16 units of time"
    )


def test_a_nested_rule_reads_from_left_to_right() -> None:
    text = 'rule "r": ((a before b) before (c or d)) before e'
    assert "- a, then b, then (c or d), then e" in told('rule "', text)


def test_a_place_tells_where_robots_stand() -> None:
    pose = "[1, 2, 0, 0, 0, 0, 1]"
    text = SMALL.replace('poi "a"', f'poi "a" //{pose} bot [1, 2.5, 0, 0, 0, 0, 1]')
    assert "- on the robot's map at x = 1 m, y = 2 m\n- bot stands at x = 1 m, y = 2.5 m" in told('poi "', text)
    assert "**bot**: a robot" in told(f"//{pose} bo", text)


def test_an_unknown_name_is_reported_as_that() -> None:
    assert told("do ", 'poi "a"\nreach_objective: do nothing') == "There is no event `nothing`."


def test_broken_statements_do_not_hide_the_others() -> None:
    assert "starts here: bot" in told('poi "', SMALL + "agent agent agent\n")


@pytest.mark.parametrize("text", ["// po|i", 'poi "a"\n\n|\n\npoi "b"', "|", 'rule "r"|: a before b'])
def test_where_there_is_nothing_to_tell(text: str) -> None:
    plain, at = marked(text)
    assert hover(Draft.of(plain, "x.pur"), at) is None


def test_times_have_their_units_where_the_scenario_says_what_one_is() -> None:
    timed = "unit second\n" + SMALL.replace("within 20", "within 2 min").replace("duration 3", "duration 90")
    assert "The answer must have come 2 min later at most." in told("within 2", timed)
    assert "It takes 90 s to 91 s." in told("duration ", timed)
    assert "1 min 30 s" not in told("duration ", timed)
    assert "It needs 2 s for a unit of distance" in told("mobile ", timed)
    assert "must be answered by hand within 2 min" in told('event "wo', timed)
    assert "A way of 3 units of distance." in told("distance ", timed)
    assert "bot 6 s to 7 s" in told('poi "', timed)
    fast = timed.replace("mobile 2", "speed 0.5")
    assert "It moves 0.5 metres in a second." in told("speed ", fast) and "- a to b: 6 s to 7 s" in told("speed ", fast)
    assert "A way of 3 m." in told("distance ", fast) and "moves 0.5 metres in a second" in told('agent "b', fast)
    assert told("within 2", timed.replace("unit second\n", "")) == ""


def test_a_door_and_the_ways_through_it() -> None:
    door = 'door "d1" label "glass door" opens within 8\n' + SMALL.replace("distance 3", "distance 3 through d1")
    assert "to b: distance 3 (bot 6 to 15 units of time), through glass door" in told('poi "', door)
    assert "a door that opens by itself" in told('door "', door) and "between a and b" in told("through d", door)
    assert "takes up to 8 units of time longer" in told("opens within ", door)
