"""The names of the network: one place, because plans, the observer and the controllers all meet them."""

from __future__ import annotations

from pursue_gen.language.scenario import Event

CLOCK_OBJECTIVE = "Cobj"
CLOCK_REACH = "Creach"
OBJECTIVE = "obj"
REACH = "reachObj"
STATES = "states"

IDLE, AT_RISK, LOSE = "idle", "atRisk", "lose"
"""The locations of the objective's automaton: no duty, a deadline is running, a duty was missed."""

_GOING, _DOING = "going_", "doing_"


def agent_clock(agent: str) -> str:
    """The clock of an agent: how long since its last action or movement began or ended."""
    return f"C{agent}"


def agent_position(agent: str) -> str:
    """The variable that holds where an agent is."""
    return f"P{agent}"


def rule_turn(rule: str) -> str:
    """The variable that holds the number of a rule's location."""
    return f"P{rule}"


def state_value(state: str) -> str:
    """The variable that holds a state, 0 or 1."""
    return f"S{state}"


def movement(agent: str, a: str, b: str) -> str:
    """The channel on which an agent sets off from a to b."""
    return f"{agent}_{a}2{b}"


def going(a: str, b: str) -> str:
    """The location on the way from a to b."""
    return f"{_GOING}{a}_to_{b}"


def doing(event: str, poi: str) -> str:
    """The location at work at a POI."""
    return f"{_DOING}{event}_in_{poi}"


def is_going(location: str) -> bool:
    """True for a location on the way, see `going`."""
    return location.startswith(_GOING)


def is_doing(location: str) -> bool:
    """True for a location at work, see `doing`."""
    return location.startswith(_DOING)


def is_under_way(location: str) -> bool:
    """True for a location whose end takes time to come: on the way or at work."""
    return is_going(location) or is_doing(location)


def in_words(location: str) -> str:
    """Where an agent is, as in "at c", "on the way from c to b", "doing catch at b"."""
    if is_going(location):
        return "on the way from " + location[len(_GOING) :].replace("_to_", " to ")
    if is_doing(location):
        return "doing " + location[len(_DOING) :].replace("_in_", " at ")
    return f"at {location}"


def done(event: str) -> str:
    """The channel on which an event with a duration ends."""
    return f"{event}DONE"


def has_happened(event: Event) -> str:
    """The channel that says that an event has happened: its end where it lasts, the event itself where it does not."""
    return event.name if event.duration is None else done(event.name)
