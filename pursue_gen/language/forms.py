"""The meaning of each keyword in a sentence, and statements to fill in."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Dict, Tuple

from pursue_gen.language.assumptions import KINDS as ASSUMPTIONS

MEANINGS: Dict[str, str] = {
    "POI": "A place where something can happen, or where ways meet.",
    "CONNECT": "A way between two places, in both directions unless it is one_way. Write it once.",
    "EVENT": "Something that can happen: what an agent does, alone or with a partner.",
    "RULE": "An order of events, round after round: each may happen only when it is its turn.",
    "STATE": "Something that is true or false, and that events change.",
    "STATEDEPENDENCY": "An event that is allowed only while a state has a value.",
    "AGENT": "Somebody who does something: a robot, a person, a thing with a will of its own.",
    "TRAVEL": "How long an agent takes from a place to the next one, in place of what distance and mobile say.",
    "FROM": "Where the agent sets off.",
    "TO": "Where the agent arrives; or, behind a number, the latest time.",
    "TAKES": "How long it takes: more than the first number, and at most the second one (or one unit more).",
    "OBJECTIVE": "What must always hold: an answer in time, an event that never happens, two agents who never meet.",
    "REACH_OBJECTIVE": "What is to be achieved once.",
    "ASSUME": "What an agent that is not controlled is assumed to do, or not to do. A mission watches it.",
    **{word.upper(): meaning for kind in ASSUMPTIONS.values() for word, meaning in kind.meanings.items()},
    "AT": "The place; in a condition: the agent stands there, idle or at work.",
    "AND": "The other end of the way; in a rule: both of the two, in any order; in a condition: both hold.",
    "DISTANCE": "How long the way is, in the unit of distance that you chose.",
    "ONE_WAY": "From the first place to the second only. Without it, the way goes in both directions.",
    "LOCATION": "Where it happens (events), or where it starts (agents).",
    "DURATION": "How long it takes, in the unit of time that you chose: 3 is up to 4. Without it, it takes no time.",
    "COLLABORATIVE": "It takes two at one place: one who can do it, and one who reacts to it.",
    "TOGETHER": "Whoever takes part is busy until it ends. Without it, only the one who does it is.",
    "AT_MOST": "How many times it happens in the whole mission, and no more.",
    "TIMES": "In the whole mission.",
    "FOR": "A rule for each of several: each of them has its own turn.",
    "LABEL": "What people read in place of the name: any text without double quotes.",
    "PATROL": "Places at which somebody has to be again and again.",
    "IN": "In this order: a visit counts in its turn only.",
    "ORDER": "A visit counts in its turn only: first at the first place, then at the second, round after round.",
    "EVERY": "So many units of time after somebody left, or after the start, somebody is there again. Without it, the "
    "least that can be promised is found.",
    "BY": "Who has to be there: an agent, or any robot.",
    "EACH": "A rule for each of several: each of them has its own turn.",
    "BEFORE": "First this, then that, and then the first again.",
    "OR": "Either of the two, round after round; in a condition: at least one holds.",
    "INITIALLY": "The value at the start, true or false.",
    "TRUE": "It holds.",
    "FALSE": "It does not hold.",
    "TRUE_IF": "The events that make the state true.",
    "FALSE_IF": "The events that make the state false.",
    "ONLY_IF": "What has to hold when the event begins, or when an agent sets off on the way.",
    "IS_TRUE": "The state is true.",
    "IS_FALSE": "The state is false.",
    "HUMAN": "An ally who follows instructions, but has no robot: the user interface tells the person what to do.",
    "CONTROLLABLE": "The program decides what this agent does. Without it, the agent does as it likes, also the worst.",
    "MOBILE": "It moves, and needs so many units of time for a unit of distance. A larger number is slower.",
    "CAN_DO": "The events that it does.",
    "REACTS_TO": "The collaborative events in which it is the partner.",
    "IF": "After this event, or when this condition comes to hold, there has to be an answer.",
    "THEN": "The event that has to follow, or the condition that has to hold at some moment.",
    "WITHIN": "How many units of time later the answer must have come.",
    "AVOID": "This event must never happen, or this condition must never hold.",
    "ALWAYS": "This condition must hold at every moment.",
    "NEVER_WITH": "These two agents must never be at one place, nor meet on a way.",
    "NOT": "What follows does not hold.",
    "ON_WAY": "The agent is between two places.",
    "DOING": "The agent is busy with this event.",
    "ANY": "At least one of them: any robot, any agent.",
    "NO": "None of them: no robot, no agent.",
    "ROBOT": "The agents that are controllable and not human.",
    "DO": "The event that is wanted.",
    "BATTERY": "The battery of a robot: what it holds, what is used, and where it is recharged. It never runs empty.",
    "CAPACITY": "What the battery holds when it is full, as it is at the start.",
    "USES": "What the robot uses in a unit of time on its way or at work. To stand still uses nothing.",
    "PER": "For each unit of time.",
    "UNIT": "A unit of time.",
    "RECHARGES": "What is added in a unit of time in which the robot does something at the dock.",
    "RADIUS": "Metres from the middle of the robot to its farthest part: what it needs to turn.",
    "TOLERANCE": "Metres by which the robot stops beside its goal, at most (xy_goal_tolerance).",
    "INFLATION": "Metres around obstacles that the robot's planners avoid (inflation_radius).",
    "OPTIONAL": "An objective that is given up where it cannot be promised with the rest; 1 is kept longest.",
    "AFTER": "It counts when it happens later than so many units of time after the start.",
}
"""What each word means, by token."""


HOLE = re.compile(r"\{(=?)([^}]*)\}")
"""A hole in the words of a form: {kind of thing}, or {=an example}."""


@dataclass(frozen=True)
class Form:
    """A way to write a statement. `words`: the statement with holes; a hole is {kind of thing} or {=an example}."""

    title: str
    words: str


FORMS: Dict[str, Tuple[Form, ...]] = {
    "POI": (Form("a place", 'poi "{=room}"'),),
    "CONNECT": (
        Form("a way between two places", "connect {POI} and {POI} distance {=1}"),
        Form("a way in one direction only", "connect {POI} and {POI} distance {=1} one_way"),
        Form("a way that is not always open", "connect {POI} and {POI} distance {=1} only_if {state} is_true"),
    ),
    "EVENT": (
        Form("something that can happen at a place", 'event "{=work}" location {POI} duration {=1}'),
        Form("something that takes more or less time", 'event "{=work}" location {POI} duration {=3} to {=5}'),
        Form("something that happens so many times only", 'event "{=call}" at_most {=2} times'),
        Form(
            "something that can happen only while something holds",
            'event "{=work}" location {POI} only_if {agent} at {POI}',
        ),
        Form("something that two do at once", 'event "{=handOver}" collaborative'),
        Form(
            "something that two do together for a while",
            'event "{=ride}" collaborative together location {POI} duration {=4}',
        ),
    ),
    "RULE": (
        Form("events in turn", 'rule "{=order}": {event} before {event}'),
        Form("three events in turn", 'rule "{=order}": ({event} before {event}) before {event}'),
        Form("events in turn, for each robot", 'rule "{=order}" for each robot: {event} before {event}'),
        Form("either of two events", 'rule "{=choice}": {event} or {event}'),
        Form("two events in any order, then a third", 'rule "{=all}": ({event} and {event}) before {event}'),
    ),
    "STATE": (
        Form("true or false, changed by events", 'state "{=open}": initially false, true_if {event} false_if {event}'),
    ),
    "STATEDEPENDENCY": (Form("an event that waits for a state", "stateDependency: {event} only_if {state} is_true"),),
    "AGENT": (
        Form("a robot", 'agent "{=bot}" controllable mobile {=1} location {POI} can_do {event}'),
        Form("somebody who does as they like", 'agent "{=visitor}" mobile {=1} location {POI} can_do {event}'),
        Form("a person who helps", 'agent "{=helper}" human controllable mobile {=1} location {POI} can_do {event}'),
    ),
    "TRAVEL": (Form("an agent's own time for a way", "travel {agent} from {POI} to {POI} takes {=5} to {=8}"),),
    "BATTERY": (
        Form(
            "a battery that is recharged at a place",
            "battery {agent} capacity {=100} uses {=2} per unit recharges {=5} per unit at {POI}",
        ),
    ),
    "ASSUME": tuple(Form(kind.title, kind.form()) for kind in ASSUMPTIONS.values()),
    "OBJECTIVE": (
        Form("an answer in time", "objective: if {event} then {event} within {=20}"),
        Form("an answer to what comes to hold", "objective: if {agent} at {POI} then {agent} at {POI} within {=20}"),
        Form("never", "objective: avoid {event}"),
        Form("never while …", "objective: avoid {agent} at {POI} and {agent} on_way"),
        Form("what always holds", "objective: always any robot at {POI}"),
        Form("two who never meet", "objective: {agent} never_with {agent}"),
        Form("somebody who comes again and again", "objective: patrol {POI} every {=60} by {agent}"),
        Form("somebody who comes as often as can be promised", "objective: patrol {POI} by {agent}"),
        Form("somebody who makes rounds", "objective: patrol {POI}, {POI} in order every {=60} by {agent}"),
        Form("two who are never at one place", "objective: {agent} never_with {agent} at {POI}"),
    ),
    "REACH_OBJECTIVE": (
        Form("achieve something once", "reach_objective: do {event}"),
        Form("achieve several things in time", "reach_objective: do {event} and {event} within {=60}"),
    ),
    "OPTIONAL": (
        Form("achieve something if it can be promised", "optional {=1} reach_objective: do {event}"),
        Form("what always holds if it can be promised", "optional {=1} objective: avoid {event}"),
    ),
}
"""What statements look like, by the token that begins them."""
