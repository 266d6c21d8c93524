"""Which mission the nodes of this package belong to: that of the observer's states. It comes from the workspace,
or from what this machine has received (~received); with ~again they stay for the missions that follow.
"""

from __future__ import annotations

import os
from contextlib import suppress
from copy import copy
from functools import partial
from typing import Any, Callable, Dict, Mapping, Optional

import rospy
from pursue_msgs.msg import SystemState as SystemStateMessage
from std_msgs.msg import String

from pursue_runtime.data import DataError, Package
from pursue_runtime.event_words import PLAN, STATE
from pursue_runtime.folders import ros_home
from pursue_runtime.missions import Missions, Source, own_source
from pursue_runtime.model import Model
from pursue_runtime.nodes.links import Diagnostics, pulses_of_all
from pursue_runtime.nodes.node import ERROR, WARN, Ending, NodeReport, subscribe
from pursue_runtime.nodes.state_message import StatePrinter, subscribe_states
from pursue_runtime.nodes.witness import Witness
from pursue_runtime.parameters import flag
from pursue_runtime.state import WAITING, SystemState
from pursue_runtime.state_checks import OLD, OTHER, OURS, REFUSED, StateFilter, model_problem
from pursue_runtime.strategy import Strategy, parse_plan

PATIENCE = 1.0
"""Seconds of real time for which a node that starts waits for an observer whose states name the mission."""

PLANS = 10
"""So many plans are remembered: one may be in force whose successors were not taken. Not measured."""


class Membership:
    """The mission whose data the node has, and what becomes of states. `trouble`: why it cannot take part, or "".

    `scenario` is that of the workspace. It is a witness of the mission: an observer that starts learns what this node
    has seen last.
    """

    def __init__(self, package: Package, ending: Ending, config: str) -> None:
        """`config`: the folder of the data files, "" for that of the package. Raises DataError."""
        own = own_source(package, "model.yaml", config)
        given = rospy.get_param("~", {})
        self.received, self.again = flag(given, "received"), flag(given, "again")
        self.trouble, self.scenario = "", package.scenario
        self.printer = StatePrinter(ending)
        self._ending = ending
        self._missions = Missions(own, package.name, ros_home(os.environ) if self.received else "")
        self.source = self._choose()
        self.model = Model(self.source.read("model.yaml"))
        self._filter = StateFilter(self.source.mission, own.mission, self.again)
        self._plain = copy(self.model)
        self._added: Dict[int, Mapping[str, Any]] = {}  # by the number of a plan, what it adds to the model
        self._filter.check = self._problem
        subscribe(PLAN, String, self._on_plan, ending, queue_size=10, tcp_nodelay=True)
        self.count_malformed = self._filter.count_malformed
        self._over = False
        self._witness = Witness(lambda: None if self._over else self._filter.newest)

    def _on_plan(self, message: String) -> None:
        """Keep what a plan adds to the model: orders that people have written."""
        with suppress(DataError):  # the nodes that need the plan say what is wrong with it
            plan = parse_plan(message.data)
            if plan.get("mission", "") in ("", self.source.mission):
                newest = sorted(self._added)[1 - PLANS :]
                self._added = {**{number: self._added[number] for number in newest}, plan["plan"]: plan.get("adds", {})}

    def _problem(self, state: SystemState) -> str:
        """Return why a state is none of this mission, whose model has what is written in the plan of the state."""
        added = self._added.get(state.plan)
        model = self._plain if state.plan == 0 else self.model
        try:
            model = self._plain.extended(added) if added else model
        except DataError as wrong:
            return str(wrong)
        problem = model_problem(model, state)
        if not problem and model.written != self.model.written:
            self.model.become(model)
        return problem

    def follow(self, on_state: Callable[[SystemState, str], None], report: Callable[[], NodeReport]) -> None:
        """Hand on each state, with the name of its publisher, and publish reports on the node, with what is wrong with
        its membership."""
        states = subscribe_states(on_state, self._ending, on_malformed=self.count_malformed)
        Diagnostics(partial(self._amended, report), self._ending, states, pulses_of_all(self._ending))

    def _amended(self, report: Callable[[], NodeReport]) -> NodeReport:
        found, refused, trouble = report(), self.refused, self.trouble
        values = {"mission": self.source.mission, **found.values, **self.counts}
        if refused or trouble:
            return NodeReport(False, ERROR if refused else WARN, f"refused {refused}" if refused else trouble, values)
        return found._replace(values=values)

    @property
    def refused(self) -> str:
        """Return why the last state was refused, "" if it was not."""
        return self._filter.refused

    @property
    def counts(self) -> Dict[str, object]:
        """Return what was refused, for /diagnostics."""
        return {"refused": self.refused, "malformed": self._filter.malformed}

    @property
    def own(self) -> Source:
        """Return where the workspace's own data of the package are."""
        return self._missions.own

    def leave(self) -> None:
        """Be no witness of this mission any more: it is over, and the node stays beside the next one."""
        self._over = True

    def people(self) -> Optional[Strategy]:
        """Return the part of the strategy that people carry out, where there are any. Raises DataError."""
        return Strategy(self.source.read("people.yaml")) if self.source.has("people.yaml") else None

    def takes(self, state: SystemState) -> bool:
        """True for a state that counts here. Where it is of another mission that is here, the node begins anew."""
        refused, verdict = self.refused, self._filter.classify(state)
        if verdict == REFUSED:
            if self.refused != refused:
                rospy.logerr("refused %s", self.refused)
            self._witness.publish()
            return False
        if self._filter.clock_set_back and verdict != OTHER:
            self._ending.renew()  # nothing that is known here is of the mission that comes
            return False
        if verdict == OTHER:
            try:
                found = self._missions.find(state.mission)
            except DataError as problem:
                self.trouble = str(problem)
            else:
                self.trouble = f"does not have mission {state.mission or 'own'}: send it to this machine"
                if found is not None:
                    self._ending.renew()
        elif verdict != OLD:
            self.trouble = ""
            if state.status == WAITING and self._missions.moved(state.mission, self.source):
                self._ending.renew()
        if verdict == OURS:
            self.printer.on_state(state)
        return verdict == OURS

    def _choose(self) -> Source:
        """The mission of the observer, if it is there already and its mission is here; else the current one."""
        source = None
        if self.received:
            try:
                message = rospy.wait_for_message(STATE, SystemStateMessage, PATIENCE)
                source = self._missions.find(message.mission)
            except rospy.ROSException:
                pass  # there is no observer yet
        return source or self._missions.current()
