"""Reading UPPAAL's files: any well-formed XML, strict about what a network can hold, errors with their place."""

from __future__ import annotations

from typing import Tuple

import pytest
from hypothesis import given
from hypothesis import strategies as st

from pursue_gen.diagnostics import Diagnostic, PursueError
from pursue_gen.tga.network import ClockBound, Edge, Guard, Kind, Location, Network, Objective, Sync, Test
from pursue_gen.tga.uppaal import read_network, read_query, write_network
from tests.tga.networks import BOTH, REACH, SAFETY, networks

SLOPPY = """
<nta>
<declaration>
//events; with a comment
broadcast chan go, stop;
clock x, y;
int P=1, Q = -12, R;
</declaration>
automata_declaration
rules
<template>
<name>r</name>
//LOCATIONS
<location id="start"></location>
<location id = "end">
<name>end</name>
<label kind="invariant">x&lt;=3 &amp;&amp; y &lt; 7</label>
</location>
<init ref = "start"/>
<transition controllable="false" >
<source ref="start"/><target ref="end"/>
<label kind="synchronisation">go!</label>
<label kind="assignment"> P = -12,  x= 0 , Q:=3</label>
<label kind="guard">x &gt; 1 &amp;&amp; ( P==1||P == -2 )  &amp;&amp; Q==4</label>
</transition>
<transition><source ref="end"/><target ref="start"/><label kind="synchronisation">stop?</label></transition>
</template>
<template><name>states</name><location id="start"/><init ref="start"/></template>
<template><name>spare</name><location id="start"/><init ref="start"/></template>
objectives
<system>
 system states, r ;

</system>
</nta>
"""


def test_stray_words_and_shared_ids_do_not_matter() -> None:
    network = read_network(SLOPPY, "TGA.xml")
    assert network.clocks == ("x", "y")
    assert network.variables == (("P", 1), ("Q", -12), ("R", 0))
    assert network.channels == ("go", "stop")
    (automaton,) = network.automata
    assert (automaton.name, automaton.initial) == ("r", "start")
    assert automaton.locations == (
        Location("start", named=False),
        Location("end", (ClockBound("x", "<=", 3), ClockBound("y", "<", 7))),
    )
    assert automaton.edges == (
        Edge(
            "start",
            "end",
            Guard((ClockBound("x", ">", 1),), ((Test("P", 1), Test("P", -2)), (Test("Q", 4),))),
            Sync("go", True),
            (("P", -12), ("Q", 3)),
            ("x",),
            controllable=False,
        ),
        Edge("end", "start", sync=Sync("stop", False)),
    )


def test_an_empty_states_automaton_is_none_and_a_full_one_is_kept() -> None:
    loop = '<transition><source ref="start"/><target ref="start"/></transition>'
    full = SLOPPY.replace(
        '<init ref="start"/></template>\n<template><name>spare',
        f'<init ref="start"/>{loop}</template>\n<template><name>spare',
    )
    assert [a.name for a in read_network(SLOPPY, "f").automata] == ["r"]
    assert [a.name for a in read_network(full, "f").automata] == ["states", "r"]


FAULTS = [
    ("system states, r ;", "system states, q;", "TGA003", "names q"),
    ("system states, r ;", "p = r(3); system p;", "TGA002", "one line"),
    ("system states, r ;", "system r, r;", "TGA003", "twice"),
    ("broadcast chan go", "chan go", "TGA002", "chan go, stop"),
    ("clock x, y;", "clock x, y; const int N = 3;", "TGA002", "const int N = 3"),
    ("clock x, y;", "clock x y;", "TGA004", "commas"),
    ("clock x, y;", "clock x, go;", "TGA003", "go is declared twice"),
    ("R;", "R[3];", "TGA002", "R [ 3 ]"),
    ("R;", "R = x;", "TGA004", "number"),
    ("//LOCATIONS", "<parameter>int i</parameter>", "TGA002", "parameters"),
    ("//LOCATIONS", "<declaration>clock z;</declaration>", "TGA002", "declarations of its own"),
    ('<location id="start"></location>', '<location id="start"><committed/></location>', "TGA002", "committed"),
    ('<location id="start"></location>', '<location id="start"><urgent/></location>', "TGA002", "urgent"),
    ('<location id = "end">', '<location id = "start">', "TGA003", "two locations with the id start"),
    ("<name>end</name>", "<name>start</name>", "TGA003", "one name"),
    ("<name>r</name>", "", "TGA001", "no name"),
    ("<name>spare</name>", "<name>r</name>", "TGA003", "two templates r"),
    ('<init ref = "start"/>', "", "TGA001", "no initial location"),
    ('<init ref = "start"/>', '<init ref = "nowhere"/>', "TGA003", "nowhere"),
    ('<init ref = "start"/>', "<init/>", "TGA001", "ref"),
    ('<source ref="start"/><target ref="end"/>', '<source ref="start"/>', "TGA001", "target"),
    ("x&lt;=3", "x&gt;=3", "TGA004", "from above"),
    ("x&lt;=3", "P==3", "TGA004", "bounds of declared clocks"),
    ("x &gt; 1", "z &gt; 1", "TGA004", "z is neither"),
    ("x &gt; 1", "x != 1", "TGA004", "!="),
    ("x &gt; 1", "x - y &gt; 1", "TGA004", "x - y"),
    ("P==1||", "x==1||", "TGA004", "inside an ||"),
    ("P==1||", "P==1 &amp;&amp; Q==2 ||", "TGA004", "&& inside an ||"),
    ("Q==4", "Q&lt;=4", "TGA004", "only be compared with =="),
    ("P == -2 )", "P == -2 ", "TGA004", "not closed"),
    ("Q==4", "Q==4 )", "TGA004", "not expected"),
    ("Q==4", "Q==4 @", "TGA004", "@"),
    ("go!", "come!", "TGA004", "come"),
    ("go!", "go", "TGA004", "channel!"),
    ("x= 0 ", "x= 2 ", "TGA004", "reset to 0"),
    ("x= 0 ", "x= y ", "TGA004", "number"),
    ("x= 0 ", "z= 0 ", "TGA004", "z"),
    ("x= 0 ", "x++", "TGA004", "assignment"),
    ("go!", "go?", "TGA002", "clock guard"),
    ('kind="guard"', 'kind="select"', "TGA002", "select"),
    ('kind="guard"', 'kind="assignment"', "TGA001", "two labels"),
    ('kind="guard"', 'sort="guard"', "TGA001", "kind"),
    ('controllable="false"', 'controllable="maybe"', "TGA004", "maybe"),
    ("<system>", "<sys>", "TGA001", "</system>"),
    ("</template>", "", "TGA001", "</nta>"),
    ("</nta>", "", "TGA001", "never closed"),
]


@pytest.mark.parametrize(("old", "new", "code", "message"), FAULTS)
def test_what_a_network_cannot_hold_is_reported_with_its_place(old: str, new: str, code: str, message: str) -> None:
    assert old in SLOPPY
    count = SLOPPY.count(old) if old == "</template>" else 1
    with pytest.raises(PursueError) as raised:
        read_network(SLOPPY.replace(old, new, count), "TGA.xml")
    (found,) = raised.value.diagnostics
    assert found.code == code
    assert message in found.message
    assert found.span is not None
    assert found.span.file == "TGA.xml"
    assert 1 <= found.span.line <= len(SLOPPY.splitlines())


def test_the_place_of_a_label_is_its_line() -> None:
    with pytest.raises(PursueError) as raised:
        read_network(SLOPPY.replace("x &gt; 1", "z &gt; 1"), "TGA.xml")
    span = raised.value.diagnostics[0].span
    assert span is not None
    assert "z &gt; 1" in SLOPPY.replace("x &gt; 1", "z &gt; 1").splitlines()[span.line - 1]


@pytest.mark.parametrize("text", ["", "hello", "<html></html>", "<nta></nta>"])
def test_other_files_are_reported(text: str) -> None:
    with pytest.raises(PursueError) as raised:
        read_network(text, "page.html")
    assert raised.value.diagnostics[0].code == "TGA001"


def refused(text: str) -> Diagnostic:
    """The one error that the text gets."""
    with pytest.raises(PursueError) as raised:
        read_network(text, "TGA.xml")
    (found,) = raised.value.diagnostics
    assert found.span is not None and found.hint
    return found


def place(found: Diagnostic) -> Tuple[int, int]:
    """Line and column."""
    assert found.span is not None
    return found.span.line, found.span.column


LAUGHS = (
    '<!ENTITY a0 "ha">'
    + "".join(f'<!ENTITY a{n + 1} "{f"&a{n};" * 10}">' for n in range(9))
    + '<!ENTITY file SYSTEM "file:///etc/passwd">'
)


@pytest.mark.parametrize(
    "subset",
    [
        LAUGHS,
        '<!ENTITY % p SYSTEM "http://localhost:1/x.dtd"> %p;',
        '<!ATTLIST transition controllable CDATA "false">',
        "",
    ],
)
def test_a_document_type_with_declarations_is_refused(subset: str) -> None:
    found = refused(f"<!DOCTYPE nta [{subset}]>\n<nta>&a9;&file;</nta>")
    assert (found.code, place(found)[0]) == ("TGA001", 1)
    assert "declarations of its own" in found.message


def test_the_document_type_that_uppaal_writes_is_read_and_not_fetched() -> None:
    head = '<?xml version="1.0" encoding="utf-8"?>\n<!DOCTYPE nta PUBLIC "-//Uppaal//" "http://localhost:1/flat.dtd">'
    assert read_network(head + SLOPPY, "f") == read_network(SLOPPY, "f")
    found = refused(head + SLOPPY.replace("rules", "é &file;"))
    assert (found.message, place(found)) == ("&file; is not defined", (11, 3))


@pytest.mark.parametrize(
    ("old", "new", "message", "shift"),
    [
        ("go!", "go! & stop!", "invalid token", 5),
        ("go!", "é🤖 <", "invalid token", 4),
        ("go!", "&nothing;", "undefined entity", 0),
        ("go!", "</label></label>", "</label> stands where </transition> was expected", 10),
        ("<name>end</name>", "<name>end</nam>", "</nam> stands where </name> was expected", 11),
    ],
)
def test_what_is_no_xml_has_its_place(old: str, new: str, message: str, shift: int) -> None:
    text = SLOPPY.replace(old, new, 1)
    found = refused(text)
    start = SLOPPY.index(old)
    line, column = SLOPPY.count("\n", 0, start) + 1, start - SLOPPY.rindex("\n", 0, start)
    assert message in found.message
    assert place(found) == (line, column + shift)


def test_an_element_has_the_place_from_its_beginning_to_its_end() -> None:
    label = '<label kind="synchronisation">é🤖 &gt; &#955;</label>'
    for old, new in (
        ('<label kind="synchronisation">go!</label>', label),
        ('<init ref = "start"/>', '<init  ref="x" />'),
    ):
        text = SLOPPY.replace(old, new, 1)
        with pytest.raises(PursueError) as raised:
            read_network(text, "TGA.xml")
        span = raised.value.diagnostics[0].span
        assert span is not None and span.line == span.end_line
        assert text.splitlines()[span.line - 1][span.column - 1 : span.end_column - 1] == new


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("<nta>" + "<a>" * 5000 + "</a>" * 5000 + "</nta>", "nested more than"),
        ("<nta>" + "<a/>" * 100_000 + "</nta>", "too many elements"),
        ("<nta>" + " " * 10_000_000 + "</nta>", "more than 10000000 letters"),
    ],
)
def test_texts_beyond_all_networks_are_refused(text: str, message: str) -> None:
    found = refused(text)
    assert found.code == "TGA001" and message in found.message


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("( P==1||P == -2 )", "(" * 100_000, "parentheses are open at once"),
        ("( P==1||P == -2 )", "P==1 &amp;&amp; " * 100_000 + "Q", "'Q && Q': the operator"),
        ("Q = -12", "Q = " + "9" * 100_000, "digits"),
        ("clock x, y;", "clock x, y;" + "/*" * 100_000, "is not supported"),
    ],
)
def test_long_labels_and_declarations_end_in_a_message(old: str, new: str, message: str) -> None:
    assert old in SLOPPY
    with pytest.raises(PursueError) as raised:
        read_network(SLOPPY.replace(old, new), "TGA.xml")
    assert message in raised.value.diagnostics[0].message


@given(networks(), st.data())
def test_damaged_files_never_end_in_a_traceback(network: Network, data: st.DataObject) -> None:
    text = write_network(network, SAFETY)
    start = data.draw(st.integers(0, len(text)))
    end = data.draw(st.integers(start, min(len(text), start + 60)))
    damaged = text[:start] + data.draw(st.text("<>/=\"'&|!?();-x0 \n", max_size=6)) + text[end:]
    try:
        read_network(damaged, "TGA.xml")
    except PursueError as error:
        assert error.diagnostics


@pytest.mark.parametrize(
    ("text", "objective"),
    [
        (" control : A<>reachObj.win\n\n\n", REACH),
        ("// what we want\ncontrol: A<> reachObj.win", REACH),
        ("/* safe */ control:A[]not(obj.lose)", SAFETY),
        ("control: A[] not obj.lose", SAFETY),
        ("control: A[] !obj.lose", SAFETY),
        ("control: A[ not(obj.lose) U reachObj.win]", BOTH),
        ("control: A<> a.x and b.y", Objective(Kind.REACH, goal=(("a", "x"), ("b", "y")))),
        ("control: A<> ( a.x&&b.y )", Objective(Kind.REACH, goal=(("a", "x"), ("b", "y")))),
        ("control: A[] !(a.x || b.y)", Objective(Kind.SAFETY, bad=(("a", "x"), ("b", "y")))),
        ("control: A<> m.x_1", Objective(Kind.REACH, goal=(("m", "x_1"),))),
    ],
)
def test_queries(text: str, objective: Objective) -> None:
    assert read_query(text, "TCTL.q") == objective


@pytest.mark.parametrize(
    "text",
    [
        "",
        "\n\n",
        "A<> x.y",
        "control: E<> x.y",
        "control: A[] x.y",
        "control: A<> x.y\ncontrol: A<> x.z",
        "control: A<> x",
        "control: A<> x.y or x.z",
        "control: A[] not(x.y and x.z)",
        "control: A[] not x.y or x.z",
    ],
)
def test_other_queries_are_reported(text: str) -> None:
    with pytest.raises(PursueError) as raised:
        read_query(text, "TCTL.q")
    (found,) = raised.value.diagnostics
    assert found.code == "TGA005"
    assert found.span is not None
    assert found.hint
