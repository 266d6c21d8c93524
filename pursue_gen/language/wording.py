"""Scenarios in English sentences: objectives, speeds, kinds of agents."""

from __future__ import annotations

from typing import Dict, Iterable, Iterator, List

from pursue_gen.language.conditions import condition_text, condition_words
from pursue_gen.language.numbers import Number
from pursue_gen.language.scenario import (
    Agent,
    Always,
    Assumption,
    AtMost,
    Avoid,
    Battery,
    Leaves,
    NeverHolds,
    NeverWith,
    Patrol,
    Reach,
    Ref,
    Respond,
    Scenario,
    StatedObjective,
    Waits,
)


def units(amount: str) -> str:
    """`1 unit`, `2 units`."""
    return f"{amount} unit{'' if amount == '1' else 's'}"


def objective_words(scenario: Scenario) -> List[str]:
    """What is wanted, a sentence for each objective."""
    return [objective_sentence(scenario, objective) for objective, *_ in scenario.statements]


def objective_sentence(scenario: Scenario, objective: StatedObjective) -> str:
    """What one objective wants, as a sentence, with its number where it is optional."""
    text = _sentence(scenario, objective)
    return f"Optional {objective.optional}: {text}" if objective.optional else text


def promise_words(scenario: Scenario) -> List[str]:
    """What has become of each number behind `optional` in a scenario that is solved, a sentence for each of them.

    Empty where nothing is optional.
    """
    said: Dict[int, str] = {}
    for number in scenario.optional:
        texts = (objective_text(each) for each in scenario.objectives if each.optional == number)
        said[number] = f"optional {number} is promised: {'; '.join(texts)}"
    for one in scenario.given_up:
        number = one.objective.optional
        texts = (objective_text(each.objective) for each in scenario.given_up if each.objective.optional == number)
        said[number] = f"optional {number} is given up, it {one.why.value}: {'; '.join(texts)}"
    return [said[number] for number in sorted(said)]


def _sentence(scenario: Scenario, objective: StatedObjective) -> str:
    if isinstance(objective, Respond):
        trigger, response, deadline = objective.trigger, objective.response, units(str(objective.deadline))
        if isinstance(trigger, Ref):
            begins = f"Whenever {trigger.shown} happens"
        else:
            begins = f"Whenever it becomes true that {condition_words(trigger)}"
        answer = f"{response.shown} happens" if isinstance(response, Ref) else condition_words(response)
        return f"{begins}, {answer} within {deadline}."
    if isinstance(objective, Avoid):
        return f"{objective.event.shown} never happens."
    if isinstance(objective, NeverWith):
        where = "at one place or on one connection" if objective.place is None else f"both at {objective.place.shown}"
        return f"{objective.first.shown} and {objective.second.shown} are never {where}."
    if isinstance(objective, Patrol):
        every = _every(objective)
        if objective.order:
            places = listed(map(scenario.shown, objective.order))
            return f"{patroller(objective)} visits {places} in this order, each {every}."
        return f"{patroller(objective)} is at {objective.place.shown} {every}."
    if isinstance(objective, Always):
        return f"It {'always' if objective.holds else 'never'} holds that {condition_words(objective.condition)}."
    after = f" later than {units(str(objective.after))} after the start" if objective.after else ""
    within = "" if objective.within is None else f" within {units(str(objective.within))} after the start"
    verb = "happens" if len(objective.events) == 1 else "happen, in any order,"
    when = f"{after} and{within}" if after and within else after or within
    return f"{listed(ref.shown for ref in objective.events)} {verb}{when}".rstrip(",") + "."


def _every(patrol: Patrol) -> str:
    """How often a place is visited."""
    if patrol.every is None:
        return "as often as can be promised"
    every = f"at least every {units(str(patrol.every))}"
    if patrol.least is None:
        return every
    if patrol.least >= patrol.every:
        return f"{every}, the least that can be promised"
    return f"{every}; nothing below {patrol.least} can be promised"


def periods_found(scenario: Scenario, won: bool = True) -> List[str]:
    """A sentence for each patrol whose period was found by solving, as far as the verdict says something about it."""
    found = (each for each in scenario.safety if isinstance(each, Patrol))
    return list(dict.fromkeys(sentence for each in found for sentence in _period(each, won)))


def _period(patrol: Patrol, won: bool) -> Iterator[str]:
    who, every, least = f"the patrol by {patroller(patrol)}", patrol.every, patrol.least
    if every is None or least is None:
        return
    if won and least == every:
        yield f"The least period that can be promised for {who} is {units(str(every))}."
    elif won:
        yield f"The least period for {who} is at most {units(str(every))}; nothing below {least} can be promised."
    elif least > every:
        yield f"No period up to {units(str(every))} can be promised for {who}."


def patroller(patrol: Patrol) -> str:
    """Who is to be at the place: an agent's name, or `any robot`."""
    return "any robot" if patrol.who.agent is None else patrol.who.agent.shown


def answered_text(respond: Respond) -> str:
    """What has to be answered: the name of an event, or a condition as it is written."""
    return respond.trigger.name if isinstance(respond.trigger, Ref) else condition_text(respond.trigger)


def answer_text(respond: Respond) -> str:
    """The answer: the name of an event, or a condition as it is written."""
    return respond.response.name if isinstance(respond.response, Ref) else condition_text(respond.response)


def answered_words(respond: Respond) -> str:
    """What has to be answered, with what people read: an event's label, or a condition as it is written."""
    return respond.trigger.shown if isinstance(respond.trigger, Ref) else condition_text(respond.trigger)


def answer_words(respond: Respond) -> str:
    """The answer, with what people read: an event's label, or a condition as it is written."""
    return respond.response.shown if isinstance(respond.response, Ref) else condition_text(respond.response)


def missed_text(respond: Respond) -> str:
    """What is wrong where the answer does not come, as in `no wave within 5 of fall`."""
    no = "no" if isinstance(respond.response, Ref) else "not once"
    return f"{no} {answer_words(respond)} within {respond.deadline} of {answered_words(respond)}"


def visited(patrol: Patrol) -> str:
    """Where a visit is due: a place, in its turn where the places have an order."""
    return f"{patrol.place.shown}, in its turn," if patrol.order else patrol.place.shown


def listed(names: Iterable[str]) -> str:
    """`a`, `a and b`, `a, b and c`."""
    *others, last = names
    return f"{', '.join(others)} and {last}" if others else last


def events_words(reach: Reach) -> str:
    """The events that are to be achieved, as in `load and unload`."""
    return listed(ref.shown for ref in reach.events)


def _by(patrol: Patrol) -> str:
    return "any robot" if patrol.who.agent is None else patrol.who.agent.name


def objective_text(objective: StatedObjective) -> str:
    """An objective as its author may write it, without the word that begins the statement; of a patrol in order the
    whole statement."""
    if isinstance(objective, Respond):
        return f"if {answered_text(objective)} then {answer_text(objective)} within {objective.deadline}"
    if isinstance(objective, Avoid):
        return f"avoid {objective.event.name}"
    if isinstance(objective, NeverWith):
        place = "" if objective.place is None else f" at {objective.place.name}"
        return f"{objective.first.name} never_with {objective.second.name}{place}"
    if isinstance(objective, Patrol):
        return patrol_text(objective, (objective.place.name,))
    if isinstance(objective, Always):
        return f"{'always' if objective.holds else 'avoid'} {condition_text(objective.condition)}"
    after = f" after {objective.after}" if objective.after else ""
    within = "" if objective.within is None else f" within {objective.within}"
    return f"do {' and '.join(ref.name for ref in objective.events)}{after}{within}"


def patrol_text(patrol: Patrol, places: Iterable[str]) -> str:
    """A patrol of these places, or of those that have an order with its place."""
    some = f"{', '.join(patrol.order)} in order" if patrol.order else ", ".join(places)
    every = "" if patrol.every is None else f" every {patrol.every}"
    return f"patrol {some}{every} by {_by(patrol)}"


def statement_text(objective: StatedObjective) -> str:
    """The whole statement, as in `objective: avoid e`."""
    word = "reach_objective" if isinstance(objective, Reach) else "objective"
    optional = f"optional {objective.optional} " if objective.optional else ""
    return f"{optional}{word}: {objective_text(objective)}"


def assumption_words(assumption: Assumption) -> str:
    """What is assumed, as a sentence without its full stop; the same words as in the scenario where they read well."""
    if isinstance(assumption, NeverHolds):
        return f"it never holds that {condition_words(assumption.condition)}"
    name = assumption.agent.shown
    if isinstance(assumption, AtMost):
        times = "once" if assumption.times == 1 else f"{assumption.times} times"
        return (
            f"{name} does {assumption.event.shown} at most {times}"
            if assumption.times
            else (f"{name} never does {assumption.event.shown}")
        )
    if isinstance(assumption, Waits):
        return f"{name} waits {units(str(assumption.time))} between one {assumption.event.shown} and the next"
    if isinstance(assumption, Leaves):
        return f"{name} leaves {assumption.place.shown} within {units(str(assumption.time))}"
    return f"{name} is never at {assumption.place.shown}"


def condition_of_promise(scenario: Scenario) -> str:
    """All that is assumed of agents that are not controlled, in one clause; "" where nothing is."""
    says = [assumption_words(assumption) for assumption in scenario.assumptions]
    return f"as long as {', and '.join(says)}" if says else ""


def battery_words(battery: Battery) -> str:
    """What a battery holds, what is used, and where it is recharged."""
    text = f"battery of {battery.capacity}, uses {battery.uses} per unit"
    return text if battery.dock is None else f"{text}, recharges {battery.recharges} per unit at {battery.dock.shown}"


def size_words(agent: Agent) -> str:
    """What is said of a robot's size; "": nothing."""
    size = {"radius": agent.radius, "goal tolerance": agent.tolerance, "inflation radius": agent.inflation}
    return ", ".join(f"{what} {metres} m" for what, metres in size.items() if metres is not None)


def speed_words(agent: Agent, scenario: Scenario) -> str:
    """How fast an agent is, in words, and what its battery holds."""
    batteries = [battery_words(battery) for battery in scenario.batteries if battery.agent.name == agent.name]
    if agent.mobile is None:
        return ", ".join(["stays there", *batteries])
    words = [f"{agent.mobile} time unit{'' if agent.mobile == 1 else 's'} per unit of distance"]
    own = [travel for travel in scenario.travels if travel.agent.name == agent.name]
    words += [f"{travel.a.shown} to {travel.b.shown} in {window_words(*travel.window)}" for travel in own]
    return ", ".join(words + batteries)


def window_words(low: Number, high: Number) -> str:
    """Between which times something ends; a window of one time unit, which is the usual one, by its first time."""
    return str(low) if high == low + 1 else f"{low} to {high}"


def kind_words(agent: Agent) -> str:
    """What an agent is, in words."""
    if not agent.controllable:
        return "not controlled"
    return "a person who is instructed" if agent.human else "a robot"
