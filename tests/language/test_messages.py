"""Each syntax error says where it is, what was expected there, and what to do."""

from __future__ import annotations

import pytest

from pursue_gen.diagnostics import Severity

from .texts import findings, syntax_errors, text

# the text, then code, column, and a part of the message and of the hint
SLIPS = [
    ("poi a", "PML010", 5, "expected a name in quotes after `poi`, found `a`", 'put the name in quotes'),
    ("poi", "PML010", 4, "expected a name in quotes after `poi`, but the statement ends", 'the form is: poi "a"'),
    ('poi "a', "PML012", 5, "no closing quote", 'write it as "name"'),
    ("poi “a”", "PML010", 5, "found `“`", "use straight double quotes"),
    ("for each r in a, b: event \"e\" of r", "PML010", 19, "expected `in`", 'group "some": a, b; then: for each r'),
    ("# my floor", "PML011", 1, "expected a statement, found `#`", "a comment begins with //"),
    ('poi "a" # my desk', "PML010", 9, "found `#`", "a comment begins with //"),
    ('poi "a" "b"', "PML010", 9, "expected `label`, `for`, `except` or the end of the statement", "the form is"),
    ('pois "a"', "PML011", 1, "expected a statement, found `pois`", "did you mean poi?"),
    ('Poi "a"', "PML011", 1, "expected a statement", "did you mean poi?"),
    ("poi security door", "PML010", 5, "found `security`", 'poi "security_door" label "security door"'),
    ('poi "a" label', "PML010", 14, "expected a name in quotes after `label`", "the form is"),
    ('poi "a" label b', "PML010", 15, "expected a name in quotes after `label`, found `b`", 'label "b"'),
    ('connect a and b distance 3 label "c"', "PML010", 28, "found `label`", "the form is"),
    ("hello", "PML011", 1, "expected a statement", "a statement begins with unit, rest, poi, door, lift, connect"),
    ("lift l1 holds 1 robot", "PML011", 1, "found `lift`", "an objective; write objective: lift l1 holds 1"),
    ("patrol a, b every 60 by any robot", "PML011", 1, "found `patrol`", "write objective: patrol a, b every 60 by"),
    ("do e and f within 5", "PML011", 1, "found `do`", "write reach_objective: do e and f within 5"),
    ("avoid " + "e" * 200, "PML011", 1, "found `avoid`", "write objective: in front of it"),
    (")", "PML011", 1, "expected a statement", "a statement begins with"),
    ("connect a b distance 3", "PML010", 11, "expected `and` after `a`, found `b`", "connect a and b distance 3"),
    ("connect a and b", "PML010", 16, "expected `distance` after `b`, but the", "connect a and b distance 3"),
    ("connect a and b one_way", "PML010", 17, "expected `distance` after `b`, found `one_way`", "distance 3 one_way"),
    ("connect a and b distance 3 oneway", "PML010", 28, "`for`, `except`, `by`, `only_if` or the end", "mean one_way?"),
    ("connect a and b distance 3 one_way 4", "PML010", 36, "or the end of the statement", "the form is"),
    ('connect "a" and b distance 3', "PML010", 9, "expected a name after `connect`", "write a without them"),
    ("connect a and b distance", "PML010", 25, "expected a number", "connect a and b distance 3"),
    ("connect a and b distance three", "PML010", 26, "expected a number after `distance`", "distance 3"),
    ("connect a and b distance -3", "PML014", 26, "expected a number, found -3", "write digits only"),
    ("connect a and b distance 3.", "PML014", 26, "expected a number, found 3.", "write 3: a point stands between"),
    ("connect a and b distance .5", "PML014", 26, "expected a number, found .5", "write 0.5: a point stands between"),
    ("connect a and b distance 1e3", "PML014", 26, "expected a number, found 1e3", "write 1000"),
    ("connect a and b distance 2,5", "PML010", 27, "found `,`", "write 2.5: decimals have a point"),
    ("connect a and b distance 2,500", "PML010", 27, "found `,`", "write 2.500 or 2500"),
    ("connect a and b distance 1.2345", "PML280", 26, "1.2345 has more than 3 digits after the point", "round it"),
    ("connect a and b distance 1.5.2", "PML014", 26, "expected a number, found 1.5.2", "with a point before decimals"),
    ("connect a and b distance 1000000.5", "PML014", 26, "too large: 1000000 is the largest", "choose a larger unit"),
    ('event "e" at_most 1.5 times', "PML014", 19, "expected a whole number, found 1.5", "write it without decimals"),
    ("assume: a does b at_most -1 times", "PML014", 26, "expected a whole number, found -1", "write digits only"),
    ("connect a and b distance 1000001", "PML014", 26, "too large: 1000000 is the largest", "choose a larger unit"),
    ("connect a and 2b distance 3", "PML010", 15, "expected a name after `and`, found `2b`", "begins with a letter"),
    ("connect a and or distance 3", "PML010", 15, "expected a name", "or is a word of the language"),
    ("connect a and state distance 3", "PML010", 15, "expected a name", "state is a word of the language"),
    ("event catch", "PML010", 7, "expected a name in quotes", 'event "catch"'),
    ('event "e" duration', "PML010", 19, "expected a number after `duration`", "the form is"),
    ('event "e" duration 3 to', "PML010", 24, "expected a number after `to`", "the form is"),
    ('event "e" duration to 3', "PML010", 20, "expected a number after `duration`", "or: duration 6 to 9"),
    ("travel bot from a to b", "PML010", 23, "expected `takes` after `b`, but the", "from a to b takes 5 to 8"),
    ("travel bot a to b takes 5", "PML010", 12, "expected `from` after `bot`, found `a`", "the form is"),
    ("travel bot from a b takes 5", "PML010", 19, "expected `to` after `a`, found `b`", "the form is"),
    ("travel bot from a to b takes", "PML010", 29, "expected a number after `takes`", "the form is"),
    ("travel 3 from a to b takes 5", "PML010", 8, "expected a name after `travel`", "a name begins with a letter"),
    ('event "e" duration 3 location a', "PML010", 22, "`at_most`, `in`, `only_if` or the end", "location a duration 6"),
    ('event "e" at_most 2', "PML010", 20, "expected `times` after `2`", "at_most 2 times"),
    ('event "e" at_most times', "PML010", 19, "expected a number after `at_most`", "come in this order"),
    ('event "e" at_most 1 time', "PML010", 21, "expected `times` after `1`, found `time`", "did you mean times?"),
    ('event "e" at_most 2 times duration 3', "PML010", 27, "or the end of the statement", "come in this order"),
    ('event "e" together collaborative', "PML010", 20, "found `collaborative`", "parts come in this order"),
    ('event "e" collaborative togehter', "PML010", 25, "`together`", "did you mean together?"),
    ('event "e" colaborative', "PML010", 11, "`collaborative`", "did you mean collaborative?"),
    ('event "e" location', "PML010", 19, "expected a name after `location`", "the form is"),
    ("connect a and b distance 3 only_if", "PML010", 35, "expected a name, `(` or `not`", "only_if open is_true"),
    ("connect a and b distance 3 only_if s", "PML010", 37, "expected `is_true`, `is_false`, `at`", "the form is"),
    ("connect a and b only_if s is_true", "PML010", 17, "expected `distance`", "the form is"),
    ("optional", "PML010", 9, "expected a number after `optional`, but the statement ends", "optional 1"),
    ("optional 1", "PML010", 11, "expected `objective` or `reach_objective` after `1`", "1 is kept longest"),
    ("optional 1 do e", "PML010", 12, "expected `objective` or `reach_objective`", "1 is kept longest"),
    ("optional objective: avoid e", "PML010", 10, "expected a number after `optional`", "optional 1"),
    ("optional one objective: avoid e", "PML010", 10, "expected a number after `optional`", "optional 1"),
    ("optional 1 objective: do e", "PML010", 23, "expected", "write reach_objective: do"),
    ("optional 1.5 objective: avoid e", "PML014", 10, "a whole number, found 1.5", "write it without decimals"),
    ("battery bot", "PML010", 12, "expected `lasts` or `capacity` after `bot`", "battery bot capacity 100"),
    ('battery "bot" 5', "PML010", 15, "expected `lasts` or `capacity`", "battery bot capacity 100"),
    ("battery bot lasts 5 charges in 3 at b", "PML010", 21, "expected `,` after `5`", "battery bot lasts 1200,"),
    ("battery bot lasts 5, charges 3 at b", "PML010", 30, "expected `in` after `charges`", "the form is"),
    ("battery bot lasts 5, charge in 3 at b", "PML010", 22, "expected `charges` after `,`", "did you mean charges?"),
    ("battery bot capacity 9 uses 1 per meter", "PML010", 35, "expected `unit` or `metre` after `per`", "metre"),
    ("battery bot lasts 5, charges in 3", "PML010", 34, "expected `in` or `at` after `3`", "the form is"),
    ("battery bot lasts 5, charges in 3 in 5 at b", "PML010", 40, "expected `parts` after `5`", "the form is"),
    ("battery bot capacity 5 uses 1", "PML010", 30, "expected `per` after `1`", "the form is"),
    ("battery bot capacity 5 uses 1 per hour", "PML010", 35, "expected `unit` or `metre` after `per`", "the form is"),
    ("battery bot capacity 5 uses 1 per unit at b", "PML010", 40, "expected `recharges` or the end", "the form is"),
    ("battery bot capacity 5 uses 1 per unit recharges 2 per unit", "PML010", 60, "expected `at`", "the form is"),
    ("battery bot capacity 5 uses 1 per unit recharges 2 per unit at", "PML010", 63, "expected a name", "the form is"),
    ("battery bot capacity 9 use 1 per unit", "PML010", 24, "expected `uses` after `9`", "did you mean uses?"),
    ("objective: if a then b within 9, at_most 3", "PML010", 43, "expected `open`", "is: objective: if order then"),
    ("objective: if a then b within 9 at_most 3 open", "PML010", 33, "expected `,`", "pack within 120, at_most 3 open"),
    ("assume: a waits 5", "PML010", 18, "expected `between`", "the form is: assume: guest waits 5 between call"),
    ("objective: always", "PML010", 18, "expected", "the form is"),
    ("objective: always e", "PML010", 20, "expected `is_true`, `is_false`", "always open is_true"),
    ("objective: avoid a at", "PML010", 22, "expected a name after `at`", "the form is"),
    ("objective: avoid a at b or c at d and e at f", "PML010", 35, "found `and`", "put brackets around"),
    ("objective: a never_with b at", "PML010", 29, "expected a name after `at`", "the form is"),
    ("objective: allways a at b", "PML010", 20, "`never_with`", "the form is"),
    ('event "e" only_if a at', "PML010", 23, "expected a name after `at`", "only_if open is_true"),
    ('event "e" only_if a at b is_true', "PML010", 26, "expected `and`, `or` or the end", "parts come in this order"),
    ('event "e" only_if a at b and c at d or e on_way', "PML010", 37, "found `or`", "put brackets around"),
    ('event "e" only_if a at b or c at d and e on_way', "PML010", 36, "found `and`", "put brackets around"),
    ('event "e" only_if a doin b', "PML010", 21, "`doing`", "did you mean doing?"),
    ('event "e" only_if any bot at b', "PML010", 23, "`robot`", "did you mean robot?"),
    ('event "e" only_if (a at b', "PML010", 26, "expected", "put a `)` for each `(`"),
    ('event "e" only_if not not a at b', "PML010", 23, "after `not`, found `not`", ""),
    ('event "e" only_if a at b duration 3', "PML010", 26, "found `duration`", "parts come in this order"),
    ('event "e" only_if ' + "(" * 41 + "a", "PML016", 59, "more than 40 brackets", "say it with fewer"),
    ('event "e" only_if a on_way' + " and a on_way" * 500, "PML016", 1, "more than 500 parts", "say it with fewer"),
    ('rule "r" a before b', "PML010", 10, "expected `:`", "the form is"),
    ('rule "r": a', "PML010", 12, "expected `and`, `before` or `or`", "first before second"),
    ('rule "r":', "PML010", 10, "expected a name or `(`", "the form is"),
    ('rule "r": a before', "PML010", 19, "expected a name or `(`", "the form is"),
    ('rule "r": a befor b', "PML010", 13, "expected `and`, `before` or `or`", "did you mean before?"),
    ('rule "r": a before b before c or d', "PML010", 31, "found `or`", "put brackets around what belongs together"),
    ('rule "r": a or b or c and d', "PML010", 23, "found `and`", "put brackets around what belongs together"),
    ('rule "r": a and b before c', "PML010", 19, "found `before`", "put brackets around what belongs together"),
    ('rule "r": a before b and c', "PML010", 22, "found `and`", "put brackets around what belongs together"),
    ('rule "r": a and', "PML010", 16, "expected a name or `(`", "the form is"),
    ('rule "r" for robot: a or b', "PML010", 14, "expected `each` after `for`, found `robot`", "for each robot"),
    ('rule "r" for each bot: a or b', "PML010", 19, "expected `agent` or `robot` after `each`", "did you mean robot?"),
    ('rule "r" for each agent a or b', "PML010", 25, "expected `:` after `agent`", "for each robot"),
    ('rule "r": (a before b', "PML010", 22, "expected `)`", "put a `)` for each `(`"),
    ('rule "r": a before b)', "PML010", 21, "found `)`", "this `)` has no `(`"),
    ('rule "r": ' + "(" * 41 + "a", "PML016", 51, "more than 40 brackets", "split the rule"),
    ('state "s": initially false true_if a', "PML010", 28, "expected `,`", "put a comma behind true or false"),
    ('state "s": initially maybe, true_if a', "PML010", 22, "expected `true`, `false` or `unknown`", "the form is"),
    ('state "s": false', "PML010", 12, "expected `initially`", "the form is"),
    ('state "s": initially false, true_if a, false_if b', "PML010", 40, "expected a name", "false_if is a word"),
    ("stateDependency: a only_if s", "PML010", 29, "expected `is_true` or `is_false`", "the form is"),
    ("stateDependency: a only_if s is_ture", "PML010", 30, "expected `is_true` or `is_false`", "mean is_true?"),
    ("stateDependency a only_if s is_true", "PML010", 17, "expected `:`", "the form is"),
    ("objective: patrol a every 5", "PML010", 28, "expected `by` after `5`", "by any robot"),
    ("objective: patrol a, b", "PML010", 23, "expected `,`, `in`, `every` or `by` after `b`", "every 60 by bot1"),
    ("objective: patrol a, b in every 5 by c", "PML010", 27, "expected `order` after `in`, found `every`", "in order"),
    ("objective: patrol a, b order every 5 by c", "PML010", 24, "expected `,`, `in`", "in order and every are"),
    ("objective: patrol a, b every 5 in order by c", "PML010", 32, "expected `by`", "b in order every 60"),
    ("objective: patrol every 5 by b", "PML010", 25, "`5`", "the form is"),
    ("assume: a does b", "PML010", 17, "expected `at_most`, `every` or `after`", "guest does call at_most 2 times"),
    ("assume: a does b at_most twice", "PML010", 26, "expected a number after `at_most`", "at_most 2 times"),
    ("assume: a waits 5 b", "PML010", 19, "expected `between` after `5`", "waits 5 between call"),
    ("assume: a leaves b", "PML010", 19, "expected `within` after `b`", "leaves hall within 30"),
    ("assume: a never b", "PML010", 17, "expected `at` after `never`", "never at store"),
    ("assume: not (a at b and c at d", "PML010", 31, "expected `)` or `and`", "put a `)`"),
    ("assume: a at b", "PML010", 15, "expected `by` after `b`", "assume: visitor at exit by 300"),
    ("assume a never at b", "PML010", 8, "expected `:`", "the form is"),
    ("assume: a lies at b", "PML010", 11, "`reaches`, `never` or `at` after `a`", "the form is"),
    ('agent "b" mobile 3', "PML010", 19, "`inflation`, `carries` or `has` after `3`", "location is required"),
    ('agent "b" mobile location a', "PML010", 18, "expected a number after `mobile`", "mobile 3"),
    ('agent "b" location a controllable', "PML010", 22, "found `controllable`", "human controllable mobile 3 location"),
    ('agent "b" location a can_do x y', "PML010", 31, "expected `,`", "put a comma between two names"),
    ('agent "b" location a can_do x,', "PML010", 31, "expected a name after `,`", "the form is"),
    ('agent "b" location a reacts_to x can_do y', "PML010", 34, "found `can_do`", "can_do e1, e2 reacts_to e3"),
    ('agent "b" controlable location a', "PML010", 11, "`controllable`", "did you mean controllable?"),
    ('agnt "b" location a', "PML011", 1, "expected a statement", "did you mean agent?"),
    ("objective:", "PML010", 11, "expected a name, `if` or `avoid`", "the form is"),
    ("objective if a then b within 3", "PML010", 11, "expected `:`", "the form is"),
    ("objective: if a then b", "PML010", 23, "expected `within`, `is_true`, `is_false`", "the form is"),
    ("objective: if a at b", "PML010", 21, "expected `and`, `or` or `then`", "if bot1 at a then"),
    ("objective: if a at b and c at d or e on_way then f within 3", "PML010", 33, "found `or`", "put brackets around"),
    ("objective: if a at then b within 3", "PML010", 20, "expected a name after `at`", "cannot be a name"),
    ("objective: if not a then b within 3", "PML010", 21, "expected `is_true`", "the form is"),
    ("objective: follow a within 5 by b", "PML010", 19, "found `a`", "escort visitor at rooms within 5 by bot1"),
    ("objective: b follows a within 5", "PML010", 14, "found `follows`", "a group of all places"),
    ("objective: escort a within 5 by b", "PML010", 21, "expected `at` after `a`", "name the places: escort"),
    ("objective: b meets a within 5", "PML010", 14, "found `meets`", "a collaborative event"),
    ("reach_objective: meet a within 5", "PML010", 18, "expected `do`", "reach_objective: do meet within 60"),
    ("objective: patrol a every 60 twice by b", "PML010", 30, "found `twice`", "twice in 60 is every 30"),
    ("objective: patrol a 3 times every 60 by b", "PML010", 21, "found `3`", "3 times in 60 is every 20"),
    ("objective: patrol a 7 times every 60 by b", "PML010", 21, "found `7`", "7 times in 60 is every 8.5"),
    ("objective: patrol a every 60 by b, c", "PML010", 34, "found `,`", "put `or` between them: by b or c"),
    ("objective: escort a at d within 5 by b and c", "PML010", 40, "found `and`", "put `or` between them: by b or c"),
    ("objective: do a", "PML010", 12, "found `do`", "write reach_objective: do"),
    ("objective: a never with b", "PML010", 14, "expected `never_with`", "did you mean never_with?"),
    ("reach_objective: avoid a", "PML010", 18, "expected `do`", "is an objective"),
    ("reach_objective: do a within", "PML010", 29, "expected a number", "after and within are optional"),
    ("reach_objective: do a within 3 after 2", "PML010", 32, "found `after`", "do e1 and e2 after 10 within 60"),
    ("reach_objective: do a, b", "PML010", 22, "expected a number, `and`", "do e1 and e2"),
    ("reach_objective: do a after", "PML010", 28, "expected a number", "the form is"),
    ("/* never closed", "PML013", 1, "never closed: expected `*/`", "use // for one line"),
    ('poi "a" /* never closed', "PML013", 9, "never closed", "use // for one line"),
    ("objective: avoid a; ", "PML010", 19, "found `;`", "the form is"),
    ("control : A<>reachObj.win", "PML017", 1, "stands only behind an objective", "delete it"),
]  # fmt: skip


@pytest.mark.parametrize(("slip", "code", "column", "message", "hint"), SLIPS, ids=[row[0][:40] for row in SLIPS])
def test_a_slip_is_reported_with_its_place(slip: str, code: str, column: int, message: str, hint: str) -> None:
    (finding,) = syntax_errors("// first line\n" + slip)
    assert finding.severity is Severity.ERROR
    assert (finding.code, finding.span and (finding.span.line, finding.span.column)) == (code, (2, column))
    assert message in finding.message
    assert hint in finding.hint


def test_every_slip_of_a_file_is_reported_at_once() -> None:
    source = text(poi_a="poi a", event_rest='evnt "rest"', agent_bot='agent "bot" mobile location a')
    source += "objective: avoid\n"
    found = [(finding.code, finding.span and finding.span.line) for finding in syntax_errors(source)]
    assert found == [("PML010", 1), ("PML011", 6), ("PML010", 10), ("PML010", 14)]


def test_every_objective_without_its_word_is_reported_at_once() -> None:
    agent = 'agent "bot" controllable mobile 1 location a'
    lines = ['poi "a"', agent, "keep a", "patrol a by bot", "if e then f within 5", f"{agent} x"]
    found = [(one.span.line, one.code) for one in findings("\n".join(lines)) if one.span]
    assert found == [(3, "PML010"), (4, "PML011"), (5, "PML011"), (6, "PML010")]


def test_no_nonsense_follows_from_a_syntax_error() -> None:
    """A POI that could not be read is not also said to be unknown."""
    assert [finding.code for finding in findings(text(poi_a="poi a"))] == ["PML010"]


def test_an_expected_list_reads_like_a_sentence() -> None:
    (finding,) = syntax_errors('event "e" e')
    parts = "`label`, `collaborative`, `location`, `duration`, `on_order`, `may_stop`, `takes`, `gives`, `mounts`"
    assert f"expected {parts}, `needs`, `at_most`, `in`, `only_if` or the end" in finding.message


BEFORE = '''poi "a"
poi "b"
connect a and b distance 3
event "first" location a
event "second" location b
'''
BEHIND = '''
agent "bot" controllable mobile 3 location a can_do first, second
reach_objective: do second
'''


@pytest.mark.parametrize("last", ["", 'rule "rule1": first before second\n'], ids=["listing 5.5", "listing 5.3"])
def test_a_comment_that_goes_on_without_slashes_is_named(last: str) -> None:
    """As the thesis's listings 5.3 and 5.5 have it."""
    comment = "//agents (must specify if controllable and/or mobile,\ninitial location actions and reactions)\n"
    source = BEFORE + last + comment + BEHIND
    (finding,) = syntax_errors(source)
    line = 1 + (BEFORE + last).count("\n")
    assert (finding.span and finding.span.line) == line + 1
    assert finding.hint.startswith(f"did the comment of line {line} go on here? start the line with //; if not, the")
    mended = source.replace("initial location", "// initial location")
    assert syntax_errors(mended) == []


def test_a_comment_at_the_start_of_a_text_is_named_too() -> None:
    (finding,) = syntax_errors("// my floor,\nas of today\n" + BEFORE + BEHIND)
    assert finding.code == "PML011" and "comment of line 1" in finding.hint


@pytest.mark.parametrize(
    ("slip", "hint"),
    [
        ("// places\npois \"c\"\n", "did you mean poi?"),  # what is meant is known
        ("// an event\n\nhello there\n", "a statement begins with"),  # not the line below
        ('event "third" // an event\nhello\n', "the form is"),  # a comment behind a statement
        ("// an event\nevent \"third\" hello\n", "the form is"),  # not the start of the line
    ],
)
def test_another_slip_below_a_comment_keeps_its_hint(slip: str, hint: str) -> None:
    found = syntax_errors(slip + BEFORE + BEHIND)
    assert hint in found[0].hint and "comment" not in found[0].hint
