"""What the UI knows of its mission, for the parts of the UI: its page, its terminal and who types there."""

from __future__ import annotations

import os
import sys
import threading
from typing import List, Optional, Tuple

import rospy
from std_msgs.msg import String

from pursue_runtime.event_words import EVENTS
from pursue_runtime.model import Model
from pursue_runtime.nodes.membership import Membership
from pursue_runtime.nodes.node import Ending
from pursue_runtime.nodes.order_desk import UIOrders
from pursue_runtime.ui.mission_view import Environment, MissionView, Readiness
from pursue_runtime.ui.options import Options
from pursue_runtime.ui.strategies import strategies_of
from pursue_runtime.ui.terminal import Terminal
from pursue_runtime.ui.waits import AtDoors, Turns

GATHERING, READY, STARTING, RUNNING = "waiting for the nodes", "ready", "starting", "running"


class UIState:
    """The state of a UI: `lock` guards all of it, `observer` is the node whose states count, `verdict` is the exit
    status with its sentence once the mission has ended, `events` publishes."""

    states: rospy.Subscriber
    pulses: rospy.Subscriber

    def __init__(
        self, options: Options, membership: Membership, ending: Ending, player: Environment, model: Model
    ) -> None:
        self.options, self.membership, self.ending, self.model = options, membership, ending, model
        self.strategies = {0: strategies_of(membership.source)}
        """Those of all controllers by the number of their plan."""
        turns = Turns(model, self.strategies)
        self.at_doors = AtDoors(membership.source.read("ui.yaml"), model.shown)
        self.mission = MissionView(model, player, membership.people(), turns, self.at_doors)
        self.readiness = Readiness(options.nodes)
        self.terminal = Terminal(sys.stdout, os.environ)
        self.lock = threading.RLock()
        self.phase = GATHERING
        self.observer = ""
        self.verdict: Optional[Tuple[int, str]] = None
        self.orders = UIOrders(model, ending, self.on_answer)
        self.events = rospy.Publisher(EVENTS, String, queue_size=100, tcp_nodelay=True)

    def on_answer(self, order: str, accepted: bool, text: str) -> None:
        """Show the answer to an order."""
        raise NotImplementedError

    def start(self) -> None:
        """Start the mission."""
        raise NotImplementedError

    def missing(self) -> List[str]:
        """The nodes for which the start of the mission waits."""
        return self.readiness.missing() if self.phase == GATHERING else []

    @property
    def is_running(self) -> bool:
        """True from the first state of the mission under way on."""
        return self.phase == RUNNING

    def can_start(self) -> bool:
        """True where every node is ready and the mission was not started."""
        return self.phase == READY
