"""Escorts: read, told, written again, what is wrong with them, and that they are answers to conditions."""

from __future__ import annotations

from typing import List

import pytest
from hypothesis import given
from hypothesis import strategies as st

from pursue_gen.language import check, parse
from pursue_gen.language.checks import check_reading
from pursue_gen.language.draft import Draft
from pursue_gen.language.formatter import format_text
from pursue_gen.language.parser import read
from pursue_gen.language.scenario import Escort, NeverWith, Respond
from pursue_gen.language.writer import scenario_text
from pursue_gen.tga import scenario_objective, translate
from pursue_gen.tga.uppaal import read_network, write_network
from pursue_gen.tools.lsp.completion import complete
from pursue_gen.tools.lsp.hover import hover

MUSEUM = """\
poi "hall"
poi "gallery" label "the gallery"
poi "vault"
connect hall and gallery distance 3
connect gallery and vault distance 3
event "look" location vault
group "rooms": gallery, vault
agent "bot1" label "the guard" controllable mobile 1 location hall
agent "bot2" controllable mobile 1 location vault
agent "visitor" mobile 2 location gallery can_do look
"""


@pytest.mark.parametrize(
    ("words", "told", "broken"),
    [
        (
            "escort visitor at gallery within 5 by bot1",
            "Whenever visitor is at the gallery without the guard, the guard is there within 5 units",
            "visitor has been at the gallery without the guard for 5",
        ),
        (
            "escort visitor at vault within 2.5 by any robot",
            "Whenever visitor is at vault without any robot, any robot is there within 2.5 units",
            "visitor has been at vault without any robot for 2.5",
        ),
    ],
)
def test_each_form_is_read_and_told(words: str, told: str, broken: str) -> None:
    scenario = parse(MUSEUM + f"objective: {words}\n", "x.pur")
    (safety,) = scenario.safety
    assert isinstance(safety, Escort) and safety.text == words
    assert told in safety.sentence(scenario.shown) and broken in safety.broken(str)
    assert list(check(scenario)) == []
    assert f"objective: {words}\n" in scenario_text(scenario)
    assert f"objective: {words}\n" in format_text(scenario.text, "x.pur")


def test_several_places_are_one_statement() -> None:
    scenario = parse(MUSEUM + "objective: escort visitor at rooms within 5 by bot1\n", "x.pur")
    assert [each.text for each in scenario.safety] == [
        f"escort visitor at {place} within 5 by bot1" for place in ("gallery", "vault")
    ]
    whole = scenario.safety[0].statement(scenario.objectives)
    assert whole.text == "escort visitor at gallery, vault within 5 by bot1" and len(whole.objectives) == 2


@given(
    st.sampled_from(("gallery", "vault")), st.integers(1, 20), st.sampled_from(("bot1", "bot2", "any robot", "visitor"))
)
def test_it_is_an_answer_to_her_being_alone(place: str, time: int, who: str) -> None:
    ward = "bot2" if who == "visitor" else "visitor"
    alone = f"{ward} at {place} and not {who} at {place}"
    texts = (f"escort {ward} at {place} within {time} by {who}", f"if {alone} then not ({alone}) within {time}")
    escort, answer = (parse(MUSEUM + f"objective: {text}\n", "x.pur") for text in texts)
    assert isinstance(answer.safety[0], Respond) and translate(escort) == translate(answer)
    made = translate(escort)
    assert read_network(write_network(made, scenario_objective(escort)), "x.xml") == made


def test_its_words_may_be_names() -> None:
    text = """\
poi "a" poi "escort"
connect a and escort distance 1
agent "bot" controllable mobile 1 location a
agent "by" mobile 1 location escort
objective: escort by at escort within 9 by bot
objective: bot never_with by
"""
    escort, apart = parse(text, "x.pur").safety
    assert escort.text == "escort by at escort within 9 by bot" and isinstance(apart, NeverWith)
    as_agent = 'poi "a" agent "escort" location a agent "b" location a objective: escort never_with b'
    assert isinstance(parse(as_agent, "x.pur").safety[0], NeverWith)


@pytest.mark.parametrize(
    ("objective", "code", "says"),
    [
        ("escort visitor at gallery within 0 by bot1", "PML143", "leaves no time to come"),
        ("escort visitor at gallery within 5 by visitor", "PML173", "always with itself"),
        ("escort visitor at gallery within 5 by bot3", "PML110", "no agent bot3"),
        ("escort visitor at shop within 5 by bot1", "PML110", "no POI shop"),
        ("escort visitor at gallery by bot1", "PML010", "expected `within` after `gallery`"),
        ("escort visitor within 5 by bot1", "PML010", "expected `at` after `visitor`"),
        ("escort visitor at gallery, gallery within 5 by bot1", "PML220", "twice"),
    ],
)
def test_what_is_wrong_with_it(objective: str, code: str, says: str) -> None:
    findings = check_reading(read(MUSEUM + f"objective: {objective}\n", "x.pur", "x"))
    found = [finding for finding in findings if finding.code == code]
    assert found and says in found[0].message and found[0].hint and found[0].span and found[0].span.line == 11


def test_who_is_never_there_is_reported() -> None:
    closed = MUSEUM.replace('poi "vault"', 'poi "vault" except bot1')
    found = check(parse(closed + "objective: escort visitor at vault within 5 by bot1\n", "x.pur"))
    assert [finding.code for finding in found] == ["PML230"] and "the guard" not in found[0].message


def labels(text: str) -> List[str]:
    return [each.label for each in complete(Draft.of(text.replace("|", ""), "x"), text.index("|"))]


def test_editors_complete_and_explain_it() -> None:
    assert "escort" in labels(MUSEUM + "objective: |") and "visitor" in labels(MUSEUM + "objective: escort |")
    assert {"gallery", "vault", "rooms"} <= {*labels(MUSEUM + "objective: escort visitor at |")}
    assert {"any", "bot1"} <= {*labels(MUSEUM + "objective: escort visitor at vault within 5 by |")}
    text = MUSEUM + "objective: escort visitor at vault within 5 by bot1\n"
    number, agent = (hover(Draft.of(text, "x"), text.index(word)) for word in ("5 by", "visitor at vault"))
    assert number is not None and "5 units of time later" in number.markdown
    assert agent is not None and "is escorted at vault by bot1 within 5 units of time" in agent.markdown
