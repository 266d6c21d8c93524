"""The least period of patrols that name none."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any, List

import pytest

from pursue_gen.diagnostics import usage_error
from pursue_gen.language import parse
from pursue_gen.language.checks import check
from pursue_gen.language.scenario import Patrol, Scenario
from pursue_gen.language.sentences import objective_words, periods_found
from pursue_gen.outcomes import LimitHit
from pursue_gen.solving import periods
from pursue_gen.solving.inputs import settled
from pursue_gen.solving.options import SolveOptions
from pursue_gen.solving.periods import least_period, longest, with_period, without_period
from pursue_gen.solving.request import SolveRequest
from pursue_gen.solving.rules import DEFAULT, IDEAL
from pursue_gen.solving.solution import solve_scenario
from pursue_gen.synthesis.budget import Budget
from pursue_gen.synthesis.limits import Limits
from tests.patrols import corridor
from tests.tools.authoring.commands import pursue

from .verdicts import is_won

ROOMS = """\
poi "gate"
poi "hall"
poi "vault"
connect gate and hall distance 2
connect hall and vault distance 3
agent "bot1" controllable mobile 1 location gate
agent "bot2" controllable mobile 2 location vault
"""


def rooms(*objectives: str) -> Scenario:
    return parse(ROOMS + "\n".join(f"objective: {each}" for each in objectives) + "\n", "x.pur", "x")


def period(scenario: Scenario) -> int:
    (found,) = {each.known_limit for each in scenario.safety if isinstance(each, Patrol) and each.least is not None}
    return found


@pytest.mark.parametrize(
    "objective",
    [
        "patrol gate, hall by any robot",
        "patrol gate, hall, vault by bot2 or bot1",
        "patrol gate, vault, hall in order by bot1",
    ],
)
def test_the_period_that_is_found_is_won_and_the_next_shorter_one_is_lost(objective: str) -> None:
    found = least_period(rooms(objective), DEFAULT)
    every = period(found)
    assert is_won(found.text)
    assert f"every {every} by" in found.text
    assert not is_won(found.text.replace(f"every {every} by", f"every {every - 1} by"))
    assert periods_found(found)[0].startswith("The least period that can be promised for the patrol by ")
    assert solve_scenario(found, DEFAULT).strategy.blocks


def test_it_depends_on_the_game() -> None:
    patrol = rooms("patrol gate, vault by bot1")
    assert period(least_period(patrol, IDEAL)) < period(least_period(patrol, DEFAULT))
    assert settled(patrol, SolveRequest(reaction="0", ends="controllable")) == least_period(patrol, IDEAL)


def test_several_patrols_get_one_period_and_others_keep_theirs() -> None:
    patrols = ("patrol gate, hall by bot1", "patrol vault by bot2", "patrol gate every 99 by bot1")
    found = least_period(rooms(*patrols), DEFAULT)
    assert [each.every for each in found.safety if isinstance(each, Patrol)].count(99) == 1
    assert period(found) > 2
    assert without_period(found) == ()


def test_the_text_with_the_period_means_the_same_and_keeps_its_lines() -> None:
    text = ROOMS + "objective: patrol gate,\n  vault // far away\n  by any robot objective: patrol hall by bot1\n"
    found = with_period(parse(text, "x.pur", "x"), 40)
    assert found.text.count("\n") == text.count("\n")
    again = parse(found.text, "x.pur", "x")
    assert [(p.place.name, p.every, p.who.robots) for p in again.safety if isinstance(p, Patrol)] == [
        ("gate", 40, True), ("vault", 40, True), ("hall", 40, False),
    ]  # fmt: skip
    assert again.safety[2].span.line == parse(text, "x.pur", "x").safety[2].span.line
    assert found.text.replace(" every 40", "") == text, "nothing else changes, comments neither"


@pytest.mark.parametrize("wanted", ["patrol r, hall by bot of r", "patrol r by any robot"])
def test_patrols_for_each_of_a_group_get_the_period_once_in_the_text(wanted: str) -> None:
    text = f"""poi "hall"
poi "a"
poi "b"
group "rooms": a, b
for each r in rooms: connect hall and r distance 2
for each r in rooms: agent "bot" of r controllable mobile 1 location r
for each r in rooms: objective: {wanted}
"""
    found = with_period(parse(text, "x.pur", "x"), 40)
    assert found.text == text.replace(" by ", " every 40 by ")
    assert [each.text for each in parse(found.text, "x.pur", "x").safety] == [each.text for each in found.safety]


def test_what_is_optional_stays_so_in_the_text_with_the_period() -> None:
    wanted = "optional 2 objective: patrol gate, hall in order{} by bot1 // now and then\n"
    found = with_period(parse(ROOMS + wanted.format(""), "x.pur", "x"), 40)
    assert found.text == ROOMS + wanted.format(" every 40")
    assert [each.optional for each in parse(found.text, "x.pur", "x").safety] == [2, 2]


def test_where_nothing_can_be_promised_that_is_said() -> None:
    walled = rooms("patrol gate, vault by bot1", "avoid bot1 at hall")
    found = least_period(walled, DEFAULT)
    assert period(found) == longest(walled)
    assert periods_found(found, won=False) == [
        f"No period up to {longest(walled)} units can be promised for the patrol by bot1."
    ]


def test_a_search_that_stops_early_says_what_is_known() -> None:
    asked = rooms("patrol gate, vault, hall by any robot")
    limits = [Limits(work=work) for work in (1, 8_000, 64_000, 512_000)]
    stopped = [least_period(asked, DEFAULT, SolveOptions(limits=limit)) for limit in limits]
    least = period(least_period(asked, DEFAULT))
    for found in stopped:
        (known, *_) = [each for each in found.safety if isinstance(each, Patrol)]
        assert known.least is not None and known.least <= least <= known.known_limit
    tours = period(stopped[0])
    assert f"is at most {tours} units; nothing below 2 can be promised." in periods_found(stopped[0])[0]
    assert is_won(stopped[0].text) and tours < longest(asked)


def test_the_search_leaves_half_of_the_limit_for_what_is_solved_then(monkeypatch: pytest.MonkeyPatch) -> None:
    given: List[Limits] = []

    class Watched(Budget):
        def __init__(self, limits: Limits, *others: Any, **more: Any) -> None:
            given.append(limits)
            super().__init__(limits, *others, **more)

    monkeypatch.setattr("pursue_gen.solving.periods.Budget", Watched)
    least_period(rooms("patrol gate, hall by bot1"), DEFAULT, SolveOptions(limits=Limits(seconds=100.0, spent=20.0)))
    assert [each.left for each in given] == [40.0]


def test_the_limit_of_a_command_is_for_the_search_and_for_what_is_solved_then(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    """What the search has taken is not there for the rest."""
    file = tmp_path / "rooms.pur"
    file.write_text(ROOMS + "objective: patrol gate, hall by bot1\n", encoding="utf-8")
    left: List[float] = []

    def searched(scenario: Scenario, request: SolveRequest, *_: Any) -> Scenario:
        return with_period(scenario, 40)

    def solved(scenario: Scenario, request: SolveRequest, *_: Any) -> None:
        left.append(request.options.limits.left)
        raise usage_error("that is enough", "")

    monkeypatch.setattr("pursue_gen.solving.inputs.settled", searched)
    monkeypatch.setattr("pursue_gen.solving.optional.promised_of", solved)
    pursue("solve", file, "--limit", "10")
    assert left and 0 < left[0] < 10


def test_a_search_among_other_promises_that_stops_early_has_the_longest_period() -> None:
    asked = rooms("patrol gate, vault by any robot", "avoid bot1 at hall")
    stopped = least_period(asked, DEFAULT, SolveOptions(limits=Limits(work=1)))
    assert f"is at most {longest(asked)} units; nothing below 2 can be promised." in periods_found(stopped)[0]


def test_of_many_places_the_period_is_that_of_tours() -> None:
    asked = parse(corridor(6, 2, ""), "x.pur", "x")
    found = least_period(asked, DEFAULT)
    assert periods_found(found) == [
        "The least period for the patrol by any robot is at most 45 units; nothing below 26 can be promised."
    ]
    assert [tour.robot for tour in solve_scenario(found, DEFAULT).strategy.tours] == ["bot1", "bot2"]


def test_the_commands_tell_it_and_a_workspace_has_it(tmp_path: Path) -> None:
    file = tmp_path / "rooms.pur"
    file.write_text(ROOMS + "objective: patrol gate, hall by bot1\n", encoding="utf-8")
    every = period(least_period(rooms("patrol gate, hall by bot1"), DEFAULT))
    told = f"The least period that can be promised for the patrol by bot1 is {every} units."
    assert told in pursue("check", file).err and told in pursue("solve", file).err
    assert json.loads(pursue("solve", file, "--json").out)["period"] == {"every": every, "least": every}
    made = pursue("ws", file, "-o", tmp_path / "ws")
    assert made.status == 0, made.err
    game = (tmp_path / "ws" / "src" / "observer" / "config" / "game.yaml").read_text(encoding="utf-8")
    assert f"patrol gate, hall every {every} by bot1" in game
    assert pursue("tga", file, "-o", tmp_path).status == pursue("sim", file, "--runs", 1, "--until", 40).status == 0
    assert pursue("play", file, stdin=b"").status == 0


def test_the_scenario_says_that_the_period_is_the_least() -> None:
    asked = rooms("patrol gate by bot1")
    assert objective_words(asked) == ["bot1 is at gate as often as can be promised."]
    assert objective_words(least_period(asked, DEFAULT)) == [
        "bot1 is at gate at least every 2 units, the least that can be promised."
    ]
    assert check(asked) == ()


LIFT = """\
unit second

poi "hall"
poi "shop"
poi "cabin1"
poi "cabin2"
poi "room1"
poi "room2"

connect hall and shop distance 20
connect hall and cabin1 distance 6
connect cabin1 and cabin2 distance 8
connect cabin2 and room1 distance 12
connect cabin2 and room2 distance 9

agent "bot1" controllable speed 0.5 location hall
agent "bot2" controllable speed 0.5 location room1

objective: always at_most 1 robots at cabin1, cabin2
objective: patrol shop, hall, room1, room2 by any robot
"""


def test_beside_another_promise_the_period_is_about_what_tours_keep() -> None:
    assert period(least_period(parse(LIFT, "lift.pur", "lift"), DEFAULT)) <= 150
    alone = parse(LIFT.replace("objective: always at_most 1 robots at cabin1, cabin2\n", ""), "lift.pur", "lift")
    assert period(least_period(alone, DEFAULT)) <= period(least_period(parse(LIFT, "lift.pur", "lift"), DEFAULT))


def test_where_tours_keep_a_period_exact_games_get_little_work(monkeypatch: pytest.MonkeyPatch) -> None:
    asked: List[float] = []

    def undecided(*given: Any) -> None:
        asked.append(given[4])
        raise LimitHit([])

    monkeypatch.setattr(periods, "strategy_of", undecided)
    least_period(parse(LIFT, "lift.pur", "lift"), DEFAULT)
    least_period(rooms("patrol gate, hall, vault in order by bot1"), DEFAULT)  # no tours
    assert asked[0] < 0.05 < asked[-1]


def test_a_patrol_that_ends_with_the_goal_may_be_shorter_than_any_tour() -> None:
    text = LIFT.replace("objective: always at_most 1 robots at cabin1, cabin2", 'event "wave" location hall')
    text = text.replace("speed 0.5 location hall", "speed 0.5 location hall can_do wave")
    found = least_period(parse(f"{text}reach_objective: do wave\n", "lift.pur", "lift"), DEFAULT)
    assert period(found) == 2 and is_won(found.text)
