"""What rules, counts, own turns, states, assumptions and objectives are at can be said in words."""

from __future__ import annotations

from typing import Dict

from pursue_gen.language import parse
from pursue_gen.tga import translate
from pursue_gen.vocabulary.statuses import statuses

TEXT = """
poi "a"
poi "b"
connect a and b distance 2
event "load" location a duration 3
event "unload" location b
event "call" at_most 2 times
event "stamp" location a
event "seal" location b
rule "bag" for each robot: load before unload
rule "papers": stamp before seal
state "open": initially false, true_if stamp false_if seal
agent "bot" controllable mobile 1 location a can_do load, unload, stamp, seal
agent "guest" mobile 1 location b can_do call
assume: guest does call at_most 1 times
assume: guest leaves b within 30
objective: if call then unload within 40
objective: patrol a every 50 by bot
objective: patrol b every 50 by any robot
objective: avoid bot at b and guest at b
reach_objective: do seal and unload after 5 within 60
"""


def shown(text: str = TEXT) -> Dict[str, Dict[str, str]]:
    """label → texts"""
    scenario = parse(text, "x.pur", "x")
    network = translate(scenario)
    found = statuses(scenario, network)
    places = {each.name: {place.name for place in each.locations} for each in network.automata}
    names = {name for name, _ in network.variables}
    for each in found:
        assert each.of in names or set(each.texts) == places[each.of], "a text for each location, and for no other"
    assert len({each.label for each in found}) == len(found)
    return {each.label: dict(each.texts) for each in found}


def test_a_count_is_how_often_of_how_many_times() -> None:
    assert list(shown()["call"].values()) == ["0 of 2 times", "1 of 2 times", "2 of 2 times"]


def test_the_turn_of_an_agent_with_a_label_has_its_label() -> None:
    words = shown(TEXT.replace('agent "bot"', 'agent "bot" label "Porter 1"'))
    assert "bag of Porter 1" in words and "bag of bot" not in words


def test_a_turn_is_what_is_next_or_goes_on() -> None:
    words = shown()
    assert list(words["papers"].values()) == ["next: stamp", "next: seal"]
    assert sorted(words["bag of bot"].values()) == ["load goes on", "next: load", "next: unload"]
    assert set(words["bag of bot"]) == {"0", "1", "2"}


def test_states_and_assumptions_hold_or_do_not() -> None:
    words = shown()
    assert words["open"] == {"0": "false", "1": "true"}
    assert words["guest does call at most once"] == {"1": "assumed", "0": "broken: not assumed any more"}
    assert words["call by guest"] == {"0": "0 of 1 times", "1": "1 of 1 times"}
    assert words["guest leaves b within 30 units"]["0"].startswith("broken")


def test_an_objective_is_kept_due_reached_or_broken() -> None:
    words = shown()
    assert words["if call then unload within 40"] == {
        "idle": "nothing is due", "atRisk": "unload is due", "lose": "broken"
    }  # fmt: skip
    assert words["patrol a every 50 by bot"] == {"idle": "bot is there", "atRisk": "a visit is due", "lose": "broken"}
    assert words["patrol b every 50 by any robot"]["idle"] == "a robot is there"
    assert words["avoid bot at b and guest at b"] == {"idle": "kept", "lose": "broken"}
    reach = set(words["do seal and unload after 5 within 60"].values())
    assert reach == {
        "not counting yet", "seal and unload to be done", "seal done", "unload done", "reached", "too late"
    }  # fmt: skip


def test_a_patrol_in_order_says_whose_turn_it_is() -> None:
    text = '''poi "a" label "gate A" poi "b" connect a and b distance 1 agent "bot" controllable mobile 1 location a
objective: patrol a, b in order every 9 by bot'''
    story = parse(text, "x.pur", "x")
    words = {each.label: dict(each.texts) for each in statuses(story, translate(story))}
    patrol = "patrol a, b in order every 9 by bot"
    assert words[patrol] == {"0": "next: gate A", "1": "next: b"}
    assert words[f"{patrol}: b"]["atRisk"] == "a visit is due"
