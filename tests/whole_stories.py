"""Random whole scenarios with every kind of statement: two robots, a person and a guest, two or three places."""

from __future__ import annotations

import functools
from typing import Callable, List, Sequence, Tuple, Union

from hypothesis import assume
from hypothesis import strategies as st

from pursue_gen.diagnostics import PursueError, Severity
from pursue_gen.language import check, parse
from pursue_gen.language.conditions import (
    AllOf,
    AnyOf,
    At,
    AtMostOf,
    Condition,
    Doing,
    Has,
    Holds,
    Not,
    OnWay,
    Who,
    condition_text,
)
from pursue_gen.language.scenario import Scenario
from tests.choices import member_of
from tests.conditions import ref

EVENTS = ("load", "drop", "ride", "wave", "sing")
"""What robots and the person may do; the guest calls."""


ROOM = ("0 robots", "1 robot", "1 agent", "2 agents", "1 of bot1, guest")
"""How many a place, or a way, may hold."""

PAUSES = ("load", "load and load", "sing and drop", "wave and load", "drop and wave", "call and sing", "ride")
"""Between which events there is to be a pause."""


def conditions(
    places: Sequence[str], agents: Sequence[str], things: Sequence[str] = ()
) -> st.SearchStrategy[str]:
    """Conditions on these places, agents and things, on doing `load`, and on the state `open`."""
    return _conditions(tuple(places), tuple(agents), tuple(things))


@functools.lru_cache(maxsize=100)
def _conditions(
    places: Tuple[str, ...], agents: Tuple[str, ...], things: Tuple[str, ...]
) -> st.SearchStrategy[str]:
    """The same, made but once for each of these."""
    who = member_of([Who(None), Who(None, robots=True), *(Who(ref(name)) for name in agents)])
    atoms: st.SearchStrategy[Condition] = (
        st.builds(At, who, member_of([ref(place) for place in places]))
        | st.builds(OnWay, who)
        | st.builds(lambda one, either: OnWay(one, ref("a"), ref("b"), either), who, st.booleans())
        | st.builds(AtMostOf, st.integers(0, 1), st.just((At(Who(None), ref("a")),)) | st.just((OnWay(Who(None)),)))
        | st.builds(Doing, st.just(Who(None)), st.just(ref("load")))
        | st.builds(Holds, st.just(ref("open")), st.booleans())
    )
    if things:
        atoms |= st.builds(Has, who, member_of([ref(thing) for thing in things]))
    literals = atoms | atoms.map(Not)
    pairs = st.lists(literals, min_size=2, max_size=2).map(tuple)
    return (literals | pairs.map(AllOf) | pairs.map(AnyOf)).map(condition_text)


@st.composite
def stories(draw: st.DrawFn, small: bool = False) -> Tuple[str, Scenario]:
    """A scenario without errors, and its text; `small`: one that is solved in little time."""
    places = ["a", "b"] if small or draw(st.booleans()) else ["a", "b", "c"]
    names = ["bot1", "guest"] if small else ["bot1", "bot2", "nurse", "guest"]
    condition = conditions(places, names)
    moved = ((" takes box", " gives box"), (" takes 2 box", " gives box"), (" takes 2 box", " gives 2 box"))
    takes, gives = draw(member_of((("", ""), ("", ""), *moved)))
    mounts, needs = draw(member_of((("", ""), ("", ""), (" mounts brush", " needs brush"))))
    things = ["box"] * bool(takes) + ["brush", "saw"] * bool(mounts)
    guard = conditions(places, names, things)

    def maybe(text: Union[str, Callable[[], str]], chance: int = 4) -> str:
        """What is only drawn where it is used is a function: most of a story's time goes to drawing."""
        if draw(st.integers(0, chance)):
            return ""
        return text if isinstance(text, str) else text()

    def place() -> str:
        return draw(member_of(places))

    def window() -> str:
        low = draw(st.integers(1, 4))
        return f"{low}" + maybe(lambda: f" to {low + draw(st.integers(1, 3))}")

    def only_if() -> str:
        return maybe(lambda: f" only_if {draw(guard)}")

    def whom() -> str:
        some = st.lists(member_of(names), min_size=1, max_size=2, unique=True).map(", ".join)
        each = member_of((" for {}", " except {}", " for robots"))
        return maybe(lambda: draw(each).format(draw(some)), 5)

    def ways(ends: str, some: str) -> List[str]:
        """A way for some, and perhaps another one, in both directions or not, for all others."""
        every = (some, some.replace(" for ", " except ")) if some.startswith(" for ") else (some,)
        each = [f"connect {ends} distance {draw(st.integers(1, 3))}{maybe(' one_way', 7)}{one}" for one in every]
        return [f"{way}{only_if()}" for way in each]

    lines = [f'poi "{name}"{whom()}' for name in places]
    for x, y in zip(places, places[1:]):
        lines += ways(f"{x} and {y}", whom())
    lines += [f'thing "{thing}"' for thing in things]
    parts = maybe(lambda: f" in {draw(st.integers(2, 4))} parts", 2)

    def limit() -> str:
        return f" at_most {draw(st.integers(1, 3))} times"

    lines += [
        f'event "load" location {place()} duration {window()}{maybe(" may_stop", 1)}{parts}{takes}{maybe(limit)}'
        f"{only_if()}",
        f'event "drop"{maybe(lambda: f" location {place()}", 1)}{gives}{maybe(limit)}{only_if()}',
        f'event "ride" collaborative{maybe(" together", 0 if draw(st.booleans()) else 9)} location {place()}'
        f" duration {window()}{mounts and ' mounts saw'}{only_if()}",
        f'event "wave" collaborative{mounts}{only_if()}',
        f'event "sing" duration {window()}{maybe(" may_stop", 1)}{needs}{only_if()}',
        f'event "call"{maybe(limit, 2)}{only_if()}',
    ]
    shuffled = draw(st.permutations([*EVENTS, "call"]))
    for number in range(draw(st.integers(0, 2))):
        some, word = shuffled[3 * number : 3 * number + 3], member_of(("before", "or", "and"))
        each = draw(member_of(("", "", " for each robot", " for each agent")))
        lines.append(f'rule "r{number}"{each}: ({some[0]} {draw(word)} {some[1]}) {draw(word)} {some[2]}')
    first = draw(member_of(("true", "false", "unknown", f"unknown seen_at {place()}")))
    shows = f" shown_by {draw(member_of(('load', 'ride', 'wave')))}" if first == "unknown" else ""
    lines.append(f'state "open": initially {first}, true_if drop false_if call{shows}')
    needing = draw(member_of(("load", "sing", "ride", "")))
    lines += [f"stateDependency: {needing} only_if open is_true"] if needing else []
    lines += _agents(draw, names, place, takes + gives, bool(mounts))
    lines += _travels(draw, names[:-1], places)
    lines += _assumptions(draw, place)
    lines += _objectives(draw, small, condition, guard, place)
    lines += _batteries(draw, place)
    text = "\n".join([*lines, ""])
    try:
        scenario = parse(text, "story.pur", "story")
    except PursueError:
        assume(False)
        raise
    assume(all(finding.severity is not Severity.ERROR for finding in check(scenario)))
    return text, scenario


def _agents(draw: st.DrawFn, names: Sequence[str], place: Callable[[], str], carry: str, mount: bool) -> List[str]:
    lines = []
    for name in names[:-1]:
        own = [event for event in EVENTS if name == "bot1" or draw(st.booleans())]
        also = ["load"] * (bool(carry) and "drop" in own) + ["wave"] * (mount and "sing" in own)
        own = [event for event in EVENTS if event in own or event in also]
        room = (" carries 2", " carries 3") if " 2 " in carry else ("", " carries 2", " carries 3")
        carries = draw(member_of(room)) if carry else ""
        carries += draw(member_of(("", " has box"))) if carry and "load" in own else ""
        brush = ", brush" if " has" in carries else " has brush"
        carries += draw(member_of(("", brush))) if mount and "wave" in own else ""
        kind = "human controllable" if name == "nurse" else "controllable"
        can_do = f" can_do {', '.join(own)}" if own else ""
        reacts = [event for event in ("ride", "wave") if event not in own]
        reacts_to = f" reacts_to {', '.join(reacts)}" if reacts else ""
        mobile = f"mobile {draw(st.integers(1, 2))}{carries}"
        lines.append(f'agent "{name}" {kind} {mobile} location {place()}{can_do}{reacts_to}')
    moves = " mobile 2" if draw(st.booleans()) else ""
    first = place()
    other = draw(member_of(("", "", " or a", " or b")))
    first += other if other != f" or {first}" else ""
    lines.append(f'agent "guest"{moves} location {first} can_do call reacts_to ride, wave')
    return lines


def _travels(draw: st.DrawFn, names: Sequence[str], places: Sequence[str]) -> List[str]:
    if draw(st.integers(0, 2)):
        return []
    low = draw(st.integers(1, 5))
    return [f"travel {draw(member_of(names))} from {places[0]} to {places[1]} takes {low} to {low + 2}"]


def _assumptions(draw: st.DrawFn, place: Callable[[], str]) -> List[str]:
    drawn = {
        "at_most": lambda: f"assume: guest does call at_most {draw(st.integers(0, 2))} times",
        "in_all": lambda: f"assume: at_most {draw(st.integers(0, 3))} of call in all",
        "after": lambda: f"assume: guest does call after {draw(st.integers(1, 30))}",
        "every": lambda: f"assume: guest does call every {draw(st.integers(0, 4))} to {draw(st.integers(4, 20))}",
        "waits": lambda: f"assume: guest waits {draw(st.integers(1, 9))} between call",
        "leaves": lambda: f"assume: guest leaves {place()} within {draw(st.integers(4, 20))}",
        "stays": lambda: f"assume: guest stays {draw(st.integers(0, 4))} to {draw(st.integers(4, 20))} at each place",
        "there": lambda: f"assume: guest at {place()} by {draw(st.integers(4, 60))}",
        "reaches": lambda: f"assume: guest reaches {place()} within {draw(st.integers(4, 60))}"
        f" after {draw(member_of((*EVENTS, 'call')))}",
        "never": lambda: f"assume: guest never at {place()}",
        "not": lambda: f"assume: not guest {draw(member_of(('on_way', f'at {place()}')))}",
    }
    return [drawn[kind]() for kind in draw(st.lists(member_of(list(drawn)), max_size=2, unique=True))]


def _batteries(draw: st.DrawFn, place: Callable[[], str]) -> List[str]:
    """Of the first robot, which takes part in nothing that others begin, and can do something at every place."""
    if draw(st.integers(0, 2)):
        return []
    capacity, rate = draw(member_of((8, 12, 20, 30))), draw(st.integers(0, 3))
    recharges = f" recharges {rate} per unit at {place()}" if rate else ""
    driving = draw(member_of(("", "", "1 per metre, ", "3 per metre, ")))
    return [f"battery bot1 capacity {capacity} uses {driving}{draw(st.integers(1, 2))} per unit{recharges}"]


def _objectives(
    draw: st.DrawFn,
    small: bool,
    condition: st.SearchStrategy[str],
    guard: st.SearchStrategy[str],
    place: Callable[[], str],
) -> List[str]:
    where = place()
    other = "guest" if small else "nurse"
    kinds = {
        "avoid": lambda: "objective: avoid call",
        "respond": lambda: f"objective: if call then drop within {draw(st.integers(5, 30))}",
        "comes": lambda: f"objective: if {draw(condition)} then sing within {draw(st.integers(5, 30))}",
        "follows": lambda: f"objective: if call then {draw(condition)} within {draw(st.integers(5, 30))}",
        "condition": lambda: f"objective: avoid {draw(guard)}",
        "always": lambda: f"objective: always {draw(guard)}",
        "place": lambda: f"objective: place {draw(member_of((where, 'a, b')))} holds "
        f"{draw(member_of(ROOM))}",
        "escort": lambda: f"objective: escort guest at {where} within {draw(st.integers(4, 30))} by bot1",
        "either": lambda: f"objective: patrol {where} every {draw(st.integers(8, 40))} by bot1 or {other}",
        "company": lambda: f"objective: escort guest at {where} within {draw(st.integers(4, 30))} by bot1 or {other}",
        "pause": lambda: f"objective: at_least {draw(st.integers(2, 20))} between {draw(member_of(PAUSES))}",
        "way": lambda: f"objective: way a to b holds {draw(member_of(ROOM))}",
        "with": lambda: f"objective: bot1 never_with guest{draw(member_of(('', f' at {where}')))}",
        "answer": lambda: f"objective: if {draw(condition)} then {draw(condition)} within {draw(st.integers(5, 30))}",
        "rounds": lambda: f"objective: patrol b, a in order every {draw(st.integers(12, 40))} by bot1",
        "patrol": lambda: f"objective: patrol {where} every {draw(st.integers(8, 40))} by bot1",
        "lasts": lambda: f"battery bot1 lasts {draw(st.integers(6, 40))}, charges in {draw(st.integers(1, 12))}"
        f"{draw(member_of(('', '', ' in 2 parts', ' in 4 parts')))} at {where}",
        "round": lambda: f"objective: patrol a, b in order every {draw(st.integers(8, 40))} by bot1",
        "request": lambda: f"objective: if call then {draw(member_of(('drop', 'load')))} within"
        f" {draw(st.integers(5, 40))}, at_most {draw(st.integers(1, 2 if small else 3))} open",
    }
    safety = draw(st.lists(member_of(list(kinds)), max_size=1 if small else 2, unique=True))
    event = draw(member_of(("load", "drop", "sing", "wave")))
    later = draw(member_of(("", " after 3", " within {}"))).format(draw(st.integers(10, 60)))
    also = " and drop" if event != "drop" and draw(st.integers(0, 3)) == 0 else ""
    more = member_of(("", " twice", " 3 times", " twice at_least {} apart"))
    often = draw(more).format(draw(st.integers(2, 9))) if not also and draw(st.integers(0, 2)) == 0 else ""
    reach = [f"reach_objective: do {event}{also}{often}{later}"] if not safety or draw(st.integers(0, 2)) else []
    return [kinds[kind]() for kind in safety] + reach
