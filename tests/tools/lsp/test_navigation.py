"""Where names are declared and used, and how they are changed."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from pursue_gen.diagnostics import PursueError
from pursue_gen.language import check, parse
from pursue_gen.language.document import edited
from pursue_gen.language.draft import Draft, definition, rename, same_name

from .scenarios import SCENARIOS, SMALL


def at(text: str, before: str) -> int:
    return text.index(before) + len(before)


def test_a_use_leads_to_the_declaration() -> None:
    document = Draft.of(SMALL, "x.pur")
    (place,) = definition(document, at(SMALL, "if work then ha"))
    assert SMALL[place.start - 7 : place.end + 1] == 'event "hand"'
    assert definition(document, at(SMALL, "can_d")) == ()


def test_all_uses_are_found() -> None:
    document = Draft.of(SMALL, "x.pur")
    places = same_name(document, at(SMALL, 'event "wo'))
    assert [SMALL[p.start : p.end] for p in places] == ["work"] * 5
    assert [p.declares for p in places] == [True, False, False, False, False]


def test_a_name_of_two_kinds_is_distinguished() -> None:
    text = 'poi "x"\nevent "x" location x\nagent "b" location x can_do x\n'
    document = Draft.of(text, "x.pur")
    assert [p.start for p in same_name(document, at(text, 'event "'))] == [15, at(text, "can_do ")]


def test_a_use_as_the_wrong_kind_still_leads_to_the_declaration() -> None:
    text = 'event "e"\nagent "b" location e\n'
    (place,) = definition(Draft.of(text, "x.pur"), at(text, "location "))
    assert place.kind == "event"


def test_renaming_changes_every_occurrence_and_nothing_else() -> None:
    text = SMALL + "// hand in hand with handy\n"
    document = Draft.of(text, "x.pur")
    renamed = edited(text, rename(document, at(text, "within 20\nreach_objective: do ha"), "give"))
    assert "// hand in hand with handy" in renamed
    assert 'event "give" collaborative' in renamed and "then give within" in renamed
    assert "hand" not in renamed.replace("// hand in hand with handy", "")
    assert not check(parse(renamed, "x.pur"))


def test_renaming_a_robot_changes_its_poses() -> None:
    pose = "[1, 2, 0, 0, 0, 0, 1]"
    text = SMALL.replace('poi "a"', f'poi "a" //{pose} man {pose} bot {pose}, not bot')
    document = Draft.of(text, "x.pur")
    (declared,) = definition(document, at(text, f"man {pose} bo"))
    assert text[declared.start - 7 : declared.end + 1] == 'agent "bot"'
    renamed = edited(text, rename(document, at(text, 'agent "bo'), "cart"))
    assert f"man {pose} cart {pose}, not bot\n" in renamed and 'agent "cart"' in renamed


@pytest.mark.parametrize(
    ("new", "reason"),
    [
        ("", "cannot become"),
        ("two words", "cannot become"),
        ('qu"ote', "cannot become"),
        ("line\nbreak", "cannot become"),
        ("3rd", "cannot become"),
        ("event", "word of the language"),
        ("while", "word of Python"),
        ("observer", "generated"),
        ("workDONE", "DONE"),
        ("bot", "line 10 declares an agent of this name"),
        ("a", "line 1 declares a POI"),
        ("x" * 100, "longer"),
        ("Cbot", "would mean both"),
    ],
)
def test_a_name_that_cannot_be_is_refused_with_the_reason(new: str, reason: str) -> None:
    document = Draft.of(SMALL, "x.pur")
    with pytest.raises(PursueError) as refused:
        rename(document, at(SMALL, 'event "re'), new)
    assert reason in refused.value.diagnostics[0].message


def test_where_there_is_no_name_nothing_is_renamed() -> None:
    with pytest.raises(PursueError) as refused:
        rename(Draft.of(SMALL, "x.pur"), 2, "new")
    assert refused.value.diagnostics[0].code == "LSP001"


def test_the_same_name_changes_nothing() -> None:
    assert rename(Draft.of(SMALL, "x.pur"), at(SMALL, 'poi "'), "a") == ()


def test_renaming_works_beside_a_broken_statement() -> None:
    text = SMALL + "connect a and\n"
    renamed = edited(text, rename(Draft.of(text, "x.pur"), at(text, 'poi "'), "door"))
    assert renamed.endswith("connect door and\n")
    assert "location door" in renamed


@given(st.sampled_from(sorted(SCENARIOS)), st.data())
def test_there_and_back_gives_the_same_text(name: str, data: st.DataObject) -> None:
    document = Draft.of(SCENARIOS[name], name + ".pur")
    place = data.draw(st.sampled_from(document.occurrences))
    once = edited(document.text, rename(document, place.start, "somethingNew"))
    assert {f.code for f in check(parse(once, name + ".pur"))} == {f.code for f in document.findings}
    other = Draft.of(once, name + ".pur")
    where = next(o.start for o in other.occurrences if o.name == "somethingNew")
    assert edited(once, rename(other, where, place.name)) == document.text
