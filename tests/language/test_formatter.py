"""The layout of a scenario's text: only blanks and line breaks change, and what is laid out stays as it is."""

from __future__ import annotations

import dataclasses
import re
from pathlib import Path
from typing import Any, List

import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from pursue_gen.diagnostics import PursueError, Span
from pursue_gen.language import parse
from pursue_gen.language.formatter import INDENT, WIDTH, format_text
from pursue_gen.language.parser import read

from .texts import STATEMENTS, text

ROOT = Path(__file__).resolve().parents[2]
OWN = sorted((ROOT / "scenarios").rglob("*.pur"))
POSE = "//[3.0, 1.54, 0, 0, 0, 0.67, 0.73]"


def meaning(value: Any) -> Any:
    """A scenario without its text and places."""
    if isinstance(value, Span):
        return None
    if isinstance(value, tuple):
        return tuple(meaning(part) for part in value)
    if not dataclasses.is_dataclass(value):
        return value
    fields = {field.name: meaning(getattr(value, field.name)) for field in dataclasses.fields(value)}
    fields.pop("text", None)
    return type(value).__name__, fields


def formatted(source: str) -> str:
    """The text in its layout, once everything is tested that holds for every text."""
    result = format_text(source, "test.pur")
    assert format_text(result, "test.pur") == result
    assert re.sub(r"\s", "", result) == re.sub(r"\s", "", source)
    before, after = read(source, "test.pur"), read(result, "test.pur")
    assert meaning(before.scenario) == meaning(after.scenario)
    assert [finding.code for finding in before.diagnostics] == [finding.code for finding in after.diagnostics]
    assert not re.search(r"[ \t\f\r]\n|\n\n\n|^\n|\n\n$", result)
    assert result == "" or result.endswith("\n")
    return result


# What the layout is ---------------------------------------------------------------------------------------------------


def test_one_statement_a_line_with_single_blanks() -> None:
    source = 'poi"a"  poi\n"b" connect a  and\tb distance 3\none_way rule "r" :( x or y )before z'
    way = "connect a and b distance 3 one_way"
    assert formatted(source) == f'poi "a"\npoi "b"\n\n{way}\n\nrule "r": (x or y) before z\n'


def test_windows_limits_travel_times_and_rules_for_each() -> None:
    source = 'event "e" duration 3   to 5 at_most 2\ntimes rule "r" for  each\nrobot :( x and y )before z '
    source += 'travel  bot from a to b\ntakes 5 to 8 travel "bot" from b to a takes 3'
    lines = ['event "e" duration 3 to 5 at_most 2 times', "", 'rule "r" for each robot: (x and y) before z', ""]
    lines += ["travel bot from a to b takes 5 to 8", 'travel "bot" from b to a takes 3', ""]
    assert formatted(source) == "\n".join(lines)


def test_an_empty_line_stands_between_kinds_and_one_at_most_elsewhere() -> None:
    source = '\n\npoi "a"\n\n\n\npoi "b"\npoi "c"\n// ways\nconnect a and b distance 1\nevent "e"\n\n'
    expected = 'poi "a"\n\npoi "b"\npoi "c"\n\n// ways\nconnect a and b distance 1\n\nevent "e"\n'
    assert formatted(source) == expected


def test_what_belongs_together_stays_together() -> None:
    source = 'state "s": initially true\nstateDependency: e only_if s is_true\n'
    assert formatted(source) == source
    source = "objective: avoid e\nreach_objective: do f\ncontrol: A<> reachObj.win\n"
    assert formatted(source) == source


def test_the_empty_text_stays_empty() -> None:
    assert formatted("") == ""
    assert formatted(" \n\t\n") == ""
    assert formatted("// only this") == "// only this\n"


def test_line_ends_become_newlines() -> None:
    assert formatted('poi "a"\r\n// two\r\npoi "b"\rpoi "c"') == 'poi "a"\n// two\npoi "b"\npoi "c"\n'


def test_a_long_statement_goes_on_behind_a_comma() -> None:
    names = [f"fetchTheBox{number}" for number in range(20)]
    lines = formatted('agent "bot" location a can_do ' + ",".join(names)).splitlines()
    assert len(lines) == 4
    assert all(len(line) <= WIDTH for line in lines)
    assert all(line.endswith(",") for line in lines[:-1])
    assert all(line.startswith(INDENT) for line in lines[1:])


def test_a_long_rule_goes_on_before_a_word() -> None:
    e = "somethingThatHasALongName"
    lines = formatted(f'rule "r": ({e}1 before {e}2) before (({e}3 or {e}4) or {e}5)').splitlines()
    assert len(lines) > 1 and all(len(line) <= WIDTH for line in lines)
    assert all(re.match(INDENT + r"(before|or) ", line) for line in lines[1:])


def test_a_statement_of_the_full_width_is_one_line() -> None:
    start = 'agent "bot" location a can_do f, '
    full = start + "e" * (WIDTH - len(start))
    assert formatted(full) == full + "\n"
    assert formatted(full + "e // remark") == f"{start.rstrip()}\n{INDENT}{full[len(start) :]}e // remark\n"


def test_comments_stay_where_they_are() -> None:
    source = """/* head */ poi "a"// here
/* one
     two */ poi "b" /* x */ // y
    // alone
agent "bot" // first
   // second
location /* where */ a, b"""
    source = source.replace("a, b", "a can_do e,/* f */ f")
    expected = """/* head */
poi "a" // here
/* one
     two */
poi "b" /* x */ // y

// alone
agent "bot" // first
    // second
    location /* where */ a can_do e, /* f */ f
"""
    assert formatted(source) == expected


def test_comments_at_the_ends_of_neighbouring_lines_begin_in_one_column() -> None:
    source = f'poi "a" {POSE}\npoi "kitchen"//big\npoi "c"\npoi "hallway" // x\n\npoi "d"// y\n'
    expected = f'poi "a"       {POSE}\npoi "kitchen" //big\npoi "c"\npoi "hallway" // x\n\npoi "d" // y\n'
    assert formatted(source) == expected


def test_one_long_statement_does_not_push_all_comments_away() -> None:
    source = f'poi "a" // x\npoi "{"b" * 40}" // y\n'
    assert formatted(source) == source


def test_a_pose_stays_a_pose_and_a_comment_a_comment() -> None:
    with_pose, without = f'poi\n"a" {POSE}', f'poi "a"\n{POSE}\npoi // [1]\n"b" /*\n*/ {POSE}'
    assert read(formatted(with_pose), "test.pur").scenario.pois[0].pose is not None  # type: ignore[union-attr]
    scenario = read(formatted(without), "test.pur").scenario
    assert scenario is not None and [poi.pose for poi in scenario.pois] == [None, None]


def test_the_poses_of_robots_stay_as_they_are() -> None:
    line = f'poi "a" {POSE} bot2 [3, 2.5,0, 0, 0, 0, 1],  by the door'
    source = f'{line}\nagent "bot2" controllable location a\n'
    written = formatted(source)
    assert written.splitlines()[0] == line and formatted(written) == written
    assert [poi.spots[0].robot.name for poi in read(written, "test.pur").partial.pois] == ["bot2"]  # type: ignore[union-attr]


def test_findings_that_are_no_syntax_errors_do_not_matter() -> None:
    assert formatted('poi "a" poi "a"\nconnect a and x distance 1.5') == (
        'poi "a"\npoi "a"\n\nconnect a and x distance 1.5\n'
    )


@pytest.mark.parametrize("source", ['poi "a"\npoi b\npio "c"', 'poi "a\npoi "b"\n/* open', "control: x"])
def test_a_text_with_syntax_errors_is_refused_with_all_of_them(source: str) -> None:
    with pytest.raises(PursueError) as caught:
        format_text(source, "test.pur")
    assert caught.value.diagnostics == read(source, "test.pur").diagnostics
    assert caught.value.exit_status == 3


@pytest.mark.parametrize("path", OWN, ids=lambda path: path.stem)
def test_own_scenarios_are_laid_out(path: Path) -> None:
    source = path.read_bytes().decode("utf-8")
    assert formatted(source) == source, f"pursue-gen fmt {path.relative_to(ROOT)}"


@pytest.mark.parametrize(
    "name", ["CT1", "CT2a", "CT3a", "CT3b", "CT4", "CT5", "EB1", "EB2", "EB2x", "EB3", "EB4", "WC1"]
)
def test_published_scenarios_can_be_laid_out(name: str, reference_dir: Path) -> None:
    formatted((reference_dir / name / "scenario.pur").read_text(encoding="utf-8"))


# For every text -------------------------------------------------------------------------------------------------------

BLANKS = st.sampled_from([" ", "  ", "\n", "\n\n\n", "\t", "\f", " \r\n "])
COMMENTS = st.sampled_from(
    [
        "// x\n",
        "//\n",
        "/* x */",
        "/* x\n\n   y  \n*/",
        "/**/",
        f"{POSE}\n",
        "// [a]\t\n",
        '// "\n',
        "/* // */",
        '/*"*/',
    ]
)
GAPS = st.lists(BLANKS | COMMENTS, max_size=4).map("".join)
NAMES = st.sampled_from(["a", "b", "e", "f", "longer_name", "human", "control", "é", "x-y", "n" * 40])


@st.composite
def texts(draw: st.DrawFn) -> str:
    """Well-formed statements, with blanks and comments wherever they may stand."""

    def refs() -> List[str]:
        names = draw(st.lists(NAMES, min_size=1, max_size=6))
        return [word for name in names for word in (name, ",")][:-1]

    def maybe(*words: str) -> List[str]:
        return list(words) if draw(st.booleans()) else []

    def body(depth: int) -> List[str]:
        sides = [["(", *body(depth - 1), ")"] if depth and draw(st.booleans()) else [draw(NAMES)] for _ in range(2)]
        return [*sides[0], draw(st.sampled_from(["before", "or"])), *sides[1]]

    def statement() -> List[str]:
        name, other, quoted, number = draw(NAMES), draw(NAMES), f'"{draw(NAMES)}"', str(draw(st.integers(0, 2000)))
        kind = draw(st.integers(0, 10))
        if kind == 0:
            return ["poi", quoted]
        if kind == 1:
            return ["connect", name, "and", other, "distance", number]
        if kind == 2:
            extra = maybe("collaborative") + maybe("together") + maybe("location", name) + maybe("duration", number)
            return ["event", quoted, *extra]
        if kind == 3:
            return ["rule", quoted, ":", *body(3)]
        if kind == 4:
            sets = [",", "true_if", *refs(), *(["false_if", *refs()] if draw(st.booleans()) else [])]
            return ["state", quoted, ":", "initially", "true", *(sets if draw(st.booleans()) else [])]
        if kind == 5:
            return ["stateDependency", ":", name, "only_if", other, "is_true"]
        if kind == 6:
            moves = maybe("human") + maybe("controllable") + maybe("mobile", number)
            return ["agent", quoted, *moves, "location", name, "can_do", *refs(), "reacts_to", *refs()]
        if kind == 9:
            return ["assume", ":", *draw(st.sampled_from((
                ["not", "(", name, "at", other, "and", name, "on_way", ")"],
                [name, "does", other, "at_most", number, "times"], [name, "does", other, "after", number],
                [name, "waits", number, "between", other], [name, "leaves", other, "within", number],
                [name, "never", "at", other],
            )))]  # fmt: skip
        if kind == 7 and draw(st.booleans()):
            who = draw(st.sampled_from(([name], ["any", "robot"])))
            return ["objective", ":", "patrol", *refs(), *maybe("in", "order"), *maybe("every", number), "by", *who]
        if kind == 7:
            some = [name] if draw(st.booleans()) else [name, "at", other, "and", "not", name, "on_way"]
            return ["objective", ":", "if", *some, "then", other, "within", number]
        if kind == 8:
            return ["objective", ":", name, "never_with", other, "\n", "control : A[] not(obj.lose) \n"]
        return ["reach_objective", ":", "do", name, *maybe("after", number)]

    words = [word for _ in range(draw(st.integers(0, 6))) for word in statement()]
    return "".join(f"{word}{draw(BLANKS)}{draw(GAPS)}" for word in words)


@given(texts())
@example('agent "b" location a can_do e,/* x */\n// y\n/* z */ /* z */ f // end\n/* below */')
@example(f'poi "a" /* x\n*/ {POSE}\n')
@example('rule "r": (// x\na or b) // [1]\nbefore c')
def test_layout_changes_blanks_only_and_once(source: str) -> None:
    formatted(source)


@given(st.permutations(sorted(STATEMENTS)), st.lists(st.tuples(st.integers(0, 800), st.integers(0, 3), st.text(
    alphabet=' \n\t\f\r"/*,:()[]ab1é\u2028\x0b', max_size=4)), max_size=5))  # fmt: skip
def test_mutated_texts_are_laid_out_or_refused(order: List[str], cuts: List[Any]) -> None:
    source = "\n".join(STATEMENTS[key] for key in order)
    for place, length, inserted in cuts:
        place %= len(source) + 1
        source = source[:place] + inserted + source[place + length :]
    try:
        format_text(source, "test.pur")
    except PursueError as problem:
        assert problem.diagnostics and problem.exit_status == 3
    else:
        formatted(source)


def test_the_meaning_of_the_sample_is_kept() -> None:
    assert meaning(parse(formatted(text()), "test.pur")) == meaning(parse(text(), "test.pur"))


def test_deep_nesting_is_refused_and_does_not_crash() -> None:
    deepest = 'rule "r": ' + "(" * 39 + "a or b" + ") or c" * 39
    assert formatted(deepest)
    with pytest.raises(PursueError) as caught:
        format_text('rule "r": ' + "(" * 5000, "test.pur")
    assert [finding.code for finding in caught.value.diagnostics] == ["PML016"]
