"""Actions in parts, at run time: each part has an order and a report of its own, and is counted."""

from __future__ import annotations

from pursue_gen.solving.rules import DEFAULT, played
from pursue_gen.tga import scenario_objective, translate
from pursue_gen.workspace.model_file import model_data
from pursue_runtime.locations import end_of, ends_part, part_of
from pursue_runtime.model import Model
from pursue_runtime.observer.mission import Mission
from pursue_runtime.orders import parse_orders
from pursue_runtime.simulator.simulator import Delays, Simulator, end_window, end_words
from pursue_runtime.vocabulary import deed, sentence
from tests.runtime.models import everywhere
from tests.tga.networks import scenario

GARDEN = """
poi "bed"
event "prune" location bed duration 6 may_stop in 3 parts
event "call"
agent "bot" controllable location bed can_do prune
agent "gerda" location bed can_do call
reach_objective: do prune
"""


def model() -> Model:
    story = scenario(GARDEN)
    network = played(translate(story), DEFAULT)
    return Model(model_data(network, scenario_objective(story), story, DEFAULT.reaction))


MODEL = model()
AT_WORK = "doing_prune_in_bed"


def under_way() -> Mission:
    """A mission in which the robot has begun the first part, and has its order."""
    mission = Mission(MODEL, everywhere(MODEL), lambda *_: None, on_uncovered="warn")
    mission.on_word("_start_", 100.0)
    begin(mission, 102.0)
    return mission


def begin(mission: Mission, now: float) -> int:
    """The robot begins a part; the number of the state in which it has."""
    seq = mission.on_word(f"bot:prune@{mission.seq}", now)[0].seq
    mission.on_word(f"bot:_order_@{seq}", now)
    return seq


def test_it_is_known_by_its_word() -> None:
    assert ends_part(AT_WORK, "prunePART") and not ends_part(AT_WORK, "pruneDONE") and not ends_part("bed", "prunePART")
    assert (part_of("pruneDONE"), end_of("prunePART"), part_of("prune"), end_of("prune")) == (
        "prunePART", "pruneDONE", "", ""
    )  # fmt: skip


def test_a_report_ends_the_part_that_goes_on_and_the_last_one_all() -> None:
    mission, now = under_way(), 102.0
    for done in ("prunePART", "prunePART", "pruneDONE"):
        assert mission.state(now).locations["bot"] == AT_WORK
        (order,) = parse_orders(mission.state(now).orders)
        assert order.event == "prune"
        (after, *_) = mission.on_word(f"bot:pruneDONE#{mission.seq}", now + 2.2)
        assert (after.event, after.locations["bot"]) == (done, "bed")
        now += 4.0
        if done != "pruneDONE":
            begin(mission, now)
    assert mission.state(now).values["Pprune_parts"] == 0


def test_the_word_of_the_part_itself_counts_too() -> None:
    mission = under_way()
    (after,) = mission.on_word("prunePART", 104.1)
    assert (after.event, after.values["Pprune_parts"]) == ("prunePART", 1)


def test_a_report_that_comes_late_ends_no_other_part() -> None:
    mission = under_way()
    first = mission.seq
    mission.on_word(f"pruneDONE#{first}", 104.1)
    begin(mission, 106.0)
    assert mission.on_word(f"pruneDONE#{first}", 108.1) == []
    assert mission.state(108.1).values["Pprune_parts"] == 1


def test_what_is_broken_off_is_no_part() -> None:
    mission = under_way()
    (off,) = mission.on_word(f"bot:pruneSTOP@{mission.seq}", 103.9)
    assert (off.values["Pprune_parts"], off.locations["bot"]) == (0, "bed")


def test_the_simulator_reports_the_end_of_each_part() -> None:
    bot = MODEL.automaton("bot")
    window = end_window(MODEL, bot, AT_WORK)
    assert window is not None and (window.event, window.low) == ("pruneDONE", 2.0) and 2.3 < window.high < 2.6
    assert end_words(bot, AT_WORK) == ["pruneDONE"]
    mission = under_way()
    world = Simulator(MODEL, ["bot"], Delays("early"))
    world.on_state(mission.state(102.0), 0.0)
    world.on_order("bot", 102.0, "prune", mission.seq)
    (word,) = world.due(106.0, 0.0)
    assert word == f"pruneDONE#{mission.seq}"


def test_it_is_said_in_words() -> None:
    bot = MODEL.automaton("bot")
    end = next(edge for edge in bot.edges if edge.ends_part)
    assert end.is_end and deed(MODEL, bot, end).does == "finishes a part of prune"
    mission = under_way()
    before = mission.state(104.0)
    (after,) = mission.on_word("pruneDONE", 104.1)
    assert sentence(MODEL, after, before) == "bot finishes a part of prune"
