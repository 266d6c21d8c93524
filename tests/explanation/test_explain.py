"""Explanations of lost scenarios: each claim is tried again on an edited text, and plays say what happens when."""

from __future__ import annotations

import functools
import json
import re
from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from typing import Tuple

import pytest

from benchmarks.lab_scenarios import lab_scenario
from benchmarks.ordinary_families import errands_beside_a_visitor
from pursue_gen.explanation.changes import Change, findings
from pursue_gen.explanation.explain import Explanation, as_json, explain, render
from pursue_gen.language import parse
from pursue_gen.solving.rules import CONTROLLABLE, IDEAL, Rules, played
from pursue_gen.solving.solvers import solved
from pursue_gen.synthesis.budget import Budget
from pursue_gen.synthesis.limits import Limits
from pursue_gen.synthesis.solve import solve
from pursue_gen.tga import scenario_objective, translate
from tests.cli.test_commands import pursue

PLENTY = 1200.0
DEFAULT = Rules()

CALLED = """poi "desk"
poi "shelf"
connect desk and shelf distance 2
event "callBot"
event "fetch" location shelf
agent "bot" controllable mobile 1 location desk can_do fetch
agent "visitor" location desk can_do callBot
objective: if callBot then fetch within {deadline}
"""

SHY = """poi "desk"
poi "shelf"
connect desk and shelf distance 2
event "meet" collaborative
agent "bot" controllable mobile 2 location desk reacts_to meet
agent "visitor" mobile 1 location shelf can_do meet
objective: avoid meet
"""

APART = """poi "desk"
poi "shelf"
connect desk and shelf distance 2
event "sing"
agent "bot" controllable mobile 2 location desk can_do sing
agent "visitor" mobile 1 location shelf
objective: bot never_with visitor
"""

LOCKED = """poi "desk"
poi "shelf"
connect desk and shelf distance 2
event "open"
event "fetch" location shelf
rule "order": open before fetch
agent "bot" controllable mobile 2 location desk can_do fetch
agent "visitor" location shelf can_do open
reach_objective: do fetch
"""

TOLD = """poi "desk"
poi "shelf"
connect desk and shelf distance 2
event "lock"
event "fetch" location shelf duration 2
state "locked": initially false, true_if lock
stateDependency: fetch only_if locked is_false
agent "bot" controllable mobile 2 location desk can_do fetch
agent "visitor" location shelf can_do lock
reach_objective: do fetch after 1
"""

HAGGLER = """poi "desk"
poi "shelf"
connect desk and shelf distance 2
event "shout"
event "hush"
event "knock"
event "sign"
event "serve"
rule "order": (knock or sign) before serve
state "loud": initially false, true_if shout false_if hush
stateDependency: knock only_if loud is_true
stateDependency: sign only_if loud is_false
agent "bot" controllable mobile 1 location desk can_do knock, sign, serve
agent "guest" mobile 2 location shelf can_do shout, hush
reach_objective: do serve
"""

ROUND = """poi "desk"
poi "door"
poi "shelf"
connect desk and door distance 3
connect door and shelf distance 3
connect shelf and desk distance 2 one_way
event "call"
event "fetch" location shelf
event "give" location desk
rule "order": call before (fetch before give)
agent "bot" controllable mobile 1 location shelf can_do fetch, give
agent "guest" location desk can_do call
objective: if call then give within 9
"""

CALLS = """poi "desk"
event "call" at_most 2 times
event "serve" at_most 1 times
rule "order": call before serve
agent "bot" controllable location desk can_do serve
agent "guest" location desk can_do call
objective: if call then serve within 5
"""

WINDOWS = CALLED.format(deadline=12).replace("mobile 1", "mobile 2").replace(
    "objective", "travel bot from desk to shelf takes 4 to 11\nobjective"
)

SLOW = CALLED.replace("mobile 1", "mobile 3").format(deadline=6)


BAR = """poi "bar"
poi "room"
connect bar and room distance 4
event "call" location room
event "serve" location room duration 2
event "stock" location bar duration 1
rule "orders": stock before serve
agent "bot" controllable mobile 1 location bar can_do serve, stock
agent "guest" location room can_do call
objective: if call then serve within 15
"""

ASSUMED_TWICE = CALLS.replace("call\" at_most 2 times", "call\"") + "assume: guest does call at_most 2 times\n"

WALKS_IN = """poi "hall"
poi "yard"
connect hall and yard distance 2
event "ask"
event "prune" location hall duration 20
agent "bot" controllable mobile 1 location hall can_do prune
agent "guest" mobile 1 location yard can_do ask
objective: avoid guest at hall and bot doing prune
objective: if ask then prune within 60
"""

LINGERING = """poi "hall"
poi "gate"
connect hall and gate distance 2
event "greet" collaborative location gate
agent "bot" controllable mobile 1 location gate can_do greet
agent "guest" mobile 1 location hall reacts_to greet
assume: guest leaves hall within 30
assume: guest never at hall
reach_objective: do greet within 25
"""


def edited(text: str, rules: Rules, change: Change, value: str) -> Tuple[str, Rules]:
    """The scenario's text and the rules with the change made to that value, as a person would make it."""
    if change.what == "ends":
        return text, replace(rules, ends=value, slack={})
    if change.what == "reaction":
        return text, replace(rules, reaction=Fraction(value))
    if change.what == "slack":
        return text, replace(rules, slack={**rules.slack, change.name: int(value)})
    if change.what == "game":
        return text, IDEAL
    if change.what == "assumption" and change.before == "0":
        return text.rstrip() + "\n" + re.sub(r"\d+", value, change.sentence) + "\n", rules
    assert change.span is not None
    lines = text.splitlines()
    at = change.span.line - 1
    words = {"deadline": "within", "agent": "mobile"}
    words.update((word, word) for word in ("within", "after", "duration", "distance"))
    if change.what == "duration" and change.before == "0":
        lines[at] += f" duration {value}" if value != "0" else ""
    elif change.what in ("latest", "earliest"):
        pattern = rf"to {change.before}\b" if change.what == "latest" else rf"duration {change.before}\b"
        assert re.search(pattern, lines[at])
        lines[at] = re.sub(pattern, pattern[:-2].replace(change.before, value), lines[at])
    elif change.what == "travel":
        low, high = (int(number) for number in re.findall(r"\d+", lines[at]))
        less, more = (min(low, int(value) - 1), int(value)), (int(value), max(high, int(value) + 1))
        new = less if change.before == str(high) else more
        lines[at] = lines[at].replace(f"takes {low} to {high}", f"takes {new[0]} to {new[1]}")
    elif change.what in words:
        word = words[change.what]
        assert f"{word} {change.before}" in lines[at]
        lines[at] = lines[at].replace(f"{word} {change.before}", f"{word} {value}")
    elif change.what == "times":
        assert f"at_most {change.before} times" in lines[at]
        lines[at] = lines[at].replace(f"at_most {change.before} times", f"at_most {value} times")
    elif change.what == "assumption":
        lines[at] = re.sub(rf"\b{change.before}\b", value, lines[at])
    elif change.what == "direction":
        lines[at] = lines[at].replace(" one_way", "")
    elif change.what == "control":
        lines[at] = re.sub(r'(agent "\w+")', r"\1 human controllable", lines[at])
    else:
        assert change.what in ("rule", "dependency", "condition")
        lines[at] = lines[at].partition(" only_if")[0] if change.what == "condition" else ""
    return "\n".join(lines), rules


def wins(text: str, rules: Rules) -> bool:
    scenario = parse(text, "x.pur")
    return solve(played(translate(scenario), rules), scenario_objective(scenario), rules.reaction).won


def check_claims(text: str, rules: Rules, explanation: Explanation) -> None:
    assert not wins(text, rules)
    for change in explanation.changes:
        assert wins(*edited(text, rules, change, change.after)), change.sentence
        if change.next_lost != change.before:
            assert not wins(*edited(text, rules, change, change.next_lost)), change.sentence
            if change.least:
                step = abs(Fraction(change.after) - Fraction(change.next_lost))
                assert step == (rules.reaction / 10 if change.what == "reaction" else 1)


SMALL = {
    "deadline 3": (CALLED.format(deadline=3), DEFAULT),
    "deadline 4": (CALLED.format(deadline=4), DEFAULT),
    "deadline 4, late": (CALLED.format(deadline=5), Rules(slack={"bot": 2})),
    "deadline 5, slow to react": (CALLED.format(deadline=5), Rules(reaction=Fraction(3))),
    "ideal, deadline 3": (CALLED.format(deadline=3), IDEAL),
    "one way": (ROUND, DEFAULT),
    "windows": (WINDOWS, DEFAULT),
    "two calls": (CALLS, DEFAULT),
    "calls without a pause": (BAR, DEFAULT),
    "calls with a short pause": (BAR + "assume: guest waits 6 between call\n", DEFAULT),
    "calls assumed too often": (ASSUMED_TWICE, DEFAULT),
    "a guest who may stay": (LINGERING, DEFAULT),
    "a guest who walks in": (WALKS_IN, DEFAULT),
    "slow": (SLOW, DEFAULT),
    "shy": (SHY, DEFAULT),
    "shy, ideal": (SHY, IDEAL),
    "apart": (APART, DEFAULT),
    "locked": (LOCKED, DEFAULT),
    "told": (TOLD, DEFAULT),
    "haggler": (HAGGLER, DEFAULT),
    "haggler, ideal": (HAGGLER, IDEAL),
}


@functools.lru_cache(maxsize=None)
def explained(name: str) -> Explanation:
    text, rules = SMALL[name]
    return explain(parse(text, "x.pur"), rules, Limits(PLENTY))


@pytest.mark.parametrize("name", SMALL)
def test_each_change_that_is_claimed_wins_and_the_next_smaller_one_does_not(name: str) -> None:
    explanation = explained(name)
    assert explanation.changes and explanation.play and not explanation.undecided
    check_claims(*SMALL[name], explanation)
    assert json.loads(json.dumps(as_json(explanation)))["changes"][0]["sentence"] == explanation.changes[0].sentence


@pytest.mark.parametrize(
    "name, claim",
    [
        ("calls without a pause", "assume: guest waits 20 between call"),
        ("calls with a short pause", "assume: guest waits 20 between call instead of 6"),
        ("calls assumed too often", "assume: guest does call at_most 1 times instead of 2"),
        ("a guest who may stay", "assume: guest leaves hall within 21 instead of 30"),
        ("a guest who walks in", "assume: guest never at hall"),
    ],
)
def test_what_more_has_to_be_assumed_of_others_is_a_statement(name: str, claim: str) -> None:
    assert [change.sentence for change in explained(name).changes if change.what == "assumption"] == [claim]


@pytest.mark.parametrize("name", ["EB1", "WC2a", "CT3a"])
def test_the_claims_about_the_published_scenarios_hold(reference_dir: Path, name: str) -> None:
    text = (reference_dir / name / "scenario.pur").read_text()
    explanation = explain(parse(text, "x.pur"), DEFAULT, Limits(PLENTY, work=150_000_000))
    check_claims(text, DEFAULT, explanation)
    found = {(change.what, change.name): (change.after, change.next_lost) for change in explanation.changes}
    if name == "EB1":
        assert found["deadline", "officeClean"] == ("46", "45")
        assert explanation.play[-1].text == "no officeClean within 20 of callBot"
        assert sum(line.text.startswith("does callBot") for line in explanation.play) == 2
    if name == "CT3a":
        assert found["agent", "thief"][0] == "2"
        assert explanation.play[-1].text.endswith("catch can always be prevented")


def rendered(name: str) -> str:
    return render(explained(name))


def told(name: str) -> str:
    text = rendered(name)
    return re.split("Each of these|What else|Not enough", text[text.index("How it goes wrong") :])[0]


def tried(name: str) -> str:
    return rendered(name).split("could begin with, and why that fails:\n")[1].split("Not enough")[0]


def test_a_missed_deadline_is_reported_step_by_step() -> None:
    assert told("deadline 3") == (
        "How it goes wrong, for example: visitor prevents it (times in units):\n"
        "  1.1  visitor: does callBot (fetch is due by 4.1)\n"
        "  1.1  bot: sets off from desk to shelf\n"
        "  4.1  bot: arrives at shelf\n"
        "  4.1  no fetch within 3 of callBot\n"
    )


def test_an_event_that_was_to_be_avoided_is_reported() -> None:
    assert told("shy").endswith("meet has happened, which was to be avoided\n")


def test_agents_that_were_to_be_apart_are_reported_where_they_met() -> None:
    assert told("apart").endswith("bot and visitor are together, both at desk\n")


def test_an_agent_that_need_not_help_is_named() -> None:
    assert told("locked").endswith(
        "nobody has to do anything any more, and fetch need never come\n"
        "  6.1  these could still happen, and need not: visitor does open\n"
    )


def test_a_robot_that_can_do_nothing_alone_is_reported(reference_dir: Path) -> None:
    text = (reference_dir / "WC2a" / "scenario.pur").read_text()
    last = explain(parse(text, "x.pur"), DEFAULT, Limits(PLENTY)).play[-1].text
    assert last == (
        "the robots can do nothing before one of these, and none of them needs to happen: human begins screwH"
    )


def test_a_change_that_only_moves_the_problem_is_no_claim() -> None:
    explanation = explained("deadline 3")
    assert "desk and shelf at distance 1 instead of 2" in explanation.lost
    assert not any(change.what == "distance" for change in explanation.changes)


def test_without_a_budget_nothing_is_claimed() -> None:
    explanation = explain(parse(SMALL["slow"][0], "x.pur"), DEFAULT, Limits(work=1))
    assert explanation.changes == explanation.lost == explanation.play == ()
    assert "a later deadline" in explanation.undecided
    text = render(explanation)
    assert "Not decided within the limits: " in text and "a play that shows it" in text


def test_the_ends_can_be_the_plans_or_the_reaction_shorter() -> None:
    changes = explained("deadline 4").changes
    assert ("ends", CONTROLLABLE) in {(change.what, change.after) for change in changes}
    slow = explained("deadline 5, slow to react")
    (reaction,) = [change for change in slow.changes if change.what == "reaction"]
    assert Fraction(reaction.after) + Fraction(3, 10) == Fraction(reaction.next_lost)


def test_solve_and_ws_explain_a_lost_scenario_after_saying_so(tmp_path: Path) -> None:
    file = tmp_path / "called.pur"
    file.write_text(CALLED.format(deadline=3))
    for command in (["solve"], ["ws", "-o", str(tmp_path / "ws")]):
        outcome = pursue(*command, file)
        assert (outcome.status, outcome.out) == (4, "")
        assert outcome.err.count("SYN021") == 1
        assert outcome.err.index("SYN021") < outcome.err.index("a deadline of 5 instead of 3 for fetch")
        assert "deadline of 5" not in pursue(*command, file, "--no-explain").err
    assert not (tmp_path / "ws").exists()


def test_json_holds_the_explanation(tmp_path: Path) -> None:
    file = tmp_path / "called.pur"
    file.write_text(CALLED.format(deadline=3))
    verdict = json.loads(pursue("solve", file, "--json").out)
    assert verdict["won"] is False
    change = verdict["explanation"]["changes"][0]
    assert (change["what"], change["before"], change["after"], change["next_lost"]) == ("deadline", 3, 5, 4)
    assert (change["file"], change["line"]) == (str(file), 8)
    first = {"at": 1.1, "who": "visitor", "text": "does callBot (fetch is due by 4.1)"}
    assert verdict["explanation"]["play"][0] == first
    assert "explanation" not in json.loads(pursue("solve", file, "--json", "--no-explain").out)


# The cheapest first, whatever the machine does ------------------------------------------------------------------------


def test_small_numbers_come_first_and_what_no_robot_can_do_last() -> None:
    changes = explained("slow").changes
    numbers = [change for change in changes if change.before.isdigit() and change.after.isdigit()]
    ratios = [max(int(c.before), int(c.after)) / min(int(c.before), int(c.after)) for c in numbers]
    assert len(numbers) > 1 and ratios == sorted(ratios)
    assert tuple(numbers) == changes[: len(numbers)]
    mixed = explained("deadline 4").changes
    kinds = [change.what for change in mixed]
    assert kinds.index("deadline") < kinds.index("control") < kinds.index("ends")


def test_seconds_that_nobody_has_set_end_no_explanation() -> None:
    scenario = parse(SMALL["deadline 3"][0], "x.pur")
    assert explain(scenario, DEFAULT, Limits(1e-9, by_default=True)) == explain(scenario, DEFAULT)
    assert explain(scenario, DEFAULT, Limits(1e-9)).changes == ()


# What else the robots could begin with --------------------------------------------------------------------------------


def test_other_beginnings_fail_for_a_reason() -> None:
    assert tried("deadline 3") == (
        "  - the robots wait: visitor does callBot at 1.1; no fetch within 3 of callBot (4.1)\n"
    )
    assert tried("locked") == (
        "  - the robots wait: nobody has to do anything any more, and fetch need never come (0)\n"
    )


def test_a_robot_may_begin_in_each_way_that_it_has() -> None:
    text = CALLED.format(deadline=3).replace("connect", 'poi "door"\nconnect desk and door distance 1\nconnect', 1)
    explanation = explain(parse(text, "x.pur"), DEFAULT, Limits(PLENTY))
    moves = [line.text for line in explanation.play if line.who == "bot"]
    begun = {attempt.first for attempt in explanation.attempts} | {f"bot {moves[0]}"}
    assert begun == {"the robots wait", "bot sets off from desk to shelf", "bot sets off from desk to door"}
    assert all("no fetch within 3" in attempt.why for attempt in explanation.attempts)


def test_json_holds_the_attempts() -> None:
    found = as_json(explained("deadline 3"))
    why = "visitor does callBot at 1.1; no fetch within 3 of callBot (4.1)"
    assert json.loads(json.dumps(found))["attempts"] == [{"first": "the robots wait", "why": why}]


# Actions without end --------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", ["haggler", "haggler, ideal"])
def test_a_loss_by_actions_without_end_is_called_so(name: str) -> None:
    explanation = explained(name)
    assert [(one.agent, one.events) for one in explanation.endless] == [("guest", ("shout", "hush"))]
    text = render(explanation)
    assert text.startswith("Only actions without end prevent it: on its ways guest may do shout and hush")
    assert explanation.play[-1].text.endswith("no time passes, and the robots never get to act")
    lasting = {change.name for change in explanation.changes if change.what == "duration"}
    assert lasting == {"shout", "hush"}


@pytest.mark.parametrize("name", [name for name in SMALL if not name.startswith("haggler")])
def test_a_loss_in_which_time_passes_is_not(name: str) -> None:
    explanation = explained(name)
    assert explanation.endless == ()
    assert "without end" not in render(explanation)


def test_whoever_could_act_without_end_and_need_not_is_not_blamed() -> None:
    # The guest may shout without end on its way; but it is the clerk who need not open.
    text = HAGGLER.replace('rule "order":', 'event "open"\nrule "first": open before serve\nrule "order":')
    text = text.replace("reach_objective", 'agent "clerk" location desk can_do open\nreach_objective')
    assert explain(parse(text, "x.pur"), DEFAULT, Limits(PLENTY)).endless == ()


def test_who_wins_by_one_walk_is_shown_walking() -> None:
    explanation = explain(parse(errands_beside_a_visitor(6), "errands.pur", "errands"), DEFAULT)
    assert explanation.preventing == ("visitor",)
    walked = [line for line in explanation.play if line.who == "visitor"]
    assert walked and all("room1" in line.text or "hall" in line.text or "end" in line.text for line in walked)


def test_what_one_of_several_robots_cannot_keep_is_shown_with_that_robot() -> None:
    """The patrol of bot3, and that it is where person1 is: what the other robots could do is no matter to either."""
    scenario = parse(lab_scenario(3), "lab.pur", "lab")
    explanation = explain(scenario, DEFAULT, parts=[("obj", "obj4")])
    assert {line.who for line in explanation.play} & {"bot1", "bot2", "bot3"} == {"bot3"}
    assert explanation.preventing == ("person1",)
    assert any(change.what == "assumption" and change.name == "person1" for change in explanation.changes)

DEPOT = """poi "sorter" poi "gate1" poi "gate2" poi "gate3" poi "park"
connect sorter and gate1 distance 4 connect sorter and gate2 distance 5 connect sorter and gate3 distance 6
connect sorter and park distance 2 connect gate1 and gate2 distance 2 connect gate2 and gate3 distance 2
event "truck" location gate3 event "load" location sorter duration 3
event "drop1" location gate1 duration 2 event "drop2" location gate2 duration 2 event "drop3" location gate3 duration 2
rule "parcel" for each robot: load before (drop1 or drop2 or drop3)
agent "c1" controllable mobile 1 location park can_do load, drop1, drop3
agent "c2" controllable mobile 1 location park can_do load, drop2, drop3
agent "c3" controllable mobile 1 location park can_do load, drop1, drop3
agent "driver" location gate3 can_do truck
agent "officer" mobile 2 location sorter
objective: if truck then drop3 within 70
objective: avoid any robot at gate3 and officer at gate3
"""


def test_what_would_keep_somebody_away_is_found_though_the_game_is_large() -> None:
    found = explain(parse(DEPOT, "depot.pur", "depot"), DEFAULT, Limits(work=6_000_000))
    assert "assume: officer never at gate3" in [change.sentence for change in found.changes]
    assert [text for text in found.lost if "a deadline of" in text], "he may stay there for ever"


def test_what_no_robot_can_play_takes_no_work_from_what_can_be_changed() -> None:
    errands = parse(errands_beside_a_visitor(6), "errands.pur")
    found = findings(errands, DEFAULT, Budget(Limits(work=12_000_000)))
    assert "water_room1 lasting 1 instead of 3" in [change.sentence for change in found.changes]
    assert {"ends chosen by the plan", "ends chosen by the plan and no reaction"} <= set(found.undecided)


BARN = """unit second
poi "silo" poi "row_a" poi "row_b" poi "yard" poi "charger"
connect silo and row_a distance 20 connect silo and row_b distance 25 connect row_a and row_b distance 8
connect row_a and yard distance 15 connect silo and charger distance 5
agent "feeder" controllable mobile 1 location silo
battery feeder lasts 30 min, charges in 10 min at charger
objective: patrol row_a, row_b every 10 min by feeder
"""


def test_changes_are_found_where_only_a_policy_shows_that_they_win() -> None:
    """The exact game is too large for the budget: its clocks run to half an hour."""
    scenario = parse(BARN, "barn.pur", "barn")
    found = {change.what: change for change in findings(scenario, DEFAULT, Budget(Limits(work=3_000_000))).changes}
    patrol, charge = found["deadline"], found["charges"]
    assert not patrol.least and patrol.next_lost == patrol.before == "600"
    changes = ((f"every {patrol.after} s", "every 10 min"), (f"charges in {charge.after} s", "charges in 10 min"))
    for new, old in changes:
        changed = parse(BARN.replace(old, new), "barn.pur", "barn")
        assert solved(translate(changed), scenario_objective(changed), DEFAULT).strategy


CINEMA = """unit 1 s
poi "foyer" poi "bar" poi "booth" poi "closet"
connect foyer and bar distance 5 connect foyer and booth distance 9 connect foyer and closet distance 4
event "popcorn" location bar
event "refill" location bar duration 1 min
event "fetch" location closet duration 20
rule "corn": fetch before refill
agent "barman" location bar can_do popcorn
agent "guest" mobile 2 location foyer
agent "usher" controllable mobile 1 location foyer can_do fetch, refill
assume: barman waits 10 min between popcorn
objective: if popcorn then refill within 4 min
objective: if guest at booth then usher at booth within 1 min
"""


def test_a_later_deadline_is_found_where_only_a_policy_with_more_work_shows_that_it_wins() -> None:
    scenario = parse(CINEMA, "cinema.pur", "cinema")
    changes = findings(scenario, DEFAULT, Budget(Limits(work=14_000_000, states=50_000))).changes
    (change,) = (each for each in changes if each.what == "deadline")
    assert change.name == "usher at booth" and 60 < float(change.after) < 240
    text = CINEMA.replace("usher at booth within 1 min", f"usher at booth within {change.after}")
    changed = parse(text, "cinema.pur")
    assert solved(translate(changed), scenario_objective(changed), DEFAULT).strategy
