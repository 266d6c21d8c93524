"""What the checker finds in missions in which something is not as it should be."""

from __future__ import annotations

from dataclasses import replace
from typing import Any, Dict, List, Tuple

import pytest
from recordings import PLAY, START, Mission, game, mission

from pursue_gen.partition import partition, strategy_data
from pursue_gen.tools.replay import Findings, MissionRecord, check
from pursue_gen.tools.replay.bag import Message
from pursue_gen.tools.replay.finding import FAULT, NOTE, WORLD
from pursue_gen.tools.replay.read import from_messages
from pursue_gen.tools.replay.record import read_word
from pursue_runtime.state import SystemState


def record(made: Mission, behind: float = 0.0) -> MissionRecord:
    """What a reader makes of the mission (the bag's bytes have tests of their own), recorded with a clock that is so
    many seconds behind."""
    import recordings

    messages = []
    for at, topic, node, what in made.messages():
        goal = topic.endswith("goal")
        data = recordings._pose(at, what) if goal else recordings._string(what)
        messages.append(Message(topic, "", node, at - behind, data))
    return from_messages(messages)


def found(made: Mission, **more: Any) -> Findings:
    """The findings of the mission."""
    return check(replace(record(made), **more), game())


def kinds(findings: Findings, *levels: str) -> List[Tuple[str, int]]:
    """(kind, state) of the findings of these levels (those that are worse than a note)."""
    return [(f.kind, f.seq) for f in findings.findings if f.level in (levels or (WORLD, FAULT))]


def test_a_mission_that_went_well_is_kept_and_won() -> None:
    findings = found(mission())
    assert (findings.kept, findings.won, findings.findings) == (True, True, ())
    assert findings.counts["commands"] == 5 and findings.counts["reports"] == 4
    assert findings.length == pytest.approx(21.3)
    assert [step.word.node for step in findings.steps if step.word] == [node for _, _, node in PLAY]


@pytest.mark.parametrize("unit", [0.1, 2.0])
def test_the_length_of_a_time_unit_is_the_missions(unit: float) -> None:
    findings = found(mission(unit=unit))
    assert findings.kept and findings.length == pytest.approx(21.3)


def play_with(moment: float, event: str) -> Mission:
    """The mission in which the event comes at another moment, and those after it by as much later."""
    here = next(k for k, (_, word, _) in enumerate(PLAY) if event in word)
    shift = moment - PLAY[here][0]
    return mission(tuple((at + shift * (k >= here), word, node) for k, (at, word, node) in enumerate(PLAY)))


def test_a_robot_that_is_early_or_late_left_the_model() -> None:
    early, late = found(play_with(9.0, "bot1_going_c_to_b2b")), found(play_with(12.0, "bot1_going_c_to_b2b"))
    assert ("early", 5) in kinds(early, WORLD) and not kinds(early, FAULT)
    assert ("late", 5) in kinds(late, WORLD)
    assert not early.kept and early.won


def test_within_the_tolerance_nobody_is_early() -> None:
    assert found(play_with(10.05, "bot1_going_c_to_b2b")).kept


def test_a_clock_that_drifts_is_a_fault() -> None:
    made = mission()
    clocks = dict(made.states[6].clocks)
    clocks["Cbot1"] += 0.002
    made.change(6, clocks=clocks)
    assert kinds(found(made)) == [("clock", 6)]
    made.change(6, clocks={**clocks, "Cbot1": clocks["Cbot1"] - 0.0015})
    assert kinds(found(made)) == []


def test_an_impossible_step_is_a_fault() -> None:
    made = mission()
    made.change(5, locations={**made.states[5].locations, "bot2": "b"})
    assert ("step", 5) in kinds(found(made), FAULT)


@pytest.mark.parametrize("missing", [(4,), (5,), (2, 3, 4), (6, 7), (9,)])
def test_missing_states_follow_from_the_words(missing: Tuple[int, ...]) -> None:
    made = mission()
    made.states = [state for state in made.states if state.seq not in missing]
    findings = found(made)
    assert findings.kept and findings.won, findings.findings
    assert kinds(findings, NOTE) == [("not recorded", seq) for seq in missing]


def test_missing_states_to_which_no_words_lead_are_a_fault() -> None:
    made = mission()
    made.states = [state for state in made.states if state.seq != 5]
    made.heard = [entry for entry in made.heard if entry[3] != "bot1_going_c_to_b2b"]
    assert ("gap", 6) in kinds(found(made), FAULT)


def test_a_wrong_command_in_a_gap_is_a_fault() -> None:
    made = play_with(11.02, "bot1_inb")
    made.states = [state for state in made.states if state.seq not in (6, 7)]
    assert ("command", 7) in kinds(found(made), FAULT)


def test_states_in_the_order_of_receipt_are_sorted() -> None:
    made = mission()
    read = record(made)
    messy = from_messages(
        [Message("pursue/system_state", "", "observer", 0.0, _text(state)) for state in reversed(made.states)]
    )
    assert [state.seq for state in messy.states] == [state.seq for state in read.states]


def _text(state: SystemState) -> bytes:
    import recordings

    return recordings._string(recordings.text_of(state))


def test_two_states_of_one_number_are_a_fault() -> None:
    made = mission()
    made.states.append(made.states[5]._replace(locations=made.states[6].locations))
    assert ("number", made.states[5].seq) in kinds(found(made), FAULT)


def test_heartbeats_are_nothing_new() -> None:
    made = mission()
    old = made.states[5]
    later = {clock: value + 0.25 for clock, value in old.clocks.items()}
    made.states.insert(6, old._replace(stamp=old.stamp + 0.25, clocks=later))
    assert found(made).kept


def test_what_was_said_twice_late_or_in_vain_is_reported_and_harms_nothing() -> None:
    made = mission()
    made.say(made.states[3].stamp + 0.5, "bot1:bot1_c2b@2", "controller_bot1")
    made.say(made.states[5].stamp + 0.1, "bot1_going_c_to_b2b", "simulator")
    made.say(made.states[5].stamp + 0.2, "no word at all", "rostopic")
    findings = found(made)
    assert findings.kept
    notes = [f.text for f in findings.findings if f.kind == "dropped"]
    assert len(notes) == 3
    assert any("had been taken" in note for note in notes)
    assert any("it cannot happen in state 5" in note for note in notes)
    assert any("it is no word" in note for note in notes)


def test_a_report_from_before_what_a_robot_does_now_is_said_to_lead_to_nothing() -> None:
    """A recording of before reports had numbers is read as well: all other tests here are such."""
    play = tuple((at, f"{word}#3" if word == "bot1_going_c_to_b2b" else word, node) for at, word, node in PLAY)
    made = mission(play)
    made.say(made.states[8].stamp - 0.05, "bot1_inbDONE#5", "simulator")
    findings = found(made)
    assert findings.kept and findings.won
    assert [step.word.text for step in findings.steps if step.word and step.word.as_of] == ["bot1_going_c_to_b2b#3"]
    (note,) = (f.text for f in findings.findings if f.kind == "dropped")
    assert "it reports the end of what bot1 had begun before state 7" in note


def test_a_command_that_the_strategy_does_not_have_is_a_fault() -> None:
    assert ("command", 7) in kinds(found(play_with(11.02, "bot1_inb")), FAULT)


def test_a_command_of_another_controller_is_a_fault() -> None:
    play = tuple((at, word, "controller_bot2" if "bot1_inb@" in word else node) for at, word, node in PLAY)
    assert kinds(found(mission(play))) == [("owner", 7)]


def test_an_end_that_a_controller_tells_is_a_fault() -> None:
    play = tuple((at, word, "controller_bot1" if "bot1_inbDONE" in word else node) for at, word, node in PLAY)
    assert kinds(found(mission(play))) == [("owner", 8)]


def test_a_controller_reports_where_its_own_robot_arrives() -> None:
    def reported_by(node: str) -> Findings:
        play = tuple((at, word, node if "bot1_going_c_to_b2b" in word else known) for at, word, known in PLAY)
        return found(mission(play))

    assert reported_by("controller_bot1").kept
    assert kinds(reported_by("controller_bot2")) == [("owner", 5)]


def test_a_command_by_hand_is_reported() -> None:
    play = tuple((at, word, "rostopic_7" if "bot1_inb@" in word else node) for at, word, node in PLAY)
    assert found(mission(play)).kept
    hurried = tuple((11.02 if "bot1_inb@" in word else at, word, node) for at, word, node in play)
    assert ("command", 7) in kinds(found(mission(hurried)), NOTE)


def test_a_step_that_nobody_asked_for_is_a_fault() -> None:
    made = mission()
    made.heard = [message for message in made.heard if "bot1_inbDONE" not in str(message[3])]
    assert kinds(found(made)) == [("unsaid", 8)]


def test_a_command_of_which_no_word_was_recorded_is_held_against_the_strategy() -> None:
    made = mission()
    made.heard = [message for message in made.heard if "bot1_inb@" not in str(message[3])]
    assert kinds(found(made)) == [("unsaid", 7)]
    play = tuple((11.02 if "bot1_inb@" in word else at, word, node) for at, word, node in PLAY)
    hurried = mission(play)
    hurried.heard = [message for message in hurried.heard if "bot1_inb@" not in str(message[3])]
    assert {("unsaid", 7), ("command", 7)} <= set(kinds(found(hurried), FAULT))


def test_a_goal_without_a_state_is_a_fault() -> None:
    made = mission()
    made.order(made.states[1].stamp + 0.05, "bot2", "a")  # a second before it sets out
    made.order(made.states[8].stamp + 0.05, "bot1", "c")
    assert kinds(found(made)) == [("order", 1), ("order", 8)]


def test_a_standing_goal_may_be_given_again_until_a_state_shows_that_it_is_reached() -> None:
    made = mission()
    made.received = dict.fromkeys((5, 6, 7), START + 14.0)  # its observer was away
    made.order(START + 13.9, "bot2", "a")  # its controller was killed, and is back
    assert kinds(found(made)) == []
    made.order(START + 16.1, "bot2", "a")
    assert [kind for kind, _ in kinds(found(made))] == ["order"]
    made.heard.pop()
    made.received.clear()
    assert kinds(found(made)) == [("order", 7)]


@pytest.mark.parametrize("node, status", [("observer", "won"), ("UI", "running"), ("plain_words", "running")])
def test_where_the_last_state_was_not_recorded_the_observers_word_tells_that_the_goal_is_reached(
    node: str, status: str
) -> None:
    made = mission()
    made.change(made.states[-1].seq, status="running")
    assert found(made).status == "running"
    words = (*record(made).words, read_word(made.states[-1].stamp + 0.01, "Finish!", node))
    findings = found(made, words=words)
    assert (findings.status, kinds(findings)) == (status, [])
    notes = [note for note in kinds(findings, NOTE) if note[0] == "not recorded"]
    assert notes == ([("not recorded", made.states[-1].seq)] if status == "won" else [])
    early = mission()
    del early.states[-1]
    assert found(early, words=(*record(early).words, words[-1])).status == "running"


def test_a_robot_that_returns_to_its_place_may_be_sent_there() -> None:
    made = mission()
    made.order(made.states[8].stamp + 0.05, "bot1", "b")
    made.change(made.states[8].seq, displaced=("bot1",), returning=("bot1",))
    assert kinds(found(made)) == []


def test_reports_about_robots_are_listed_with_their_reason() -> None:
    made = mission()
    made.say(made.states[5].stamp + 0.01, "bot1:_held_ on its way to b: preempted", "controller_bot1")
    made.say(made.states[5].stamp + 0.02, "bot1:_resume_", "")
    said = [(f.level, f.text) for f in found(made).findings if f.kind == "robot"]
    assert said == [
        ("world", "controller_bot1 published bot1:_held_ on its way to b: preempted"),
        ("note", "an unknown node published bot1:_resume_"),
    ]


def test_the_recorders_clock_may_be_a_little_behind_the_observers() -> None:
    made = mission()
    orders = ("move_base_simple/goal", "pursue/actions")
    made.heard = [(m[0] - 0.1 * m[1].endswith(orders), *m[1:]) for m in made.heard]
    assert kinds(found(made)) == []


def test_an_order_is_not_older_than_a_state_that_was_recorded_before_it() -> None:
    made = mission()
    assert kinds(check(record(made, behind=0.6), game())) == []  # simulated time may reach the recorder that late
    orders = [order.at for order in record(made, behind=10.0).orders]
    assert orders == [order.at - 10.0 for order in record(made).orders]  # not this clock


def test_a_goal_that_was_never_sent_is_a_fault() -> None:
    made = mission()
    made.heard = [message for message in made.heard if message[1] != "/bot2/move_base_simple/goal"]
    assert kinds(found(made)) == [("untold", 4)]


@pytest.mark.parametrize(("steps", "what"), [(3, []), (4, [("untold", 4)])])
def test_an_order_of_the_last_moment_may_be_missing_where_the_recording_was_cut(
    steps: int, what: List[Tuple[str, int]]
) -> None:
    made = mission(PLAY[:steps])
    made.heard = [message for message in made.heard if message[1] != "/bot2/move_base_simple/goal"]
    assert [each for each in kinds(found(made)) if each[0] == "untold"] == what


def test_a_goal_that_leads_elsewhere_is_a_fault() -> None:
    made = mission()
    made.heard = [message for message in made.heard if message[1] != "/bot2/move_base_simple/goal"]
    made.order(made.states[4].stamp + 0.01, "bot2", "b")
    assert kinds(found(made)) == [("goal", 4)]


@pytest.mark.parametrize("begun", [True, False])
def test_a_goal_of_a_node_that_is_no_controller_is_of_the_world_and_no_order(begun: bool) -> None:
    made = mission()
    made.order(made.states[4].stamp + (0.5 if begun else -0.5), "bot2", "b", "rviz_7")
    findings = found(made)
    assert kinds(findings) == [("sent", 4 if begun else 2)] and not findings.kept and findings.won
    (text,) = [finding.text for finding in findings.findings if finding.kind == "sent"]
    assert text == "rviz_7 sent bot2 elsewhere"
    made.heard = [m for m in made.heard if (m[1], m[2]) != ("/bot2/move_base_simple/goal", "controller_bot2")]
    assert set(kinds(found(made))) == {("sent", 4 if begun else 2), ("untold", 4)}


def test_two_robots_may_be_sent_to_different_spots_of_one_place_but_each_always_to_its_own() -> None:
    both_to_a = [(1.5, "bot1_c2a@", "controller_bot1"), (1.6, "bot2_c2a@", "controller_bot2")]
    made = mission(tuple(both_to_a))
    assert "goal" not in {kind for kind, _ in kinds(found(made))}
    beside = replace(made.heard[-1][3], y=made.heard[-1][3].y + 0.8)
    made.heard[-1] = (*made.heard[-1][:3], beside)
    assert "goal" not in {kind for kind, _ in kinds(found(made))}
    made.order(made.states[-1].stamp + 0.01, "bot2", "a")
    assert "goal" not in {kind for kind, _ in kinds(found(made))}, "sent again, it may be to its spare spot"
    made.heard[-1] = (*made.heard[-1][:3], replace(made.heard[-1][3], y=made.heard[-1][3].y + 2.5))
    assert "goal" in {kind for kind, _ in kinds(found(made))}, "which is near its own one"
    made.heard[-1] = (*made.heard[-1][:3], beside)
    made.order(made.states[-1].stamp + 0.02, "bot2", "a")
    made.heard[-1] = (*made.heard[-1][:3], replace(beside, y=beside.y - 0.4))
    assert "goal" not in {kind for kind, _ in kinds(found(made))}
    made.order(made.states[-1].stamp + 0.03, "bot2", "a")
    assert "goal" in {kind for kind, _ in kinds(found(made))}, "and always the same one"


def test_what_was_not_read_makes_no_goal_missing_but_is_reported() -> None:
    made = mission()
    made.heard = [message for message in made.heard if message[1] != "/bot2/move_base_simple/goal"]
    assert kinds(found(made, problems=("it is cut",))) == [("recording", 0)]


def test_a_win_without_the_goal_is_a_fault() -> None:
    made = mission()
    del made.states[-1], made.heard[-1]
    made.heard = [message for message in made.heard if "bot2_inaDONE" not in str(message[3])]
    last = made.states[-1]
    made.states[-1] = last._replace(status="won")
    assert ("end", last.seq) in kinds(found(made), FAULT)


@pytest.mark.parametrize("status, said", [("stopped", "was stopped"), ("running", "had not ended")])
def test_a_mission_that_was_not_won_is_said_so(status: str, said: str) -> None:
    from pursue_gen.tools.replay.summary import verdict

    made = mission(PLAY[:-1])
    last = made.states[-1]
    made.states.append(last._replace(status=status))
    findings = found(made)
    assert findings.kept and not findings.won and said in verdict(findings)


def held(made: Mission, before: int, plan: int = 0, lost: Tuple[str, ...] = ()) -> None:
    """Puts a hold and its end between two states: all later numbers are greater by two."""
    old = next(state for state in made.states if state.seq == before)

    def later(state: SystemState) -> SystemState:
        return state._replace(seq=state.seq + 2, plan=plan) if state.seq > before else state

    made.states = [later(state) for state in made.states]
    for number, (status, reason) in enumerate((("holding", "bot1 has failed"), ("running", "")), start=1):
        stamp = old.stamp + 0.1 * number
        clocks = {clock: value + 0.1 * number / old.unit for clock, value in old.clocks.items()}
        more: Dict[str, Any] = {"status": status, "reason": reason, "lost": lost if number == 1 else ()}
        new = old._replace(seq=before + number, stamp=stamp, clocks=clocks, event="", agent="", **more)
        made.states.append(new._replace(plan=plan if number == 2 else 0))
    made.states.sort(key=lambda state: state.seq)
    heard = []
    for at, topic, node, what in made.heard:
        word, at_sign, seq = str(what).partition("@")
        moved = f"{word}@{int(seq) + 2 * (int(seq) >= before)}" if at_sign else what
        heard.append((at, topic, node, moved if topic == "/pursue/events" else what))
    made.heard = heard


def test_holds_and_lost_agents_are_reported() -> None:
    made = mission()
    held(made, 6, lost=("bot2",))
    findings = found(made)
    assert findings.counts["holds"] == 1 and kinds(findings) == [("lost", 7)]
    assert [f.text for f in findings.findings if f.kind == "hold"] == [
        "the mission holds: bot1 has failed", "the mission goes on"
    ]  # fmt: skip


def plan_data() -> Dict[str, Any]:
    """The strategy of scenario 1 as it stands on pursue/plan."""
    yaml = pytest.importorskip("yaml")
    known = game()
    from pursue_gen.solving.rules import Rules
    from pursue_gen.solving.solution import solution
    from pursue_gen.tga import translate

    strategy = solution(translate(known.scenario), known.objective, Rules()).strategy
    subs = partition(strategy, known.network, known.scenario.agents)
    strategies = {
        sub.controller: yaml.safe_load(strategy_data.render(sub, "s", "0", Rules().reaction)) for sub in subs
    }
    cover = yaml.safe_load(strategy_data.render_cover(strategy, "s", "0"))
    return {"strategies": strategies, "people": None, "cover": cover}


def test_a_new_plan_is_what_counts_after_its_swap() -> None:
    made = mission()
    held(made, 6, plan=1)
    plan = plan_data()
    assert kinds(found(made, plans={1: plan})) == []
    plan["strategies"]["controller_bot2"]["strategy"] = []
    assert ("command", 11) in kinds(found(made, plans={1: plan}), FAULT)
    assert ("plan", 8) in kinds(found(made), FAULT)


def test_a_plan_that_cannot_be_read_is_a_fault() -> None:
    for plan in ({}, {"strategies": 3}, {"strategies": {"c": {"commands_agents": ["bot1"], "reaction": "x"}}}):
        assert ("plan", 0) in kinds(found(mission(), plans={1: plan}), FAULT)


def test_another_scenario_is_noticed() -> None:
    made = mission()
    made.states = [state._replace(locations={"somebody": "somewhere"}) for state in made.states]
    assert kinds(found(made))[0][0] == "scenario"


@pytest.mark.parametrize("seq", [1, 4, 6, 8])
def test_a_state_whose_first_message_is_missing_began_where_its_clocks_say(seq: int) -> None:
    made = mission()
    number = next(k for k, state in enumerate(made.states) if state.seq == seq)
    first = made.states[number]
    passed = 0.6 * (made.states[number + 1].stamp - first.stamp)
    clocks = {clock: value + passed for clock, value in first.clocks.items()}
    made.states[number] = first._replace(stamp=first.stamp + passed, clocks=clocks)
    findings = found(made)
    assert findings.kept and findings.won and kinds(findings, NOTE) == [("recorded late", seq)]


def test_an_end_whose_first_message_is_missing_was_when_its_clocks_stopped() -> None:
    made = mission()
    made.change(10, stamp=made.states[10].stamp + 4.0)
    findings = found(made)
    assert findings.kept and findings.won and kinds(findings, NOTE) == [("recorded late", 10)]
    assert findings.length == pytest.approx(21.3)


@pytest.mark.parametrize("again", [0.0, 4.0])
@pytest.mark.parametrize("passed", [0.0025, 0.6])
def test_an_end_that_came_with_an_acknowledgement_began_where_its_clocks_say(passed: float, again: float) -> None:
    made = mission()
    last = made.states[10]
    clocks = {clock: value + passed for clock, value in last.clocks.items()}
    made.change(10, stamp=last.stamp + passed + again, clocks=clocks)
    findings = found(made)
    assert findings.kept and findings.won and kinds(findings, NOTE) == [("recorded late", 10)]
    assert findings.length == pytest.approx(21.3 + passed)


def test_clocks_that_do_not_fit_an_earlier_beginning_are_a_fault() -> None:
    made = mission()
    state = next(state for state in made.states if state.seq == 3)
    clocks = {clock: value + 3.0 for clock, value in state.clocks.items()}
    made.change(3, clocks=clocks)
    assert ("clock", 3) in kinds(found(made), FAULT)
