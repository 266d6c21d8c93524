"""A mission as a timeline: every movement, action and wait is there, at its time, in its lane."""

from __future__ import annotations

import json
import subprocess
import sys
import xml.etree.ElementTree as ElementTree
from dataclasses import replace
from pathlib import Path
from typing import Dict, List, Tuple

import pytest
from hypothesis import given
from hypothesis import strategies as st
from missions import SCENARIOS, made_up, mission

from pursue_gen.tools.replay import read_recording
from pursue_gen.tools.replay.record import MissionRecord
from pursue_gen.tools.report.html import page
from pursue_gen.tools.report.recording import from_states, lasting, stays
from pursue_gen.tools.report.timeline import draw, section
from pursue_gen.vocabulary.promises import promise_names
from pursue_runtime.state import HOLDING, RUNNING, WAITING, WON, SystemState

SVG = "{http://www.w3.org/2000/svg}"


def lanes(svg: str) -> Dict[str, ElementTree.Element]:
    """The lanes of a picture by their names, from above."""
    groups = ElementTree.fromstring(svg).iter(f"{SVG}g")
    return {g.get("data-lane", ""): g for g in groups if g.get("class") == "lane"}


def tooltips(lane: ElementTree.Element, kind: str) -> List[str]:
    """The tooltips of the parts of a kind: bar, wait, instant, box, turn."""
    parts = (g for g in lane.iter(f"{SVG}g") if g.get("class") == kind)
    return [title.text or "" for g in parts for title in g.iter(f"{SVG}title")]


def ends(lane: ElementTree.Element) -> List[Tuple[float, float]]:
    """From where to where the bars of a lane reach, in pixels."""
    bars = (g for g in lane.iter(f"{SVG}g") if g.get("class") == "bar")
    rects = (rect for g in bars for rect in g.iter(f"{SVG}rect"))
    return [(float(r.get("x", 0)), float(r.get("x", 0)) + float(r.get("width", 0))) for r in rects]


def words(svg: str) -> List[str]:
    return [element.text or "" for element in ElementTree.fromstring(svg).iter(f"{SVG}text")]


def test_there_is_a_lane_for_each_agent_objective_state_and_rule() -> None:
    four = lanes(draw(mission("thesis/scenario_4")))
    assert list(four) == ["bot1", "bot2", "bot3", "bot4", "bot4_Finish", "rule1", "rule2"]
    said = [turn.partition(",")[0] for turn in tooltips(four["bot4_Finish"], "turn")]
    assert said[-2:] == ["bot4_Finish to be done", "reached"]
    assert list(lanes(draw(mission("ecobot/ecobot")))) == [
        "ecoBot", "clerk", "bin", "officeClean", "makingTrash", "pickingUp", "throwingPaper"]


def test_objectives_are_called_by_what_differs() -> None:
    found = list(lanes(draw(mission("hotel/two_bells"))))
    assert {"serveEast", "serveWest"} <= set(found) and not [name for name in found if "deadline" in name]


def test_an_objective_without_a_limit_is_kept_until_it_is_broken() -> None:
    made = mission("office/library")
    (kept,) = tooltips(lanes(draw(made))["place archive holds 1 robot"], "turn")
    assert kept == "kept, 0 to the end"
    (name,) = (name for name, text in promise_names(made.scenario).items() if text == "place archive holds 1 robot")
    steps = [replace(each, locations={**each.locations, name: "lose"}) if each.at > 50 else each for each in made.steps]
    lane = lanes(draw(replace(made, steps=tuple(steps))))["place archive holds 1 robot"]
    (broken,) = tooltips(lane, "box")
    assert broken.startswith("broken, ") and broken.endswith("to the end")


def test_movements_actions_and_waits_stand_in_their_order() -> None:
    made = made_up(
        (1.0, "bot1", "bot1_c2b", {"bot1": "going_c_to_b"}, RUNNING),
        (10.5, "bot1", "bot1_going_c_to_b2b", {"bot1": "b"}, RUNNING),
        (12.0, "bot1", "bot1_inb", {"bot1": "doing_bot1_inb_in_b"}, RUNNING),
        (15.25, "bot1", "bot1_inbDONE", {"bot1": "b"}, RUNNING),
    )
    lane = lanes(draw(made))["bot1"]
    assert tooltips(lane, "bar") == ["from c → b, 1 to 10.5", "bot1_inb at b, 12 to 15.25"]
    assert tooltips(lane, "wait") == ["at c, 0 to 1", "at b, 10.5 to 12", "at b, 15.25 to the end"]
    (a, b), (c, d) = ends(lane)
    unit = (b - a) / 9.5
    assert (d - c) == pytest.approx(3.25 * unit, abs=0.05)
    assert (c - b) == pytest.approx(1.5 * unit, abs=0.05)


def test_what_takes_no_time_is_a_mark() -> None:
    lane = lanes(draw(mission("thesis/catch_the_thief")))["polBot2"]
    (mark,) = tooltips(lane, "instant")
    assert mark.startswith("polBot2: catch at ")


def test_deadlines_run_until_they_are_met() -> None:
    made = mission("ecobot/ecobot")
    boxes = tooltips(lanes(draw(made))["officeClean"], "box")
    begun = [stay.start for stay in stays(made, "obj") if stay.what == "atRisk"]
    assert begun and len(boxes) == len(begun)
    for box, start in zip(boxes, begun):
        due = float(box.partition("due by ")[2].partition(",")[0])
        assert due == pytest.approx(start + 46, abs=0.01)


def test_rules_tell_whose_turn_it_is() -> None:
    turns = tooltips(lanes(draw(mission("thesis/scenario_1")))["rule1"], "turn")
    assert [turn.partition(",")[0] for turn in turns] == [
        "next: bot1_inb", "bot1_inb goes on", "next: bot2_ina", "bot2_ina goes on", "next: bot1_inb"]


def test_what_is_not_known_yet_is_told() -> None:
    lane = lanes(draw(mission("warehouse/which_shelf")))["onA"]
    (unknown,) = tooltips(lane, "turn")
    assert unknown.startswith("unknown, 0 to ")


def test_a_state_has_one_lane_also_where_conditions_ask_for_it() -> None:
    found = list(lanes(draw(mission("warehouse/which_shelf"))))
    assert found.count("onA") == 1 and not [name for name in found if "is_true" in name]


def test_a_pause_lasts_from_the_end_of_one_event() -> None:
    made = mission("work_cell/glue")
    boxes = tooltips(lanes(draw(made))["pause: glue → pack"], "box")
    ends = [step.at for step in made.steps if step.event == "glueDONE"]
    until = [float(box.partition("not before ")[2].partition(",")[0]) for box in boxes]
    assert ends and until == [pytest.approx(end + 20, abs=0.01) for end in ends]


def test_the_end_is_marked() -> None:
    made = mission("thesis/scenario_1")
    assert any(word.startswith("goal reached, ") for word in words(draw(made)))
    assert any(word.startswith("end of the recording, 150") for word in words(draw(mission("ecobot/ecobot"))))


def test_holding_and_new_plans_have_a_lane_where_there_are_any() -> None:
    made = made_up((4.0, "", "", {}, HOLDING), (9.0, "", "", {}, RUNNING))
    made = replace(made, steps=(*made.steps[:2], replace(made.steps[2], plan=1)))
    lane = lanes(draw(made))["course"]
    assert tooltips(lane, "box") == ["holding, 4 to 9"]
    assert "plan 1" in [element.text for element in lane.iter(f"{SVG}text")]
    assert "course" not in lanes(draw(made_up()))


def test_hostile_names_stay_text() -> None:
    made = made_up((4.0, "bot1", "<script>alert(1)</script>&\x01", {}, RUNNING))
    svg = draw(replace(made, source="<img src=x>"))
    ElementTree.fromstring(svg)
    assert "<script>" not in svg and "<img" not in svg


def test_the_same_mission_gives_the_same_bytes() -> None:
    made = mission("thesis/scenario_2", "still", 5)
    mission.cache_clear()
    again = mission("thesis/scenario_2", "still", 5)
    assert again is not made
    assert draw(again) == draw(made)


def test_a_part_of_a_page_has_the_steps_as_a_table() -> None:
    made = mission("thesis/scenario_1")
    part = section(made)
    assert part.body_html.count("<tr>") == len(made.steps) + 1
    assert "bot1</td><td>sets off from c to b" in part.body_html
    assert part.id in page("t", [part])


@given(st.lists(st.tuples(st.floats(0, 100), st.sampled_from("abc")), min_size=1, max_size=12))
def test_what_lasts_follows_on_each_other_without_gaps(changes: List[Tuple[float, str]]) -> None:
    ordered = sorted(changes, key=lambda pair: pair[0])
    made = made_up(end=100.0)
    found = lasting(made, ordered)
    assert found[-1].end == 100.0 and not found[-1].over
    for one, other in zip(found, found[1:]):
        assert one.end == other.start and one.over
    assert sum(stay.end - stay.start for stay in found) == pytest.approx(100 - ordered[0][0])


def test_recorded_states_become_steps_once_each() -> None:
    made = made_up()
    here = {"locations": made.steps[0].locations, "values": made.steps[0].values, "clocks": {}}
    states = [
        SystemState(3, 114.0, agent="bot1", event="bot1_c2b", unit=2.0, **here),
        SystemState(0, 100.0, status=WAITING, unit=2.0, **here),
        SystemState(1, 110.0, unit=2.0, **here),
        SystemState(1, 110.0, unit=2.0, **here),
        SystemState(4, 120.0, status=WON, unit=2.0, **here),
    ]
    found = from_states(states, made.scenario, made.network, "a bag", until=50.0)
    assert found is not None
    assert [step.at for step in found.steps] == [0.0, 2.0, 5.0]
    assert (found.end, found.status) == (5.0, WON)
    assert from_states(states[1:2], made.scenario, made.network, "a bag") is None


def test_a_bag_is_drawn_as_it_was(tmp_path: Path) -> None:
    pytest.importorskip("rosbags", reason="rosbags is not installed")
    sys.path.append(str(Path(__file__).resolve().parent.parent / "replay"))
    import recordings

    bag = recordings.write_bag(recordings.mission(), tmp_path / "mission.bag")
    record, game = read_recording(bag), recordings.game()
    assert isinstance(record, MissionRecord)
    made = from_states(record.states, game.scenario, game.network, bag.name)
    assert made is not None and made.status == WON
    found = lanes(draw(made))
    assert tooltips(found["bot1"], "bar") == ["from c → b, 1.1 to 10.4", "bot1_inb at b, 11.5 to 14.8"]
    assert tooltips(found["bot2"], "bar") == ["from c → a, 1.1 to 10.9", "bot2_ina at a, 14.9 to 21.3"]


# The commands ---------------------------------------------------------------------------------------------------------


def run(*words_: str) -> "subprocess.CompletedProcess[str]":
    return subprocess.run([sys.executable, "-m", "pursue_gen", *words_], capture_output=True, text=True, check=False)


def test_sim_draws_one_mission(tmp_path: Path) -> None:
    scenario, out = str(SCENARIOS / "thesis" / "scenario_1.pur"), tmp_path / "mission.svg"
    assert run("sim", scenario, "--runs", "1", "--timeline", str(out)).returncode == 0
    assert list(lanes(out.read_text(encoding="utf-8"))) == ["bot1", "bot2", "bot2_ina", "rule1"]
    refused = run("sim", scenario, "--timeline", str(tmp_path / "other.svg"))
    assert refused.returncode == 2 and "--runs 1" in refused.stderr
    refused = run("sim", scenario, "--runs", "1", "--timeline", str(tmp_path / "mission.pdf"))
    assert refused.returncode == 2 and ".svg" in refused.stderr


def test_replay_draws_a_journal(tmp_path: Path) -> None:
    file, out = tmp_path / "journal.jsonl", tmp_path / "mission.html"
    entries = [
        {"format": 1, "scenario": "scenario_1", "unit": 1.0},
        {"at": 100.0, "call": "hear", "args": ["_start_"], "seq": 1, "status": "running"},
        {"at": 101.1, "call": "hear", "args": ["bot1:bot1_c2b@1"], "seq": 2, "status": "running"},
        {"at": 110.5, "call": "hear", "args": ["bot1:bot1_going_c_to_b2b"], "seq": 3, "status": "running"},
    ]
    file.write_text("".join(json.dumps(entry) + "\n" for entry in entries), encoding="utf-8")
    done = run("replay", str(file), str(SCENARIOS / "thesis" / "scenario_1.pur"), "--timeline", str(out))
    assert "shows the mission" in done.stderr
    assert "from c → b, 1.1 to 10.5" in out.read_text(encoding="utf-8")
