"""The UI knows what can be done, says what is due, tells what happened, and how it ended."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from pursue_runtime.model import Model, Position
from pursue_runtime.strategy import Strategy
from pursue_runtime.ui.environment import MIN_PAUSE, RandomEnvironment, TraceEnvironment, TraceStep
from pursue_runtime.ui.mission_view import (
    MissionView,
    PossibleWord,
    Readiness,
    done_hints,
    menu,
    possible_words,
    read_line,
    report_text,
    reporters,
    tasks,
)
from tests.runtime.models import model_data, mover, state, worker
from tests.together import HOTEL
from tests.together import model as hotel

DATA = model_data(
    mover("bot", "robot", 9), mover("thief", "agent", 20), worker("nurse", "human"), worker("boy", "agent")
)
MODEL = Model(DATA)
CLOCKS = ("Cbot", "Cthief", "Cnurse", "Cboy", "Creach")


def at(seq: int, stamp: float, **more):
    """Everybody at the start, every clock running since 100."""
    clocks = {clock: stamp - 100.0 for clock in CLOCKS}
    clocks.update(more.pop("clocks", {}))
    return state(MODEL, seq, stamp, clocks, **more)


def offers(current, now: float, **more):
    return possible_words(MODEL, current, current.clocks_at(now), **more)


def mission(player=None, orders=None):
    return MissionView(MODEL, player or TraceEnvironment(()), orders)


def orders(*commands: dict):
    start = {"nurse": "s"}
    return Strategy({"commands_agents": ["nurse"], "reaction": 0.1,
                                    "strategy": [{"state": start, "commands": list(commands)}]})


SCREW = {"do": "screw", "agent": "nurse", "from": "s", "to": "doing_screw_in_s", "when": ["7 < Cnurse && Cnurse <= 9"]}


# What can be done

def test_only_what_nobody_controls_is_offered_with_its_moment() -> None:
    words = {offer.word: offer for offer in offers(at(1, 100.0), 100.4)}
    assert set(words) == {"thief_a2b", "boy:screw"}
    assert 0.6 < words["thief_a2b"].opens < 0.7
    assert words["thief_a2b"].closes == float("inf")


def test_rules_are_kept() -> None:
    assert [offer.word for offer in offers(at(1, 105.0, values={"Prule": 1}), 105.0)] == ["thief_a2b"]


def test_ends_are_offered_only_on_request() -> None:
    current = at(2, 106.0, clocks={"Cthief": 0.0}, thief="going_a_to_b", boy="doing_screw_in_s")
    assert offers(current, 110.0) == []
    (end,) = offers(current, 110.0, kinds=("agent",), ends=True)
    assert end.word == "thief_going_a_to_b2b"
    assert (16 < end.opens < 16.1, round(end.closes, 6)) == (True, 17.0)


def test_a_window_that_has_closed_is_no_offer() -> None:
    current = at(2, 106.0, clocks={"Cthief": 0.0}, thief="going_a_to_b", boy="doing_screw_in_s")
    assert offers(current, 130.0, kinds=("agent",), ends=True) == []


# Who plays them

def test_standing_still_says_nothing() -> None:
    played = mission(TraceEnvironment(()))
    played.on_state(at(1, 100.0, event="_start_"), 100.0)
    assert played.due(500.0, 1.0) == []
    assert played.next_moments(500.0) == (None, None)


@given(st.integers(), st.floats(0.1, 50.0), st.floats(0.0, 30.0))
def test_chance_says_only_what_is_possible_then(seed: int, pace: float, since: float) -> None:
    player = RandomEnvironment(MODEL, seed, pace)
    current = at(1, 100.0)
    player.on_state(current, 100.0, 100.0 + since)
    moment = player.next_moment()
    assert moment is not None and moment >= 100.0 + since
    (word,) = player.due(moment)
    named, _, event = word.rpartition(":")
    position = Position(current.locations, current.values, current.clocks_at(moment))
    assert MODEL.joint_move(position, event, named) is not None


def test_chance_is_the_same_for_the_same_seed_and_other_for_another() -> None:
    def first(seed: int):
        player = RandomEnvironment(MODEL, seed)
        player.on_state(at(1, 100.0), 100.0, 100.0)
        return player.next_moment()

    assert first(3) == first(3)
    assert len({first(seed) for seed in range(9)}) > 1


def test_chance_does_not_repeat_itself_before_an_answer_can_come() -> None:
    player = RandomEnvironment(MODEL, 1)
    player.on_state(at(1, 100.0), 100.0, 110.0)
    moment = player.next_moment()
    assert player.due(moment)
    assert player.next_moment() >= moment + MIN_PAUSE


def test_chance_waits_while_nothing_is_possible() -> None:
    player = RandomEnvironment(MODEL, 1)
    player.on_state(at(1, 100.0, thief="going_a_to_b", values={"Prule": 1}), 100.0, 100.0)
    assert player.next_moment() is None
    assert player.due(900.0) == []


def test_a_wrong_pace_is_refused() -> None:
    with pytest.raises(ValueError, match="~pace"):
        RandomEnvironment(MODEL, 1, pace=0.0)


def steps(*pairs):
    return [TraceStep(moment, word) for moment, word in pairs]


def test_a_trace_is_said_at_its_moments_after_the_start() -> None:
    player = TraceEnvironment(steps((3.5, "thief_a2b"), (9.0, "boy:screw"), (9.0, "_ping_")))
    assert player.next_moment() is None, "not before the start"
    player.on_state(at(1, 100.0)._replace(unit=0.5), 100.0, 100.0)
    assert player.next_moment() == 101.75
    assert player.due(101.7) == []
    assert player.due(101.75) == ["thief_a2b"]
    player.on_state(at(2, 102.0)._replace(unit=0.5), 100.0, 102.0)
    assert player.due(104.5) == ["boy:screw", "_ping_"]
    assert player.next_moment() is None


def test_a_restart_does_not_play_the_past_again() -> None:
    player = TraceEnvironment(steps((3.0, "thief_a2b"), (40.0, "thief_b2a")))
    player.on_state(at(7, 120.0), 100.0, 120.0)
    assert player.due(120.0) == []
    assert player.next_moment() == 140.0


def test_what_players_say_has_the_number_of_the_state_in_which_they_say_it() -> None:
    """So it counts once, also where the message comes twice."""
    said = steps((3.5, "thief_a2b"), (3.5, "boy:screw"), (3.5, "_ping_"), (3.5, "nonsense"))
    played = mission(TraceEnvironment(said))
    played.on_state(at(1, 100.0, event="_start_"), 100.0)
    played.on_state(at(4, 102.0), 102.0)
    assert played.due(103.5, 1.0) == ["thief_a2b#4", "boy:screw#4", "_ping_", "nonsense"]


# People

def test_an_order_is_said_when_it_is_due_for_this_state_only() -> None:
    told = mission(orders=orders(SCREW))
    told.on_state(at(4, 100.0, event="_start_"), 100.0)
    moment, _ = told.next_moments(100.0)
    assert 107.0 < moment <= 107.05
    assert told.due(107.0, 1.0) == []
    assert told.due(moment, 1.0) == ["nurse:screw@4"]
    assert told.due(moment, 1.1) == [], "once"
    assert told.next_moments(moment) == (None, 1.5)
    assert told.due(moment, 1.6) == ["nurse:screw@4"], "again when nothing came of it"


def test_no_order_after_its_zone() -> None:
    told = mission(orders=orders(SCREW))
    told.on_state(at(4, 110.0), 110.0)
    assert told.due(110.0, 1.0) == []
    assert told.next_moments(110.0) == (None, None)


def test_people_are_reported_in_words_once_it_is_taken() -> None:
    walker = Model(model_data(mover("nurse", "human", 9)))
    told = MissionView(walker, TraceEnvironment(()))
    told.on_state(state(walker, 1, 100.0, {}, event="_start_"), 100.0)
    lines = told.on_state(state(walker, 2, 104.0, {}, event="nurse_a2b", agent="nurse", nurse="going_a_to_b"), 104.0)
    assert [line.strip() for line in lines] == ["4.0  nurse sets off from a to b", "nurse: go to b now"]
    lines = told.on_state(state(walker, 3, 113.5, {}, event="nurse_going_a_to_b2b", agent="nurse", nurse="b"), 113.5)
    assert [line.strip() for line in lines] == ["13.5  nurse arrives at b"]


def test_people_get_instructions_where() -> None:
    told = mission()
    told.on_state(at(1, 100.0, event="_start_"), 100.0)
    lines = told.on_state(at(2, 103.0, event="screw", agent="nurse", nurse="doing_screw_in_s"), 103.0)
    assert [line.strip() for line in lines] == ["3.0  nurse begins screw", "nurse: do screw at s now"]


def test_who_takes_part_in_what_another_one_begins_gets_instructions_as_well() -> None:
    house = hotel(HOTEL.replace('agent "waiter" controllable', 'agent "waiter" human controllable'))
    told = MissionView(house, TraceEnvironment(()))
    there = {"porter": "lift", "waiter": "lift"}
    told.on_state(state(house, 1, 100.0, {}, event="_start_", **there), 100.0)
    riding = {"porter": "doing_ride_in_lift", "waiter": "doing_ride_in_lift"}
    lines = told.on_state(state(house, 2, 104.0, {}, event="ride", agent="porter", **riding), 104.0)
    assert [line.strip() for line in lines] == ["4.0  porter begins ride", "waiter: do ride at lift now"]
    assert [task.agent for task in tasks(house, told.state, ["porter", "waiter"])] == ["porter"], "who ends it"
    lines = told.on_state(state(house, 3, 108.5, {}, event="rideDONE", agent="porter", **there), 108.5)
    assert [line.strip() for line in lines] == ["8.5  porter finishes ride"]


# What happens

def test_a_state_that_is_published_again_is_reported_once() -> None:
    told = mission()
    assert told.on_state(at(1, 100.0, event="_start_"), 100.0)
    assert told.on_state(at(1, 102.0, event="_start_"), 102.0) == []


def test_what_wins_the_mission_is_reported_once_although_it_is_won_later() -> None:
    """The state keeps its number until the order is acknowledged."""
    told = mission()
    told.on_state(at(1, 100.0, event="_start_"), 100.0)
    assert len(told.on_state(at(2, 103.0, event="screwDONE", agent="nurse"), 103.0)) == 1
    assert told.on_state(at(2, 103.2, event="screwDONE", agent="nurse", status="won"), 103.2) == []


def test_nothing_runs_before_the_start() -> None:
    told = mission(orders=orders({**SCREW, "when": ["always"]}))
    told.on_state(at(0, 99.0, status="waiting"), 99.0)
    assert told.due(99.5, 1.0) == []
    assert told.elapsed(99.5) == 0.0


def test_the_time_of_the_start_is_found_after_a_restart() -> None:
    told = mission()
    told.on_state(at(9, 130.0, event="bot_a2b", agent="bot", clocks={"Cbot": 0.0}), 130.0)
    assert told.elapsed(131.0) == pytest.approx(31.0)


@pytest.mark.parametrize("status, reason, code, says", [
    ("won", "", 0, "The goal is reached, after 31.5 time units."),
    ("lost", "thief screw", 1, "lost, after 31.5 time units: thief screw"),
    ("stopped", "no strategy in this state", 1, "stopped, after 31.5 time units: no strategy in this state"),
    ("stopped", "", 1, "_stop_"),
])
def test_the_end_and_its_reason_are_reported(status: str, reason: str, code: int, says: str) -> None:
    told = mission()
    told.on_state(at(1, 100.0, event="_start_"), 100.0)
    assert told.verdict() is None
    told.on_state(at(5, 131.5, status=status, reason=reason), 131.5)
    assert told.verdict()[0] == code
    assert says in told.verdict()[1]
    assert told.due(140.0, 1.0) == []


def test_a_mission_without_a_goal_ends_with_its_objective_kept() -> None:
    safe = Model({**DATA, "objective": {"kind": "safety", "goal": None, "bad": ["reachObj", "win"]}})
    told = MissionView(safe, TraceEnvironment(()))
    told.on_state(at(5, 131.5, status="won"), 131.5)
    assert told.verdict() == (0, "The objective was kept to the end, after 31.5 time units.")
    told.counts = "seconds"
    assert told.verdict() == (0, "The objective was kept to the end, after 31.5 seconds.")


def test_what_the_end_of_a_mission_waits_for_is_said_once_and_at_last_what_was_kept() -> None:
    safe = Model({**DATA, "objective": {"kind": "safety", "goal": None, "bad": ["reachObj", "win"]}})
    told = MissionView(safe, TraceEnvironment(()))
    told.on_state(at(5, 130.0), 130.0)
    waits = "the mission ends as soon as what is due is answered: if {{x}} then y within 3"
    lines = told.on_state(at(5, 130.5, reason=waits), 130.5)
    assert [line.split("  ")[-1] for line in lines] == [waits.replace("{{x}}", "{x}")]
    assert told.on_state(at(5, 131.0, reason=waits), 131.0) == []
    told.on_state(at(6, 131.5, status="won", reason="kept: if {{x}} then y within 3"), 131.5)
    assert told.verdict() == (
        0, "The objective was kept to the end, after 31.5 time units; kept: if {x} then y within 3."
    )


def test_when_a_mission_ends_is_said_at_its_start() -> None:
    told = MissionView(Model({**DATA, "ends": {"after": 480, "answered": True}}), TraceEnvironment(()))
    told.on_state(at(1, 100.0, event="_start_"), 100.0)
    assert told.first_line(100.0).endswith("the mission runs; it ends after 480 time units when all is answered")


def test_progress_says_where_everybody_is() -> None:
    told = mission()
    told.on_state(at(1, 100.0, event="_start_", thief="b"), 100.0)
    assert told.progress(102.5).split("  ")[-4:] == ["bot a", "thief b", "nurse s", "boy s"]
    assert "2.5" in told.progress(102.5)
    told.on_state(at(2, 103.0, event="screw", agent="boy", thief="going_a_to_b", boy="doing_screw_in_s"), 103.0)
    assert told.progress(103.0).split("  ")[-4:] == ["bot a", "thief a → b", "nurse s", "boy screw at s"]


def test_what_happens_is_printed_in_words() -> None:
    told = mission()
    steps = [
        ("_start_", "", {}),
        ("thief_a2b", "thief", {"thief": "going_a_to_b"}),
        ("screw", "boy", {"thief": "going_a_to_b", "boy": "doing_screw_in_s"}),
        ("thief_going_a_to_b2b", "thief", {"thief": "b", "boy": "doing_screw_in_s"}),
        ("screwDONE", "boy", {"thief": "b", "boy": "s"}),
    ]
    lines = []
    for seq, (event, agent, places) in enumerate(steps, start=1):
        lines += told.on_state(at(seq, 100.0 + seq, event=event, agent=agent, **places), 100.0 + seq)
    assert [line.split("  ")[-1] for line in lines] == [
        "the mission starts", "thief sets off from a to b", "boy begins screw", "thief arrives at b",
        "boy finishes screw",
    ]


LABELLED = Model({**DATA, "labels": {"bot": "Porter 1", "a": "front desk", "boy": "Tom"}})


def test_the_reason_of_an_end_has_labels() -> None:
    view = MissionView(LABELLED, TraceEnvironment(()))
    view.on_state(at(1, 100.0, event="_start_"), 100.0)
    view.on_state(at(2, 160.0, status="stopped", reason="{bot} is late, and {a} is not a place"), 160.0)
    verdict = view.verdict()
    assert verdict is not None and verdict[1].endswith(": Porter 1 is late, and front desk is not a place.")


# Who is ready

def test_the_missing_are_named_until_they_are_ready() -> None:
    nodes = Readiness(["observer", "/controller_bot", "simulator"])
    nodes.update("/observer", True)
    nodes.update("stranger", True)
    assert nodes.missing() == ["controller_bot", "simulator"]
    nodes.update("controller_bot", True)
    nodes.update("observer", False, "no state yet")
    assert nodes.missing() == ["observer", "simulator"]
    assert nodes.reasons() == ["observer (no state yet)", "simulator"]


# What is typed

OFFERS = [PossibleWord("thief_a2b", 0.0, float("inf")), PossibleWord("boy:screw", 2.5, 4.0)]


@pytest.mark.parametrize("text, word, remark", [
    ("1", "thief_a2b", ""),
    ("2", "", "boy:screw is possible in 2.5 time units, not now"),
    ("3", "", "there is no number 3; expected 1 to 2"),
    ("0", "", "there is no number 0; expected 1 to 2"),
    ("ping", "_ping_", ""),
    (" stop ", "_stop_", ""),
    ("boy:screw", "boy:screw", ""),
    ("Finish!", "Finish!", ""),
    ("finish", "Finish!", ""),
    ("screww", "screww", "screww is not a word of this scenario; it was published anyway"),
    ("", "", ""),
])
def test_what_is_typed_becomes_a_word(text: str, word: str, remark: str) -> None:
    assert read_line(text, OFFERS, {"screw", "thief_a2b"}) == (word, remark)


def test_the_menu_lists_by_number() -> None:
    lines = menu(OFFERS)
    assert lines[0].split() == ["1", "thief_a2b"]
    assert lines[1].split()[:2] == ["2", "boy:screw"] and "in 2.5 time units, for 1.5" in lines[1]
    assert "stop" in lines[-1] and "finish" not in lines[-1] and "finish" in menu(OFFERS, may_finish=True)[-1]


def test_the_menu_says_what_a_word_means() -> None:
    now = at(2, 106.0, clocks={"Cthief": 0.0}, thief="going_a_to_b", boy="doing_screw_in_s")
    begins, ends = offers(at(1, 105.0), 105.0), offers(now, 122.5, kinds=("agent",), ends=True)
    assert [line.strip() for line in menu(begins)[:2]] == [
        "1  thief sets off from a to b: thief_a2b", "2  boy begins screw: boy:screw"
    ]
    assert menu(ends)[0].strip().startswith("1  thief arrives at b: thief_going_a_to_b2b")
    reported = [report_text(task) for task in tasks(MODEL, now, ["thief", "boy"])]
    assert reported == ["thief: arrived", "boy is done: screw at s"]


# What people report

def test_people_report_the_end_of_what_they_are_reported() -> None:
    crew = Model(model_data(mover("nurse", "human", 9), worker("cook", "human"), worker("boy", "agent")))
    busy = state(crew, 3, 100.0, {}, nurse="going_a_to_b", cook="doing_screw_in_s", boy="doing_screw_in_s")
    people = reporters(crew, False, {})
    given = tasks(crew, busy, people)
    assert [(task.agent, task.text) for task in given] == [("nurse", "go to b"), ("cook", "do screw at s")]
    assert tasks(crew, state(crew, 1, 100.0, {}), people) == []
    assert read_line("done nurse", [], set(), given) == ("nurse_going_a_to_b2b", "")
    assert read_line("done cook", [], set(), given) == ("cook:screwDONE", ""), "the boy could mean it too"
    assert read_line("done", [], set(), given) == ("", "who? expected done nurse or done cook")
    assert read_line("done", [], set(), given[:1]) == ("nurse_going_a_to_b2b", "")
    assert read_line("done boy", [], set(), given) == ("", "boy has nothing to do now")
    assert read_line("done", [], set(), []) == ("", "there is nothing to do now")


def test_without_a_simulator_everybody_s_ends_are_reported_by_a_person() -> None:
    crew = Model(model_data(mover("bot", "robot", 9), mover("visitor", "agent", 9), worker("cook", "human")))
    busy = state(crew, 3, 100.0, {}, bot="going_a_to_b", visitor="going_b_to_a", cook="doing_screw_in_s")
    given = tasks(crew, busy, reporters(crew, True, {}))
    assert [(task.agent, task.text, task.label) for task in given] == [
        ("bot", "a → b", "Arrived"), ("visitor", "b → a", "Arrived"), ("cook", "do screw at s", "Done")
    ]  # fmt: skip
    assert read_line("done visitor", [], set(), given) == ("visitor_going_b_to_a2a", "")
    assert read_line("done bot", [], set(), given) == ("bot_going_a_to_b2b", "")
    assert read_line("done", [], set(), given) == ("screwDONE", ""), "a person is meant where there is one"
    assert read_line("done", [], set(), given[:1]) == ("bot_going_a_to_b2b", "")
    assert read_line("done", [], set(), given[:2]) == ("", "who? expected done bot or done visitor")
    assert done_hints(given) == ["type done when it is done", "type done visitor when visitor has arrived"]
    assert done_hints(tasks(crew, busy, ["bot"])) == []


def test_a_robot_that_is_held_has_the_task_to_resume() -> None:
    crew = Model(model_data(mover("bot", "robot", 9), worker("cook", "human")))
    busy = state(crew, 3, 100.0, {}, bot="going_a_to_b", cook="doing_screw_in_s")._replace(held=("bot",))
    given = tasks(crew, busy, reporters(crew, True, {}))
    assert [(task.agent, task.label, task.word) for task in given][:1] == [("bot", "Resume", "bot:_resume_")]
    assert read_line("done bot", [], set(), given) == ("bot:_resume_", "")
    assert read_line("bot:_resume_", [], set(), given) == ("bot:_resume_", "")


def test_an_end_that_a_controller_decides_is_reported_by_nobody() -> None:
    crew = Model(model_data(mover("bot", "robot", 9), mover("visitor", "agent", 9), worker("cook", "human")))
    assert reporters(crew, True, {"reports": ["visitor", "cook"]}) == ["visitor", "cook"]
    assert reporters(crew, False, {"reports": ["visitor", "cook"]}) == ["cook"]


def test_a_state_that_comes_late_is_no_news() -> None:
    shown = mission()
    shown.on_state(at(1, 100.0, event="_start_"), 100.0)
    now = at(3, 110.0, bot="b", event="bot_going_a_to_b2b")
    shown.on_state(now, 110.0)
    assert shown.on_state(at(2, 105.0, bot="going_a_to_b", event="bot_a2b"), 111.0) == []
    assert shown.state == now


def test_each_part_of_a_reason_is_printed_once_while_the_mission_holds() -> None:
    view = mission()
    view.on_state(at(1, 100.0, event="_start_"), 100.0)
    told = []
    late = "{bot} is late"
    states = [(f"{late}; looking", "holding"), (f"{late}; no plan", "holding"), (f"{late}; looking", "holding")]
    for number, (reason, status) in enumerate([*states, ("", "running"), (late, "holding"), ("", "holding")], 2):
        told += view.on_state(at(number, 100.0 + number, status=status, reason=reason), 100.0 + number)
    assert [line.split("  ", 1)[1].strip() for line in map(str.strip, told)] == [
        "the mission holds: bot is late; looking", "the mission holds: no plan", "the mission holds: bot is late",
        "the mission holds: no reason is given",
    ]
