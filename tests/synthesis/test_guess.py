"""Simple policies: what they win is won, and they win what people ask of robots with several duties."""

from __future__ import annotations

from fractions import Fraction
from itertools import islice
from typing import Optional, Sequence, Tuple

import pytest
from hypothesis import HealthCheck, event, given, settings
from hypothesis import strategies as st

from benchmarks.lab_scenarios import Size, lab_scenario
from benchmarks.ordinary_families import warehouse
from pursue_gen.language import parse
from pursue_gen.outcomes import LimitHit
from pursue_gen.proof.checker import verify
from pursue_gen.solving.due_moves import patrols
from pursue_gen.solving.group_games import NEEDED, Group, GroupGames
from pursue_gen.solving.rules import DEFAULT, Rules, played
from pursue_gen.solving.solution import solve_scenario
from pursue_gen.synthesis.compile_game import compile_game
from pursue_gen.synthesis.limits import Limits, Progress
from pursue_gen.synthesis.native.engine import NativeEngine
from pursue_gen.synthesis.solve import guess, solve, to_strategy
from pursue_gen.synthesis.strategy import Strategy
from pursue_gen.tga import scenario_objective, translate
from pursue_gen.tga.network import Kind, Network, Objective
from tests.synthesis.random_games import started

NATIVE = NativeEngine()
SMALL = Limits(work=300_000, states=20_000)


def callers(count: int, deadline: int) -> str:
    """Rooms along a corridor, a caller in each, and one robot."""
    rooms = range(1, count + 1)
    lines = ['poi "base"', *(f'poi "p{k}"' for k in rooms)]
    lines += [f"connect {'base' if k == 1 else f'p{k - 1}'} and p{k} distance 3" for k in rooms]
    lines += [f'event "call{k}"\nevent "serve{k}" location p{k} duration 2' for k in rooms]
    lines += [f'rule "c{k}": call{k} before serve{k}' for k in rooms]
    lines.append(f'agent "r1" controllable mobile 1 location base can_do {", ".join(f"serve{k}" for k in rooms)}')
    lines.append(f'agent "people" location base can_do {", ".join(f"call{k}" for k in rooms)}')
    lines += [f"objective: if call{k} then serve{k} within {deadline}" for k in rooms]
    return "\n".join(lines) + "\n"


def game_of(text: str, rules: Rules = DEFAULT) -> Tuple[Network, Objective]:
    scenario = parse(text, "story.pur", "story")
    return played(translate(scenario), rules), scenario_objective(scenario)


def guessed(text: str) -> Tuple[Network, Objective, Optional[Strategy]]:
    network, objective = game_of(text)
    return (network, objective, guess(network, objective, DEFAULT.reaction)[0])


@pytest.mark.parametrize(("count", "deadline"), [(1, 30), (2, 40), (4, 62), (5, 110)])
def test_a_robot_serves_several_callers_in_turn(count: int, deadline: int) -> None:
    network, objective, strategy = guessed(callers(count, deadline))
    assert strategy is not None
    assert verify(network, objective, strategy, DEFAULT.reaction, closed=True).ok
    assert verify(network, objective, strategy, DEFAULT.reaction).ok


def test_callers_who_cannot_all_be_served_in_time_are_not_won() -> None:
    assert guessed(callers(4, 50))[2] is None
    assert guessed(callers(1, 5))[2] is None


def test_five_callers_and_one_robot_are_decided() -> None:
    won = solve_scenario(parse(callers(5, 110), "five.pur", "five"), DEFAULT)
    assert verify(won.network, won.objective, won.strategy, won.reaction).ok


def test_nothing_moves_without_a_duty() -> None:
    _, _, strategy = guessed(callers(3, 80))
    assert strategy is not None
    idle = [b for b in strategy.blocks if not any(where == "atRisk" for _, where in b.state.locations)]
    assert idle and not any(block.commands for block in idle)


LINE = """
poi "a"
poi "b"
poi "c"
poi "d"
connect a and b distance 2
connect b and c distance 5
connect c and d distance 5
agent "bot1" controllable mobile 1 location a
agent "guest" mobile 3 location d
"""


@pytest.mark.parametrize(
    "objective",
    [
        pytest.param("always not guest at b or bot1 at b", id="where it has to be when a guest comes"),
        pytest.param("if guest at c then bot1 at c within 6", id="from where it is in time"),
    ],
)
def test_a_robot_waits_where_it_will_be_needed(objective: str) -> None:
    """From where it begins it would be late."""
    network, wanted, strategy = guessed(f"{LINE}objective: {objective}\n")
    assert strategy is not None
    assert verify(network, wanted, strategy, DEFAULT.reaction, closed=True).ok


GREENHOUSE = """
poi "shed"
poi "path"
poi "herbs"
poi "gate"
connect shed and path distance 5
connect path and herbs distance 6
connect path and gate distance 2
event "pick" location herbs duration 6
event "bring" location gate duration 1
event "want" location gate
event "dry" location herbs
event "water" location herbs duration 2
event "refill" location shed duration 2
rule "tank": refill before water
rule "harvest": pick before bring
agent "hose" controllable mobile 1 location shed can_do refill, water
agent "picker" controllable mobile 1 location path can_do pick, bring
agent "sensor" location herbs can_do dry
agent "customer" location gate can_do want
assume: customer does want after 60
assume: customer waits 60 between want
objective: if want then bring within {within}
objective: if dry then water within 120
objective: hose never_with picker at path
"""


def test_a_robot_does_beforehand_what_has_to_come_first() -> None:
    """To go to the herbs, pick and come to the gate takes some 30 time units; she may want the next ones after 60."""
    network, objective, strategy = guessed(GREENHOUSE.format(within=25))
    assert strategy is not None
    assert verify(network, objective, strategy, DEFAULT.reaction, closed=True).ok
    assert guessed(GREENHOUSE.format(within=12))[2] is None
    early = GREENHOUSE.format(within=25).replace("assume: customer does want after 60\n", "")
    assert guessed(early)[2] is None, "it has nothing at first"


def test_a_robot_that_comes_too_late_to_its_post_is_not_won() -> None:
    fast = LINE.replace("mobile 3", "mobile 1")
    assert guessed(f"{fast}objective: always not guest at b or bot1 at b\n")[2] is not None
    early = fast.replace("distance 5\nagent", "distance 1\nagent")
    assert guessed(f"{early}objective: always not guest at c or bot1 at c\n")[2] is None


FLOOR = """
poi "hall1"
poi "hall2"
poi "room1"
poi "room2"
connect hall1 and hall2 distance 3
connect hall1 and room1 distance 2
connect hall2 and room2 distance 2
event "order"
event "drop" location room2 duration 1
agent "bot1" controllable mobile 1 location room1 can_do drop
agent "bot2" controllable mobile 1 location room2
agent "people" location room1 can_do order
"""
MAKES_WAY = (
    FLOOR
    + """poi "bay"
connect hall2 and bay distance 1
objective: if order then drop within 60
objective: bot1 never_with bot2
"""
)
RELIEVES = (
    FLOOR
    + """objective: if order then drop within 60
objective: always any robot at room1
"""
)
"""bot1 may leave room1 only when bot2 is there."""


@pytest.mark.parametrize("text", [MAKES_WAY, RELIEVES], ids=["who stands in the way", "who has nothing to do"])
def test_a_robot_moves_for_another_one(text: str) -> None:
    network, objective, strategy = guessed(text)
    assert strategy is not None
    assert verify(network, objective, strategy, DEFAULT.reaction).ok
    assert "bot2" in {command.moves[0].automaton for block in strategy.blocks for command in block.commands}


AROUND = """
poi "hall"
poi "room1"
poi "room2"
poi "room3"
connect hall and room1 distance 2
connect room1 and room2 distance 2
connect hall and room3 distance 3
connect room3 and room2 distance 3
event "call"
event "serve" location room2 duration 1
agent "bot1" controllable mobile 1 location hall can_do serve
agent "people" location hall can_do call
agent "guest" mobile 1 location room1
objective: if call then serve within 40
objective: avoid bot1 at room1 and guest at room1
"""


SUPPLY = """
poi "store"
poi "lane"
poi "press"
poi "mill"
connect store and lane distance 4
connect lane and press distance 2
connect lane and mill distance 6
event "need_press" location press
event "need_mill" location mill
event "fetchP" location store duration 1
event "fetchM" location store duration 1
event "feedP" location press duration 2
event "feedM" location mill duration 2
rule "p": fetchP before feedP
rule "m": fetchM before feedM
agent "cart1" controllable mobile 1 location press can_do fetchP, feedP
agent "cart2" controllable mobile 1 location mill can_do fetchM, feedM
agent "machineP" location press can_do need_press
agent "machineM" location mill can_do need_mill
objective: if need_press then feedP within 150
objective: if need_mill then feedM within 150
objective: cart1 never_with cart2
"""


def test_nobody_shuts_another_one_in_a_dead_end() -> None:
    """Both fetch from the store, to which one lane leads."""
    network, objective = game_of(SUPPLY)
    strategy, _ = guess(network, objective, DEFAULT.reaction, without_pauses=True)
    assert strategy is not None
    assert verify(network, objective, strategy, DEFAULT.reaction, closed=True).ok


HUB = """
poi "west"
poi "hub"
poi "east"
poi "room"
connect west and hub distance 8
connect hub and east distance 8
connect hub and room distance 5
event "call"
event "bring" location west duration 10
agent "cart" controllable mobile 1 location west
agent "porter" controllable mobile 1 location east can_do bring
agent "nurse" location room can_do call
objective: patrol room, west every 300 by cart
objective: if call then bring within 300
objective: every place holds 1 robot
objective: every way holds 1 robot
"""


@pytest.mark.parametrize("late", [False, True])
def test_robots_whose_ways_cross_leave_home_one_at_a_time(late: bool) -> None:
    """Nobody can make way at the hub: the cart's home is the room, which the porter never needs."""
    network, objective = game_of(HUB)
    names = patrols(network) if late else frozenset()
    strategy, _ = guess(network, objective, DEFAULT.reaction, late=names)
    assert strategy is not None
    assert verify(network, objective, strategy, DEFAULT.reaction).ok
    tight = HUB.replace("bring within 300", "bring within 60")  # a trip of the cart and one's own take longer
    assert guess(*game_of(tight), DEFAULT.reaction)[0] is None


def test_robots_go_to_their_homes_first() -> None:
    """Each begins in the other's way: the porter has to be out of it before the cart comes through the hub."""
    changed = HUB.replace("location east can_do", "location room can_do")
    network, objective = game_of(changed.replace("1 location west\n", "1 location east\n"))
    strategy, _ = guess(network, objective, DEFAULT.reaction, turns=True)
    assert strategy is not None
    assert verify(network, objective, strategy, DEFAULT.reaction).ok


AISLES = """
poi "desk"
poi "main1"
poi "main2"
poi "aisle1"
poi "aisle2"
poi "bay1"
poi "bay2"
poi "bay3"
connect desk and main1 distance 5
connect main1 and main2 distance 8
connect main1 and aisle1 distance 10
connect main2 and aisle2 distance 10
connect main1 and bay1 distance 3
connect main1 and bay2 distance 3
connect main2 and bay3 distance 3
event "order"
event "pick" location aisle1 duration 20
event "drop" location desk duration 10
rule "picked": order before pick before drop
agent "picker" controllable mobile 1 location bay1 can_do pick, drop
agent "scan1" controllable mobile 1 location bay2
agent "scan2" controllable mobile 1 location bay3
agent "packer" location desk can_do order
objective: if order then drop within 300
objective: patrol aisle1 every 300 by scan1
objective: patrol aisle2, main1 every 300 by scan2
objective: every place holds 1 robot
"""


def test_nobody_who_waits_for_his_turn_waits_for_ever() -> None:
    """What comes first in an order for picking is the packer's; all three go past one place."""
    network, objective = game_of(AISLES)
    strategy, _ = guess(network, objective, DEFAULT.reaction, turns=True)
    assert strategy is not None
    assert verify(network, objective, strategy, DEFAULT.reaction).ok


def test_robots_that_are_never_in_the_way_do_not_take_turns() -> None:
    apart = "objective: patrol bay every 90 by bot2"
    network, objective = game_of(MAKES_WAY.replace("objective: bot1 never_with bot2", apart))
    assert guess(network, objective, DEFAULT.reaction, turns=True)[0] is None
    assert guess(network, objective, DEFAULT.reaction)[0] is not None


POST = """
poi "dock"
poi "post"
poi "room"
poi "far"
poi "gate"
connect dock and post distance 2
connect dock and room distance 3
connect far and post distance 12
connect gate and post distance 6
event "call"
event "serve" location room duration 1
agent "bot1" controllable mobile 1 location dock can_do serve
agent "bot2" controllable mobile 1 location far
agent "guest" mobile 2 location gate
agent "people" location room can_do call
objective: always not guest at post or any robot at post
objective: if call then serve within 40
"""


def test_who_is_near_sees_to_a_post_until_who_is_to_stay_there_has_come() -> None:
    network, objective, strategy = guessed(POST)
    assert strategy is not None
    assert verify(network, objective, strategy, DEFAULT.reaction, closed=True).ok
    left = [
        dict(block.state.locations)["bot2"]
        for block in strategy.blocks
        for command in block.commands
        if (command.moves[0].automaton, command.moves[0].edge.source) == ("bot1", "post")
    ]
    assert set(left) == {"post"}
    assert guessed(POST.replace("within 40", "within 20"))[2] is None  # it is too late then
    assert guessed(POST.replace("distance 6", "distance 1"))[2] is None  # the guest comes first


@pytest.mark.parametrize("stays", [False, True])
def test_a_robot_goes_around_where_it_must_not_meet_somebody(stays: bool) -> None:
    """The shorter way leads past the guest's room."""
    still = AROUND.replace(" mobile 1 location room1", " location room1")
    network, objective, strategy = guessed(still if stays else AROUND)
    assert strategy is not None
    ways = {command.moves[0].edge.target for block in strategy.blocks for command in block.commands}
    assert "going_hall_to_room3" in ways and not any(target.endswith("_to_room1") for target in ways)
    assert verify(network, objective, strategy, DEFAULT.reaction, closed=True).ok


AISLE = """
poi "left"
poi "aisle"
poi "right"
connect left and aisle distance 4
connect aisle and right distance 4
event "call1"
event "call2"
event "work1" location right duration 2
event "work2" location left duration 2
agent "bot1" controllable mobile 1 location left can_do work1
agent "bot2" controllable mobile 1 location right can_do work2
agent "people" location left can_do call1, call2
objective: if call1 then work1 within 55
objective: if call2 then work2 within 55
objective: bot1 never_with bot2 at aisle
"""


def test_who_is_in_the_aisle_goes_on_to_where_others_wait() -> None:
    network, objective, strategy = guessed(AISLE)
    assert strategy is not None
    assert verify(network, objective, strategy, DEFAULT.reaction).ok


def test_who_has_least_to_do_keeps_out_of_the_way_of_others() -> None:
    network, objective = game_of(warehouse(2))
    strategy, _ = guess(network, objective, DEFAULT.reaction, without_pauses=True)
    assert strategy is not None
    assert verify(network, objective, strategy, DEFAULT.reaction, closed=True).ok


WASTE = """
poi "store"
poi "lane1"
poi "lane2"
poi "mill"
poi "saw"
poi "exit"
connect store and lane1 distance 4
connect lane1 and lane2 distance 4
connect lane2 and mill distance 2
connect lane2 and saw distance 3
connect lane2 and exit distance 5
event "full" location saw
event "clear" location saw duration 3
event "dump" location exit duration 1
rule "waste": clear before dump
agent "cart1" controllable mobile 1 location store
agent "cart2" controllable mobile 1 location lane2 can_do clear, dump
agent "machine" location saw can_do full
objective: if full then dump within 180
objective: cart1 never_with cart2
objective: patrol exit every 450 by any robot
"""


def test_who_waits_until_a_patrol_is_due_does_not_stand_in_the_way() -> None:
    """Who patrols the exit without pause would keep from it the one who has to dump something there."""
    network, objective = game_of(WASTE)
    strategy, _ = guess(network, objective, DEFAULT.reaction, late=patrols(network))
    assert strategy is not None
    assert verify(network, objective, strategy, DEFAULT.reaction, closed=True).ok


WELL = """
poi "barn"
poi "well"
poi "house"
connect barn and well distance 70
connect well and house distance 80
event "thirsty" location house
event "pump" location well duration 120
event "water" location house duration 60
rule "bucket": pump before water
agent "farmer" location house can_do thirsty
agent "cart" controllable mobile 1 location well can_do pump, water
assume: farmer waits 900 between thirsty
objective: if thirsty then water within 360
objective: patrol barn every 1800 by cart
"""


def test_who_waits_for_a_patrol_does_first_what_has_to_come_before_an_answer() -> None:
    """Who is called at the barn has no time to pump."""
    network, objective = game_of(WELL)
    for put_off, wins in ((frozenset(), False), (patrols(network), True)):
        strategy, _ = guess(network, objective, DEFAULT.reaction, late=put_off)
        assert (strategy is not None) is wins
    assert strategy is not None and verify(network, objective, strategy, DEFAULT.reaction, closed=True).ok


@settings(max_examples=40, deadline=None, suppress_health_check=list(HealthCheck))
@given(started((Kind.SAFETY,)), st.sampled_from((Fraction(0), Fraction(1))))
def test_what_a_policy_wins_in_a_random_game_wins_it(drawn: Tuple[Network, Objective], reaction: Fraction) -> None:
    network, objective = drawn
    strategy, _ = guess(network, objective, reaction)
    event(f"won: {strategy is not None}")
    if strategy is not None:
        assert verify(network, objective, strategy, reaction, prompt=False).ok
        assert solve(network, objective, reaction).won


@settings(max_examples=40, deadline=None, suppress_health_check=list(HealthCheck))
@given(st.integers(0, 10**6), st.integers(1, 2), st.booleans(), st.booleans())
def test_what_a_policy_wins_is_not_lost_exactly(seed: int, robots: int, free: bool, late: bool) -> None:
    network, objective = game_of(lab_scenario(seed, Size(places=4, robots=robots, people=1, promises=2)))
    put_off = patrols(network) if late else frozenset()
    try:
        strategy, _ = guess(network, objective, DEFAULT.reaction, limits=SMALL, without_pauses=free, late=put_off)
    except LimitHit:
        return
    event(f"won: {strategy is not None}")
    if strategy is None:
        return
    assert verify(network, objective, strategy, DEFAULT.reaction).ok
    try:
        verdict = solve(network, objective, DEFAULT.reaction, limits=SMALL)
    except LimitHit:
        return
    assert verdict.won


def ward(rooms: int, residents: Sequence[int], period: int, within: int, battery: str = "") -> str:
    """Rooms around a hall that a robot visits; from some a resident calls it. `battery`: what the robot's is."""
    names = [f"room{k}" for k in range(1, rooms + 1)]
    lines = [f'poi "{name}"' for name in ("hall", "dock", *names)]
    lines += [f"connect hall and {name} distance 4" for name in ("dock", *names)]
    lines += [f'event "ring{k}"\nevent "visit{k}" location room{k} duration 4' for k in residents]
    can = [f"visit{k}" for k in residents]
    if battery:
        lines.append('event "charge" location dock duration 10')
        can.append("charge")
    lines.append(f'agent "bot" controllable mobile 1 location dock can_do {", ".join(can)}')
    lines += [f'agent "resident{k}" location room{k} can_do ring{k}' for k in residents]
    if battery:
        lines.append(f'battery "bot" {battery}')
    lines.append(f"objective: patrol {', '.join(names)} every {period} by bot")
    lines += [f"objective: if ring{k} then visit{k} within {within}" for k in residents]
    return "\n".join(lines) + "\n"


def guessed_freely(text: str) -> Optional[Strategy]:
    """The strategy of a policy against residents who may call again at once, seen to win."""
    network, objective = game_of(text)
    strategy, _ = guess(network, objective, DEFAULT.reaction, without_pauses=True)
    assert strategy is None or verify(network, objective, strategy, DEFAULT.reaction, closed=True).ok
    return strategy


BATTERY = "capacity 60 uses 1 per unit recharges 5 per unit at dock"


@pytest.mark.parametrize(("rooms", "residents", "period", "within"), [(2, (1, 2), 120, 80), (3, (1,), 150, 90)])
def test_a_robot_with_a_battery_charges_before_it_cannot_come_back(
    rooms: int, residents: Sequence[int], period: int, within: int
) -> None:
    strategy = guessed_freely(ward(rooms, residents, period, within, BATTERY))
    assert strategy is not None
    charging = [b for b in strategy.blocks if any("doing_charge" in place for _, place in b.state.locations)]
    levels = {value for b in charging for name, value in b.state.values if name == "Lbot"}
    assert levels and max(levels) < 60


def test_a_battery_that_does_not_last_for_a_duty_is_not_won() -> None:
    small = "capacity 15 uses 1 per unit recharges 5 per unit at dock"
    assert guessed_freely(ward(2, (1,), 120, 80, small)) is None


@pytest.mark.parametrize(
    ("rooms", "residents", "period", "within", "battery"),
    [
        (6, (), 200, 0, "lasts 200, charges in 60 at dock"),
        (3, (1,), 200, 150, "lasts 250, charges in 60 at dock"),
        (6, (1, 6), 400, 200, "lasts 400, charges in 60 at dock"),
    ],
)
def test_a_robot_with_a_battery_by_time_stays_until_it_is_full(
    rooms: int, residents: Sequence[int], period: int, within: int, battery: str
) -> None:
    strategy = guessed_freely(ward(rooms, residents, period, within, battery))
    assert strategy is not None
    charging = [b for b in strategy.blocks if any(place == "atCharger" for _, place in b.state.locations)]
    assert charging and not any(block.commands for block in charging)


def test_a_robot_leaves_its_charger_when_it_is_called_and_a_charge_takes_too_long() -> None:
    ring = "assume: resident1 waits 400 between ring1\n"
    text = ward(1, (1,), 900, 40, "lasts 900, charges in 100 at dock").replace("objective", f"{ring}objective", 1)
    network, objective = game_of(text)
    strategy, _ = guess(network, objective, DEFAULT.reaction)
    assert strategy is not None and verify(network, objective, strategy, DEFAULT.reaction, closed=True).ok


def test_a_battery_by_time_that_does_not_last_for_a_duty_is_not_won() -> None:
    assert guessed_freely(ward(2, (), 120, 0, "lasts 12, charges in 10 at dock")) is None
    assert guessed_freely(ward(2, (), 60, 0, "lasts 100, charges in 60 at dock")) is None


def test_calls_take_turns_with_a_patrol_that_is_longer_than_they_can_wait() -> None:
    assert guessed_freely(ward(6, (1, 6), 300, 90)) is not None


def test_it_ends_at_a_limit_on_work() -> None:
    network, objective = game_of(callers(5, 110))
    with pytest.raises(LimitHit):
        guess(network, objective, DEFAULT.reaction, limits=Limits(work=1000))


def test_what_the_listener_raises_ends_it() -> None:
    network, objective = game_of(callers(8, 170))

    def interrupted(progress: Progress) -> None:
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        guess(network, objective, DEFAULT.reaction, progress=interrupted)


def test_the_same_game_gives_the_same_strategy() -> None:
    network, objective = game_of(callers(3, 80))
    game = compile_game(network, objective, DEFAULT.reaction)
    first, second = (to_strategy(game, NATIVE.guess(game).blocks) for _ in range(2))
    assert first == second and len(list(islice(first.blocks, 10))) > 5


HOSPITAL = """poi "entrance"
poi "hall"
poi "ward1"
poi "ward2"
poi "pharmacy"
poi "lab"
connect entrance and hall distance 4
connect hall and ward1 distance 6
connect hall and ward2 distance 8
connect hall and pharmacy distance 5
connect hall and lab distance 7
event "call1" location ward1
event "help1" location ward1 duration 3
event "call2" location ward2
event "help2" location ward2 duration 3
event "order" location lab
event "pick" location pharmacy duration 2
event "drop" location lab duration 2
rule "drugs": pick before drop
agent "bob" controllable mobile 1 location entrance can_do help1, help2
agent "cart" controllable mobile 1 location pharmacy can_do pick, drop
agent "nurse1" location ward1 can_do call1
agent "nurse2" location ward2 can_do call2
agent "doc" location lab can_do order
objective: if call1 then help1 within 120
objective: if call2 then help2 within 120
objective: if order then drop within 160
objective: bob never_with cart
objective: patrol entrance every 240 by bob
"""


def test_clocks_that_a_game_does_not_have_tell_no_plays_apart() -> None:
    # Zones have room for 7 clocks, this game has 6: what was said of the seventh made a policy wait and act at once.
    network, objective = game_of(HOSPITAL)
    group = Group(frozenset(("bob", "cart")), objective.bad)
    game = GroupGames(network, objective).game(group, frozenset(), NEEDED)
    strategy, _ = guess(game, objective, DEFAULT.reaction)
    assert len(game.clocks) == 6 and strategy is not None
    assert verify(game, objective, strategy, DEFAULT.reaction, closed=True).ok
