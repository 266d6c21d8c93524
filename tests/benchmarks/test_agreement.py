"""All who can tell who wins are asked, and what differs is noticed; the counts, and their table."""

from __future__ import annotations

import json
import re
import shutil
from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from typing import Dict, List, Optional, Type
from unittest import mock

import pytest

from benchmarks import agreement, agreement_page, opinions
from benchmarks.agreement import LAB, SCENARIO, VARIED, Job, add, compared, groups, lab, opinions_of, story, varied
from benchmarks.opinions import Opinions
from benchmarks.random_games import random_game
from pursue_gen.diagnostics import PursueError, error
from pursue_gen.outcomes import LimitHit, Lost, NotProven
from pursue_gen.proof.checker import ProofReport as Report
from pursue_gen.solving.rules import IDEAL
from pursue_gen.synthesis.limits import Limits
from pursue_gen.tga.network import Kind

pytestmark = pytest.mark.benchmark

EVERYBODY = {"plain", "python", "native", "in turn", "soonest", "regions", "python, proven", "command"}


def test_everybody_is_asked_of_a_small_game_and_strategies_are_proven_twice() -> None:
    network, objective = random_game(3, Kind.REACH)
    found = opinions.on_game(network, objective, IDEAL, 3)
    assert found is not None and found.agreed
    assert found.verdicts == dict.fromkeys(EVERYBODY, True) and found.proven == 2


def test_a_game_of_the_wrong_size_is_left_out() -> None:
    network, objective = random_game(3, Kind.REACH)
    assert opinions.on_game(network, objective, IDEAL, 1000) is None
    with mock.patch.object(opinions, "MOST", 3):
        assert opinions.on_game(network, objective, IDEAL, 3) is None


def test_scenarios_are_solved_as_a_whole_and_composed() -> None:
    found = opinions_of(Job(SCENARIO, "default", 6))
    assert found is not None and found.agreed
    assert found.verdicts["whole"] is found.verdicts["composed"] is found.verdicts["command"] is True
    assert found.proven == 3
    lost = opinions_of(Job(SCENARIO, "default", 3))
    assert lost is not None and lost.won is False and lost.verdicts["composed"] is None
    assert story(3) == story(3) != story(6)


def test_small_lab_scenarios_are_compared_with_the_game_in_one_piece() -> None:
    for number in range(100):
        found = opinions_of(Job(LAB, "default", number))
        assert found is not None and found.agreed
        if found.verdicts["whole"] and found.verdicts["command"]:
            break
    else:
        raise AssertionError("none of them is decided by both")
    assert found.proven and lab(number) != lab(number + 1)


def test_varied_scenarios_are_compared_where_they_are_decided_in_one_piece() -> None:
    found = [each for each in (opinions_of(Job(VARIED, "default", number)) for number in range(12)) if each]
    assert found and all(each.agreed and each.verdicts["whole"] is not None for each in found)
    assert any(each.verdicts["attempts"] for each in found) and any(each.proven for each in found)
    with mock.patch.object(opinions, "_VARIED", Limits(work=1)):
        assert opinions_of(Job(VARIED, "default", 0)) is None


def test_every_kind_of_statement_is_drawn_in_a_varied_scenario() -> None:
    drawn = " ".join("".join(varied(number) for number in range(400)).replace(":", " ").split())
    words = ("holds", "between", "escort", "in order", "optional", "lasts", "capacity", "travel", "rest", "twice")
    more = ("in all", "leaves", "stays", "by", "reaches", "never at", "stateDependency", "for each", "doing", "on_way")
    more += ("unknown", "may_stop", "parts", "takes", "open")
    assert not [word for word in (*words, *more) if f" {word} " not in drawn]
    assert re.search(r"location \w+ or ", drawn)


@pytest.mark.parametrize(
    ("verdicts", "faults", "agreed"),
    [
        ({"whole": True, "composed": True}, [], True),
        ({"whole": False, "composed": None}, [], True),
        ({"whole": False, "composed": True}, [], False),
        ({"whole": None, "few calls": False, "command": True}, [], False),
        ({"whole": True}, ["the checkers differ"], False),
    ],
)
def test_verdicts_that_differ_and_faults_count(
    verdicts: Dict[str, Optional[bool]], faults: List[str], agreed: bool
) -> None:
    assert Opinions(5, verdicts, faults=faults).agreed is agreed


def test_an_error_that_is_no_verdict_is_a_fault_and_a_limit_is_not() -> None:
    found = Opinions()

    def fails(outcome: Type[PursueError]) -> bool:
        raise outcome([error("SYN000", "a message")])

    assert found.ask("lost", lambda: fails(Lost)) is False
    assert found.ask("limit", lambda: fails(LimitHit)) is None and found.agreed
    assert found.ask("unproven", lambda: fails(NotProven)) is None
    assert not found.agreed and found.faults == ["unproven: a message"]


@pytest.mark.parametrize(
    ("first", "second", "fault"),
    [
        (Report(True, "", (), frozenset(), 5), Report(True, "", (), frozenset(), 5), ""),
        (Report(True, "", (), frozenset(), 5), Report(False, "no block", (), frozenset(), 4), "the checkers differ"),
        (Report(False, "no block", (), frozenset(), 5), Report(True, "", (), frozenset(), 5), "refuses it"),
    ],
)
def test_checkers_that_differ_or_refuse_are_faults(first: Report, second: Report, fault: str) -> None:
    found, won = Opinions(), mock.Mock()
    with mock.patch.object(opinions, "verify", side_effect=[first, second]):
        found.check("command", won)
    assert fault in "".join(found.faults) and bool(found.faults) is bool(fault)
    assert (found.proven, found.half_proven, found.unproven) == (int(first.ok), 0, 0)


def test_large_strategies_are_looked_at_by_the_native_checker_alone_and_counted_apart() -> None:
    found, won = Opinions(), mock.Mock()
    large = Report(True, "", (), frozenset(), 10_000)
    with mock.patch.object(opinions, "verify", side_effect=[large, replace(large, ok=False, reason="limit: x")]):
        found.check("command", won)
        found.check("command", won)
    assert (found.proven, found.half_proven, found.unproven) == (0, 1, 1) and found.agreed


def test_games_are_counted_and_what_differs_is_printed(capsys: pytest.CaptureFixture[str]) -> None:
    row = compared("reach", "ideal", 3, 1)
    assert row["games"] == row["won"] + row["lost"] + row["undecided"] == 3 and not row["differ"]
    assert row["decided_by"]["native"] == 3
    add(row, 77, Opinions(40, {"whole": False, "composed": True}, stages=True))
    assert row["games"] == 4 and row["differ"] == [77] and row["stages"] == 1
    assert "reach, ideal, number 77" in capsys.readouterr().out


def test_the_groups_are_as_many_as_wanted() -> None:
    wanted = list(groups(10_000, 3_000))
    assert sum(count for name, _, count in wanted if name not in (SCENARIO, LAB)) >= 10_000
    assert sum(count for name, _, count in wanted if name == SCENARIO) == 3_000
    assert sum(count for name, _, count in groups(10_000, 3_000, 500) if name == LAB) == 500
    assert sum(count for name, _, count in groups(0, 0, 0, 700) if name == VARIED) == 700
    assert {game for _, game, _ in wanted} == set(agreement.GAMES) and agreement.GAMES["late"].reaction == Fraction(1)


def test_counts_are_kept_beside_those_of_other_groups(tmp_path: Path, project_root: Path) -> None:
    (tmp_path / "benchmarks").mkdir()
    shutil.copy(project_root / "docs" / "benchmarks" / "results.json", tmp_path / "benchmarks")
    file = tmp_path / "benchmarks" / "results.json"
    file.write_text(json.dumps({**json.loads(file.read_text()), "agreement": {}}))
    rows = [compared("reach", "ideal", 0, 1), compared(SCENARIO, "default", 0, 1)]
    for row in rows:
        agreement.keep(tmp_path, [row])
    add(rows[0], 12, Opinions(40, {"plain": False, "native": True, "command": None}))
    with mock.patch("benchmarks.synthesis.version", return_value="newer"):
        agreement.keep(tmp_path, rows[:1])
    kept = json.loads(file.read_text())["agreement"]["rows"]
    assert [{key: found[key] for key in row} for found, row in zip(kept, rows)] == rows
    assert kept[0]["version"] == "newer" != kept[1]["version"], "each row is of the version that was compared"
    page = " ".join((tmp_path / "benchmarks.md").read_text().split())
    assert "**1 differ** (reach ideal 12)" in page and "At a limit: command 1." in page


def test_without_counts_the_page_says_how_they_are_made() -> None:
    assert "python -m benchmarks.agreement" in agreement_page.table({})
