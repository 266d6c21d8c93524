"""Things that are carried, as a text: what they are read as, who is bound, what is wrong with them, what is shown."""

from __future__ import annotations

from typing import Dict, List, Tuple

import pytest
from hypothesis import given
from hypothesis import strategies as st

from pursue_gen.language.checks import check_reading
from pursue_gen.language.conditions import condition_text, condition_words
from pursue_gen.language.draft import Draft
from pursue_gen.language.formatter import format_text
from pursue_gen.language.loads import MOST_LOADS, carriers, load_words
from pursue_gen.language.parser import parse, read
from pursue_gen.language.scenario import Scenario
from pursue_gen.language.sentences import speed_words
from pursue_gen.language.writer import scenario_text
from pursue_gen.tga import translate
from pursue_gen.tga.network import Test
from pursue_gen.tools.draw.operations import change
from pursue_gen.tools.draw.view import view
from pursue_gen.tools.lsp.completion import complete
from pursue_gen.tools.lsp.hover import hover

SHOP = """\
poi "store"
poi "shop"
connect store and shop distance 4
thing "box" label "parcel"
thing "bin"
event "load" location store duration 2 takes box
event "unload" location shop gives box at_most 9 times
event "change" location shop takes box gives bin
event "fetch" location store takes bin
agent "cart" controllable mobile 1{cart} location store can_do load, unload, fetch, change
agent "maid" human controllable mobile 1 location store can_do load, unload
agent "thief" mobile 1{thief} location store can_do {does}
reach_objective: do unload
"""


def shop(cart: str = " carries 2", thief: str = "", does: str = "unload") -> str:
    return SHOP.format(cart=cart, thief=thief, does=does)


def scenario(text: str) -> Scenario:
    return parse(text, "shop.pur", "shop")


def found(text: str) -> List[Tuple[str, str]]:
    return [(one.code, one.message) for one in check_reading(read(text, "shop.pur")) if one.code != "PML190"]


def test_it_is_read_and_written() -> None:
    text = shop()
    story = scenario(text)
    load, unload, change_, _ = story.events
    assert load.takes is not None and load.takes.shown == "parcel" and load.gives is None
    assert unload.load_words == "gives parcel" and change_.load_words == "takes parcel, gives bin"
    assert [agent.carries for agent in story.agents] == [2, None, None]
    assert scenario(scenario_text(story)).events[2].text == 'event "change" location shop takes box gives bin'
    assert "carries 2 location store" in scenario_text(story) and format_text(text, "shop.pur").count("takes") == 3
    assert found(text) == []
    assert "PML010" in [code for code, _ in found(shop().replace("takes box gives bin", "gives bin takes box"))]


def test_who_is_not_controlled_is_bound_where_it_is_said() -> None:
    text = shop()
    bound: Dict[str, int] = {one.agent.name: one.room for one in carriers(scenario(text))}
    assert bound == {"cart": 2, "maid": 1}
    more = shop(thief=" carries 3", does="load, unload")
    assert [(one.agent.name, one.room) for one in carriers(scenario(more))][2:] == [("thief", 3)]


def test_loads_and_what_leads_from_one_to_the_next() -> None:
    cart, maid = carriers(scenario(shop()))
    assert cart.things == ("box", "bin") and cart.count == len(cart.loads) == 6
    assert cart.loads == ((0, 0), (1, 0), (0, 1), (2, 0), (1, 1), (0, 2)) and maid.loads == ((0,), (1,))
    after = {event.name: [cart.after(event, load) for load in cart.loads] for event in cart.events}
    assert after["load"] == [(1, 0), (2, 0), (1, 1), None, None, None]
    assert after["unload"] == [None, (0, 0), None, (1, 0), (0, 1), None]
    assert after["change"] == [None, None, (1, 0), None, (2, 0), (1, 1)]


@given(st.integers(1, 9), st.integers(1, 3), st.lists(st.integers(0, 5), max_size=30))
def test_nobody_has_more_than_it_has_room_for_nor_less_than_nothing(room: int, kinds: int, done: List[int]) -> None:
    things = [f"t{k}" for k in range(kinds)]
    lines = ['poi "a"', *(f'thing "{thing}"' for thing in things)]
    lines += [f'event "load_{thing}" takes {thing}\nevent "drop_{thing}" gives {thing}' for thing in things]
    does = ", ".join(f"load_{thing}, drop_{thing}" for thing in things)
    story = scenario("\n".join([*lines, f'agent "bot" controllable carries {room} location a can_do {does}', ""]))
    (carrier,) = carriers(story)
    load, held = carrier.loads[0], [0] * kinds
    for number in done:
        event = carrier.events[number % len(carrier.events)]
        kind, more = divmod(number % len(carrier.events), 2)
        then = carrier.after(event, load)
        held[kind] += -1 if more else 1
        possible = min(held) >= 0 and sum(held) <= room
        assert (then is not None) == possible
        if then is None:
            held[kind] -= -1 if more else 1
        else:
            load = then
        assert load == tuple(held) and load in carrier.loads


WRONG = [
    (shop(" carries 0"), "PML340"),
    (shop(f" carries {MOST_LOADS}"), "PML340"),
    (shop(" carries 2.5"), "PML014"),
    (shop(does="unload", thief=" carries 2"), "PML341"),
    (shop().replace("takes bin", "takes bin gives bin"), "PML342"),
    (shop().replace("can_do load, unload\n", "can_do load\n"), "PML343"),
    (shop().replace("takes bin", "duration 2"), "PML344"),
    (shop(does="ring", thief=" carries 2") + 'event "ring"\n', "PML344"),
    (shop(" carries 11"), "PML345"),
    (shop().replace("takes box", "takes bax", 1), "PML110"),
    (shop().replace("takes box", "takes store", 1), "PML110"),
    (shop().replace('"bin"', '"box"', 1), "PML103"),
    (shop().replace('"bin"', '"cart"', 1), "PML104"),
]


@pytest.mark.parametrize(("text", "code"), WRONG)
def test_what_is_wrong_with_it_is_said(text: str, code: str) -> None:
    assert code in [one for one, _ in found(text)]


def test_who_takes_away_the_things_of_another_one_has_nothing_to_give() -> None:
    text = shop().replace("can_do load, unload\n", "can_do unload\n")
    assert ("PML341", "maid can never do unload: it gives box, and maid does nothing that takes box") in found(text)


NEVER = "cart can never do"


def several(carries: int = 3, taken: int = 2, given: int = 2) -> str:
    text = shop(f" carries {carries}").replace("duration 2 takes box", f"duration 2 takes {taken} box")
    text = text.replace("gives box at_most", f"gives {given} box at_most")
    return text.replace("controllable mobile 1 location", f"controllable mobile 1 carries {carries} location")


def test_several_are_taken_and_given_at_once() -> None:
    story = scenario(several())
    cart = next(carriers(story))
    assert [event.load_words for event in story.events[:2]] == ["takes 2 of parcel", "gives 2 of parcel"]
    assert scenario(scenario_text(story)).events[0].text == 'event "load" location store duration 2 takes 2 box'
    load, unload = cart.events[0], cart.events[1]
    assert [cart.after(load, held) for held in ((0, 0), (1, 0), (2, 0), (0, 1), (0, 2))] == [
        (2, 0), (3, 0), None, (2, 1), None,
    ]  # fmt: skip
    assert [cart.after(unload, held) for held in ((1, 0), (2, 0), (3, 0), (2, 1))] == [None, (0, 0), (1, 0), (0, 1)]


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        (several(), []),
        (several(carries=1, given=1), [("PML341", f"{NEVER} load: it takes 2 of parcel, and cart has room for 1")]),
        (several(given=4), [("PML341", f"{NEVER} unload: it gives 4 of parcel, and cart has room for 3")]),
        (several(taken=0), [("PML340", "load takes 0 things: expected 1 or more")]),
    ],
)
def test_nobody_takes_or_gives_more_than_it_has_room_for(text: str, expected: List[Tuple[str, str]]) -> None:
    said = [each for each in found(text.replace("can_do unload\n", "can_do load, unload\n")) if "maid" not in each[1]]
    assert [each for each in said if "thief" not in each[1]] == expected


def test_words_for_people() -> None:
    story = scenario(shop())
    cart, _ = carriers(story)
    assert [load_words(story, cart, load) for load in ((0, 0), (2, 0), (1, 1))] == [
        "nothing", "2 of parcel", "1 of parcel and 1 of bin",
    ]  # fmt: skip
    assert speed_words(story.agents[0], story).endswith("carries 2")
    draft = Draft.of(shop(), "shop.pur")

    def told(words: str) -> str:
        explained = hover(draft, draft.text.index(words) + len(words) - 1)
        assert explained is not None
        return explained.markdown

    assert "a thing that is carried; people read" in told("takes box") and "- load takes it" in told("takes box")
    assert "- takes parcel" in told('event "load') and "- carries 2 at one time at most" in told('agent "cart')
    assert "people read" in told("gives box") and "So many things" in told("carries")


@pytest.mark.parametrize("words", ["duration 2 takes ", "location shop gives "])
def test_editors_propose_things(words: str) -> None:
    text = shop()
    end = text.index(words) + len(words)
    proposed = [item.label for item in complete(Draft.of(text[:end], "shop.pur"), end)]
    assert proposed[:2] == ["box", "bin"]


def test_the_page_of_draw_shows_and_changes_it() -> None:
    text = shop()
    drawn = view(text)
    assert [(one["takes"], one["gives"]) for one in drawn["events"]][:3] == [("box", ""), ("", "box"), ("box", "bin")]
    assert [one["carries"] for one in drawn["agents"]] == ["2", "", ""] and drawn["names"]["thing"] == ["box", "bin"]
    load, cart = drawn["events"][0]["statement"], drawn["agents"][0]["statement"]
    done = change(text, {"do": "set", "statement": load, "fields": {"takes": "bin"}})
    assert "duration 2 takes bin\n" in done.text
    done = change(text, {"do": "set", "statement": cart, "fields": {"carries": "4"}})
    assert "mobile 1 carries 4 location store" in done.text


def test_things_of_a_group() -> None:
    text = """\
poi "store"
poi "a"
poi "b"
group "rooms": a, b
for each r in rooms: connect store and r distance 4
for each r in rooms: thing "mail" of r
for each r in rooms: event "sort" of r location store takes mail of r
for each r in rooms: event "bring" of r location r gives mail of r
group "mails": mail of rooms
agent "cart" controllable mobile 1 carries 3 location store can_do sort of rooms, bring of rooms
for each r in rooms: reach_objective: do bring of r
"""
    assert found(text) == []
    (cart,) = carriers(scenario(text))
    assert cart.things == ("mail_a", "mail_b") and cart.count == 10


def test_the_words_may_be_names() -> None:
    text = """\
poi "thing"
poi "takes"
connect thing and takes distance 4
thing "gives"
event "carries" location thing takes gives
event "drop" location takes gives gives
agent "things" controllable mobile 1 carries 2 location thing can_do carries, drop
reach_objective: do drop
"""
    assert found(text) == [] and format_text(text, "x.pur").count("takes gives\n") == 1


RACK = """\
poi "rack"
poi "hall"
connect rack and hall distance 4
thing "box"
thing "brush" label "the broom"
thing "mop"
event "takeBrush" location rack duration 3 mounts brush
event "takeMop" location rack mounts mop
event "sweep" location hall duration 5 needs brush
event "load" location rack takes box needs mop
event "scan" location hall needs box
event "unload" location hall gives box
agent "bot" controllable mobile 1 location rack can_do takeBrush, takeMop, sweep, load, scan, unload
reach_objective: do sweep
"""


def test_one_tool_at_a_time_is_mounted_beside_what_is_carried() -> None:
    assert found(RACK) == []
    story = scenario(RACK)
    (bot,) = carriers(story)
    assert (bot.things, bot.tools, bot.count) == (("box",), ("brush", "mop"), 6)
    assert bot.loads == ((0, 0, 0), (1, 0, 0), (0, 1, 0), (1, 1, 0), (0, 0, 1), (1, 0, 1))
    after = {event.name: [bot.after(event, load) for load in bot.loads] for event in bot.events}
    assert after["takeBrush"] == [(0, 1, 0), (1, 1, 0)] * 3 and after["takeMop"] == [(0, 0, 1), (1, 0, 1)] * 3
    assert after["sweep"] == [None, None, (0, 1, 0), (1, 1, 0), None, None]
    assert after["load"] == [None] * 4 + [(1, 0, 1), None]
    assert after["scan"] == [None, (1, 0, 0), None, (1, 1, 0), None, (1, 0, 1)]
    assert load_words(story, bot, (1, 1, 0)) == "1 of box and the broom mounted"
    assert story.events[3].load_words == "takes box, needs mop" and "takes box needs mop" in scenario_text(story)


@pytest.mark.parametrize(
    ("old", "new", "code"),
    [
        ("can_do takeBrush, ", "can_do ", "PML341"),
        ("gives box", "gives mop", "PML341"),
        ("location rack mounts mop", "location rack mounts mop takes mop", "PML010"),
        ("location rack mounts mop", "location rack takes brush", "PML342"),
        (" needs mop", "", ""),
        ("mounts mop", "", "PML341"),
        ("needs brush", "needs broom", "PML110"),
    ],
)
def test_what_is_wrong_with_tools_is_said(old: str, new: str, code: str) -> None:
    assert code in ["", *(one for one, _ in found(RACK.replace(old, new, 1)))]


def test_the_page_of_draw_changes_tools() -> None:
    drawn = view(RACK)
    assert [(one["mounts"], one["needs"]) for one in drawn["events"]][:3] == [("brush", ""), ("mop", ""), ("", "brush")]
    sweep = drawn["events"][2]["statement"]
    assert "duration 5 needs mop\n" in change(RACK, {"do": "set", "statement": sweep, "fields": {"needs": "mop"}}).text
    assert "duration 5\n" in change(RACK, {"do": "set", "statement": sweep, "fields": {"needs": ""}}).text


def test_what_is_there_at_the_start() -> None:
    text = RACK.replace("mobile 1 location", "mobile 1 carries 3 has box, brush, box location")
    assert found(text) == []
    story = scenario(text)
    (bot,) = carriers(story)
    assert (bot.first, bot.held, bot.room) == ((2, 1, 0), 2, 3)
    assert dict(translate(story).variables)["Hbot"] == bot.loads.index((2, 1, 0)) > 0
    assert speed_words(story.agents[0], story).endswith("carries 3, has box, the broom and box")
    assert "carries 3 has box, brush, box location rack" in scenario_text(story)
    assert view(text)["agents"][0]["has"] == "box, brush, box"
    fields = {"has": "mop", "carries": ""}
    assert "mobile 1 has mop location" in change(text, {"do": "set", "statement": 12, "fields": fields}).text


@pytest.mark.parametrize(
    ("has", "code"),
    [
        ("has box, box", "PML340"),
        ("carries 2 has box, box, box", "PML340"),
        ("has mop, brush", "PML340"),
        ("has sponge", "PML110"),
        ("has", "PML010"),
    ],
)
def test_what_cannot_be_there_at_the_start(has: str, code: str) -> None:
    assert code in [one for one, _ in found(RACK.replace("mobile 1 location", f"mobile 1 {has} location"))]


def test_who_has_something_may_give_it_without_ever_taking_it() -> None:
    text = shop(thief=" carries 1 has box", does="unload")
    assert found(text) == []
    assert [one.first for one in carriers(scenario(text))] == [(0, 0), (0,), (1,)]
    text = shop(thief=" has box", does="ring") + 'event "ring"\n'
    assert ("PML344", "thief has box, but does nothing that takes a thing") in found(text)


CARE = RACK.replace("distance 4", "distance 4{way}").replace("reach", "{more}reach")


def care(way: str = "", more: str = "") -> str:
    return CARE.format(way=way, more=more)


@pytest.mark.parametrize(
    ("condition", "words"),
    [
        ("bot has box", "bot has box"),
        ("not bot has brush", "bot does not have the broom"),
        ("no robot has box", "no robot has box"),
        ("any robot has mop", "any robot has mop"),
        ("bot has box or bot has mop", "bot has box or bot has mop"),
    ],
)
def test_what_somebody_has_is_a_condition(condition: str, words: str) -> None:
    text = care(f" only_if {condition}", f"objective: avoid ({condition}) and bot on_way\n")
    assert found(text) == []
    story = scenario(text)
    way, (avoid,) = story.connections[0].only_if, story.safety
    assert way is not None and condition_words(way) == words and condition_text(way) == condition
    assert f"only_if {condition}" in scenario_text(story) and condition.split(" or ")[0] in avoid.text
    assert "Hbot" in {test.variable for test in loads_tested(story)}


def loads_tested(story: Scenario) -> List[Test]:
    edges = [edge for edge in translate(story).automaton("bot").edges if edge.sets_off]
    return [test for edge in edges for clause in edge.guard.integers for test in clause]


def test_a_way_is_closed_to_whoever_carries_something() -> None:
    loads = {test.value for test in loads_tested(scenario(care(" only_if not bot has box")))}
    assert loads == {0, 2, 4}  # nothing, the brush, the mop
    assert loads_tested(scenario(care(" only_if bot has box or not bot has box"))) == []


@pytest.mark.parametrize(
    ("more", "code"),
    [
        ("objective: avoid bot has sponge\n", "PML110"),
        ("objective: avoid guest has box\n", "PML231"),
        ("objective: if bot has box then bot at hall within 9\n", "PML262"),
        ("objective: if sweep then bot has box within 9\n", "PML262"),
        ("assume: not guest has box\n", "PML263"),
        ("objective: avoid bot has\n", "PML010"),
    ],
)
def test_where_it_cannot_be_a_condition(more: str, code: str) -> None:
    guest = 'agent "guest" mobile 1 location hall\n'
    assert code in [one for one, _ in found(care(more=guest + more))]


def test_one_of_a_group_has_one_of_a_group() -> None:
    text = care(more='group "tools": brush, mop\ngroup "bots": bot\nobjective: avoid any of bots has any of tools\n')
    (avoid,) = scenario(text).safety
    assert found(text) == [] and avoid.text == "avoid bot has brush or bot has mop"


def test_editors_know_it() -> None:
    text = care(more="objective: avoid bot has ").partition("reach")[0]
    assert [item.label for item in complete(Draft.of(text, "x.pur"), len(text))][:3] == ["box", "brush", "mop"]
    draft = Draft.of(care(more="objective: avoid bot has box\n"), "x.pur")
    at = draft.text.index("has box") + 5
    assert draft.occurrence_at(at) is not None and "is carried" in getattr(hover(draft, at), "markdown", "")


@pytest.mark.parametrize(
    "has", ["carries 1000000", "carries 99", "has mop, brush", "carries 0", "carries 2 has box, box, box"]
)
def test_conditions_on_loads_that_cannot_be_meant_are_not_looked_at(has: str) -> None:
    text = care(" only_if not bot has box", "assume: not guest at hall\nobjective: always not bot has mop\n")
    text = text.replace("mobile 1 location", f"mobile 1 {has} location") + 'agent "guest" mobile 1 location rack\n'
    assert {code for code, _ in found(text)} & {"PML340", "PML345"}
    assert "PML231" not in [code for code, _ in found(text)]
