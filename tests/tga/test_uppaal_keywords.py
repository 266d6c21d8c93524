"""Names that are words of UPPAAL: its files have other names in their place, and plans are read with both."""

from __future__ import annotations

import re

from hypothesis import given

from pursue_gen.language import check
from pursue_gen.solving.rules import DEFAULT
from pursue_gen.solving.solution import solve_scenario
from pursue_gen.synthesis.plan import read_plan, write_plan
from pursue_gen.tga import scenario_objective, translate
from pursue_gen.tga.network import Network
from pursue_gen.tga.uppaal import read_network, write_network
from pursue_gen.tga.uppaal_write import WORDS, renamed, uppaal_names
from tests.tga.networks import networks, scenario

TEXT = """
poi "clock" poi "guard_" poi "state2"
connect clock and guard_ distance 2
connect guard_ and state2 distance 1
event "process" location guard_ duration 2
event "select"
rule "system": process before select
state "init": initially false, true_if process
stateDependency: select only_if init is_true
agent "guard" controllable mobile 1 location clock can_do process, select
agent "broadcast" mobile 3 location state2
reach_objective: do select
"""


def test_words_of_uppaal_are_names_of_the_language() -> None:
    assert check(scenario(TEXT)) == ()
    names = uppaal_names(translate(scenario(TEXT)))
    assert names == {
        "broadcast": "broadcast_", "clock": "clock_", "guard": "guard__", "process": "process_", "select": "select_",
        "system": "system_",
    }  # fmt: skip


def test_a_file_of_uppaal_has_other_names_and_is_read_as_it_is() -> None:
    read = scenario(TEXT)
    network = translate(read)
    text = write_network(network, scenario_objective(read))
    other = read_network(text, "TGA.xml")
    assert other == renamed(network, uppaal_names(network))
    assert not uppaal_names(other) and "<name>guard__</name>" in text
    labels = re.findall(r"<(?:label|name|formula)[^>]*>([^<]*)<", text)
    assert not WORDS & {word for label in labels for word in re.findall(r"\w+", label)}


def test_a_plan_is_read_with_the_names_of_either() -> None:
    read = scenario(TEXT)
    won = solve_scenario(read, DEFAULT)
    plan = write_plan(won.strategy, won.network, won.objective)
    assert read_plan(plan, won.network, "plan") == won.strategy
    theirs = plan
    for word, new in uppaal_names(won.network).items():
        theirs = re.sub(rf"\b{word}\b", new, theirs)
    assert "guard__.clock_" in theirs and "guard.clock" not in theirs
    assert read_plan(theirs, won.network, "plan") == won.strategy


@given(networks())
def test_other_names_and_back_again_is_the_network(network: Network) -> None:
    names = {network.automata[0].name: "clock", network.channels[0]: "guard", network.automata[0].initial: "process"}
    strange = renamed(network, names)
    back = uppaal_names(strange)
    assert set(back) == set(names.values())
    plain = renamed(strange, back)
    assert not uppaal_names(plain)
    assert renamed(plain, {new: word for word, new in back.items()}) == strange
