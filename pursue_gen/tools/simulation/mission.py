"""One simulated mission, from `_start_` to its end: nodes, connections and world on one event queue."""

from __future__ import annotations

import random
from typing import Any, Dict, List, Optional, Tuple, Union

from pursue_gen.tools.simulation.connections import RECONNECTION, Connections
from pursue_gen.tools.simulation.event_queue import Action, EventQueue, Timer
from pursue_gen.tools.simulation.faults import Crash, FaultPlan, junk_word
from pursue_gen.tools.simulation.nodes import ControllerNode, ObserverNode, PeopleNode, to_process
from pursue_gen.tools.simulation.opponents import Opponent, kind_in_mission
from pursue_gen.tools.simulation.outcome import FAILED, GOAL, HELD, SAFE, Outcome, Settings, described
from pursue_gen.tools.simulation.people_orders import PeopleOrders
from pursue_gen.tools.simulation.planner import SimulatedPlanner
from pursue_gen.tools.simulation.promises import Promises
from pursue_gen.tools.simulation.recorder import EPSILON, BecameTrue, Driven, Judgement, Recorder
from pursue_gen.tools.simulation.remaining import Remaining
from pursue_gen.tools.simulation.stage import Stage
from pursue_gen.tools.simulation.world import SimulatedAgent
from pursue_runtime.event_words import Word, format_word
from pursue_runtime.observer.mission import Mission
from pursue_runtime.observer.planning import PlanRequest
from pursue_runtime.observer.witnesses import PATIENCE
from pursue_runtime.orders import Order
from pursue_runtime.sentences import in_words
from pursue_runtime.state import ENDED, HOLDING, LIVE, LOST, RUNNING, STOPPED, WON, SystemState

START = 1000.0
"""The moment at which missions start, in seconds of ROS time."""

HEARTBEAT, SILENCE = 1.0, 20.0
"""Seconds, as the observer's parameters ~heartbeat and ~silence have them."""

USUAL = 1.25
"""Reactions that a command is due without faults: controllers wait a quarter at strict bounds. Not measured."""

RETURN = 3.0
"""Reactions at most from the return of a node to the effect of a command that it delayed. Not measured."""


class SimulatedMission:
    """A mission in progress; it is what the nodes see as `Outside`."""

    def __init__(self, stage: Stage, settings: Settings, seed: int, remaining: Optional[Remaining],
                 record: bool = False) -> None:
        name = str(seed)
        self.events = EventQueue(START)
        self.fault_plan = FaultPlan(settings.faults, name, START, settings.span, tuple(stage.strategies), stage.robots,
                                    settings.margin - RETURN * stage.reaction)
        self.faulty = bool(self.fault_plan.kinds)
        self.lines: List[str] = []
        self._stage, self._settings, self._seed, self._record = stage, settings, seed, record
        self._promises = Promises(stage.scenario, exact=not self.faulty)
        self._driven = Driven(stage.scenario)
        self._connections = Connections(self.events, self.fault_plan, name, stage.reaction)
        self._kind = kind_in_mission(settings.opponent, name, remaining)
        self._opponent = Opponent(stage, self._kind, name, remaining)
        self._move_timer = Timer(self.events, self._act)
        self._word = ""
        self._published: List[str] = []
        self._complaints: List[str] = []
        self._observer = ObserverNode(stage, self, self._log)
        self._planner = SimulatedPlanner(stage, self.events, name, self._on_planner)
        offsets = self.fault_plan.offsets
        self._controllers = {node: ControllerNode(stage, node, self, offsets[node]) for node in stage.strategies}
        self._people = PeopleNode(stage, self) if stage.people is not None else None
        self._agents = {
            agent: SimulatedAgent(stage, agent, self.events, self.fault_plan, name, self._report, stage.reaction)
            for agent in stage.reports
        }
        self._orders = PeopleOrders(stage, self.events, name, self._order)
        self._latched: Optional[SystemState] = None
        self._plan: Optional[Dict[str, Any]] = None
        self._reachable = dict.fromkeys(stage.strategies, START)
        self._seen: Tuple[int, str] = (-1, "")
        self._became_true = BecameTrue()
        self.recorder = Recorder()

    # The course of the mission ----------------------------------------------------------------------------------------

    def run(self) -> Outcome:
        """Plays it to its end."""
        events, end = self.events, START + self._settings.until
        self._observer.heartbeat()
        self._schedule_faults()
        events.schedule(START, lambda: self._observer.call("hear", "_start_"))
        self.recorder.on_word(START, "_start_", "UI")
        self._orders.begin()
        while self._observer.mission.status not in ENDED and not self._complaints:
            moment = events.next_time()
            if moment is None or moment > end:
                events.now = end
                break
            events.step()
        return self._outcome()

    def _schedule_faults(self) -> None:
        """Sets what faults there will be, and what faults make necessary."""
        fault_plan, events = self.fault_plan, self.events
        if not self.faulty:
            return
        events.schedule(START + HEARTBEAT, self._heartbeat)
        for crash in fault_plan.crashes:
            events.schedule(crash.moment, lambda crash=crash: self._crash(crash))  # type: ignore[misc]
        draw = random.Random(f"{self._seed}/junk")
        for moment in fault_plan.junk:
            events.schedule(moment, lambda: self._junk(draw))

    def _outcome(self) -> Outcome:
        mission = self._observer.mission
        judged = self.recorder.judged(self._stage.game, self.faulty, self.fault_plan.offset, self.events.now)
        problems = [*judged.problems, *self._promises.problems, *self._complaints]
        end, reason = self._end(mission)
        cause = self._cause(mission, judged) if end in (STOPPED, HELD, LOST) else ""
        if end == LOST and not cause:
            end, reason = FAILED, f"it was lost, but no fault was longer than the margin: {reason}"
        time = (self.events.now if mission.goal_at is None else mission.goal_at) - START
        bound = self._settings.bound
        if not self.fault_plan.voids_guarantees and end == GOAL and bound is not None and time > bound + 1e-3:
            end, reason = FAILED, f"it took {time:.3f} time units, more than the guaranteed {bound:.3f}"
        if problems:
            end, reason = FAILED, problems[0]
        happened = dict(sorted(self.fault_plan.happened.items()))
        return Outcome(
            self._seed, self._kind, end, time, reason, judged.steps, mission.plan, len(judged.untimely),
            judged.lateness, cause, tuple(problems), happened, tuple(self.lines), self._promises.duties,
            self._driven.units,
        )

    def _cause(self, mission: Mission, judged: Judgement) -> str:
        """Which fault was longer than what the strategy is proven for; "" if none was."""
        margin, causes = self._settings.margin, []
        if judged.lateness > max(margin, USUAL * self._stage.reaction) + EPSILON:
            causes.append(f"{judged.latest} was due for {judged.lateness:.3f} time units, the margin is {margin:g}")
        causes += judged.untimely[:1]
        causes += [f"{name} is late" for name in sorted(mission.late - set(mission.lost))]
        causes += [f"{name} {in_words(why)}" for name, why in sorted(mission.lost.items())]
        return "; ".join(causes)

    def _end(self, mission: Mission) -> Tuple[str, str]:
        """How it ended, before what was found is looked at."""
        safety = not self._stage.solution.objective.reaches
        ends = {STOPPED: STOPPED, LOST: LOST, HOLDING: HELD}
        if mission.status == WON:
            return (SAFE if safety else GOAL), in_words(mission.reason)
        if mission.status in ends and self.fault_plan.voids_guarantees:
            return ends[mission.status], in_words(mission.reason)
        if mission.status == RUNNING and safety:
            return SAFE, ""
        if mission.status == RUNNING:
            return FAILED, "it neither reached the goal nor stopped"
        return FAILED, f"the mission is {mission.status}: {in_words(mission.reason)}"

    # What the nodes do (Outside) --------------------------------------------------------------------------------------

    def publish(self, state: SystemState) -> None:
        """The observer publishes a state: all subscribers get it."""
        moment = self.events.now
        if self._observer.looks_back and self._latched is not None:
            moment = self._became_true.moment(state, self._latched, moment)
        self._latched = state
        news = (state.seq, state.status) != self._seen
        self._seen = (state.seq, state.status)
        if news and self._record:
            self._note(described(state))
        self.recorder.on_state(moment, state)
        self._promises.on_state(state, moment)
        self._driven.on_state(state)
        for node in self._controllers.values():
            self._send_state(node, state, self._stage.reaction)
        for mover in self._agents.values():
            mover.on_orders(state)
        if news:
            for mover in self._agents.values():
                mover.on_state(state)
            self._choose_move(state)
        if self._people is not None:
            self._people.on_state(state)

    def repeat(self, state: SystemState) -> None:
        """The observer publishes a state once more, unchanged."""
        for node in self._controllers.values():
            self._send_state(node, state, self._stage.reaction)

    def _send_state(self, node: ControllerNode, state: SystemState, latest: float) -> None:
        """Sends a state to a controller: to the process that is subscribed now."""
        self._connections.send(f"state:{node.name}", latest, to_process(node, lambda: node.on_state(state)), node.name)

    def _send_plan(self, node: ControllerNode, plan: Dict[str, Any]) -> None:
        """Plans are latched: what is lost comes when the controller has connected once more."""
        self._connections.send(f"plan:{node.name}", 0.1, to_process(node, lambda: node.on_plan(plan)), node.name)

        def look() -> None:
            if node.alive and self._plan is plan and node.plan != plan["plan"]:
                self._send_plan(node, plan)

        if self.faulty:
            self.events.schedule(self.events.now + RECONNECTION[1], to_process(node, look))

    def publish_plan(self, plan: Dict[str, Any]) -> None:
        """The observer publishes another plan."""
        self._plan = plan
        self.recorder.plans[plan["plan"]] = plan
        self._note(f"plan {plan['plan']} is published")
        for node in self._controllers.values():
            self._send_plan(node, plan)
        if self._people is not None:
            self._people.on_plan(plan)

    def request_plan(self, request: Optional[PlanRequest]) -> None:
        """The observer requests another plan, or needs none any longer."""
        self._planner.request_plan(request)

    def publish_word(self, node: str, word: Word, latest: float) -> None:
        """A controller or the UI publishes a word."""
        text = format_word(word)
        self._note(f"{node} publishes {text}")
        self._published.append(text)
        self.recorder.on_word(self.events.now, text, node)
        deliver = to_process(self._observer, lambda: self._observer.call("hear", text))
        self._connections.send(f"word:{node}", max(0.0, latest - self.events.now), deliver, node)

    def command_robot(self, node: str, order: Order, seq: int, newest: int, again: bool) -> None:
        """A controller sends its robot an order."""
        self._note(f"{node} orders {order.agent}: {order.event} ({order.location})")
        if seq < newest:
            self._complaints.append(f"{node} orders {order.event} as of state {seq}, though it knows state {newest}")
        self.recorder.on_order(self.events.now, order, node, again)
        mover = self._agents.get(order.agent)
        if mover is not None:
            self._connections.send_order(lambda: mover.on_order(order, seq))

    # What the world does ----------------------------------------------------------------------------------------------

    def _report(self, agent: str, text: str) -> None:
        self._note(f"{agent} reports {text}")
        self.recorder.on_word(self.events.now, text, "simulator")
        self._became_true.note(agent, text, self.events.now)

        def deliver() -> None:
            self._became_true.hear(text, self.events.now)
            self._observer.call("hear", text)

        self._connections.send(f"report:{agent}", 0.0, to_process(self._observer, deliver), self._machine_of(agent))

    def _order(self, text: str) -> None:
        """A person orders something."""
        self._note(f"somebody orders {text}")
        self._observer.call("order", text)

    def _machine_of(self, agent: str) -> str:
        return self._stage.controller_of(agent) or ""

    def _report_move(self, text: str) -> None:
        """Reports what an uncontrollable agent does. If another event of this instant comes first, the agent has
        chosen again, in the new state: without faults no report is late, so the earlier choice is dropped."""
        agent, seq = text.partition(":")[0], self._observer.mission.seq
        self._note(f"{agent} reports {text}")
        self.recorder.on_word(self.events.now, text, "simulator")

        def deliver() -> None:
            if self.faulty or self._observer.mission.seq == seq:
                self._observer.call("hear", text)

        self._connections.send(f"report:{agent}", 0.0, to_process(self._observer, deliver))

    def _choose_move(self, state: SystemState) -> None:
        """The uncontrollable agents choose what to do in this state."""
        deed = None
        if state.status in LIVE:
            network, clocks = self._stage.arena.network, state.clocks_at(self.events.now)
            locations = tuple(state.locations[automaton.name] for automaton in network.automata)
            key = locations, tuple(state.values[name] for name, _ in network.variables)
            deed = self._opponent.next(key, (0.0, *(clocks[clock] for clock in network.clocks)))
        self._word = f"{deed.word}#{state.seq}" if deed and deed.word else ""
        self._move_timer.set(self.events.now + deed.delay if deed else None)

    def _act(self) -> None:
        if self._word:
            self._report_move(self._word)
        elif self._latched is not None:
            self._choose_move(self._latched)

    # Faults -----------------------------------------------------------------------------------------------------------

    def _heartbeat(self) -> None:
        """Once a second: the observer publishes its state again, and finds controllers that are silent."""
        events, observer = self.events, self._observer
        live = observer.mission.status in LIVE
        events.schedule(events.now + HEARTBEAT, self._heartbeat)
        observer.heartbeat()
        for name, node in self._controllers.items():
            if node.alive and not self._connections.is_cut(name):
                self._reachable[name] = events.now
            if not observer.alive:
                continue
            away = name in observer.mission.silent
            if away and self._reachable[name] == events.now:
                self._note(f"{name} is back")
                observer.call("back", name)
            elif not away and live and events.now > self._reachable[name] + SILENCE:
                self._note(f"{name} is silent")
                observer.call("silent", name)

    def _crash(self, crash: Crash) -> None:
        node: Union[ObserverNode, ControllerNode] = self._observer
        if crash.node != "observer":
            node = self._controllers[crash.node]
        if not node.alive:
            return
        self.fault_plan.count(crash.kind)
        self._note(f"{crash.node} dies")
        node.kill()
        if node is self._observer:
            self._planner.request_plan(None)  # a planner ends with its observer
        self.events.schedule(self.events.now + crash.seconds, lambda: self._restart(crash.node, node))

    def _restart(self, name: str, node: Union[ObserverNode, ControllerNode]) -> None:
        self._note(f"{name} is started again")
        if isinstance(node, ObserverNode):
            is_cut = any(map(self._connections.is_cut, self._controllers))  # it waits for an answer from there
            self.events.schedule(self.events.now + (PATIENCE if is_cut else 0.0), self._return_of_observer)
            return
        node.restart()
        if self._observer.alive and self._latched is not None:  # what is latched comes at once
            self._send_state(node, self._latched, 0.0)
            if self._plan is not None:
                self._send_plan(node, self._plan)

    def _return_of_observer(self) -> None:
        """It learns what the nodes have seen that it reaches; then each reports again what it does not show."""
        reached = {name: node for name, node in self._controllers.items() if not self._connections.is_cut(name)}
        seen = {name: node.seen for name, node in reached.items() if node.seen is not None}
        if self._latched is not None:
            others = [*self._agents, *(["UI"] if self._people is not None else [])]
            cut = {name for name in self._agents if self._connections.is_cut(self._machine_of(name))}
            seen.update((name, self._latched) for name in others if name not in cut)
        self._reachable = dict.fromkeys(self._reachable, self.events.now)
        self._observer.restart(seen)
        for name, controller in self._controllers.items():
            self._connect(name, f"word:{name}", name, controller.say_again)
        for name, agent in self._agents.items():
            self._connect(name, f"report:{name}", self._machine_of(name), agent.say_again)
        if self._people is not None:
            self._connect("UI", "word:UI", "UI", self._people.say_again)
        if self._latched is not None:
            self._choose_move(self._latched)

    def _connect(self, name: str, connection: str, machine: str, say_again: Action) -> None:
        """A node has connected to the observer: it reports again, and says when that is all. If that is lost, it has to
        connect once more."""
        say_again()
        deliver = to_process(self._observer, lambda: self._observer.on_reported(name))
        self._connections.send(connection, 0.0, deliver, machine)
        life = self._observer.life

        def look() -> None:
            if self._observer.life == life and self._observer.awaits(name):
                self._connect(name, connection, machine, say_again)

        if self._observer.awaits(name):
            self.events.schedule(self.events.now + RECONNECTION[1], look)

    def _junk(self, draw: random.Random) -> None:
        """A word that must change nothing."""
        text = junk_word(draw, self._observer.mission, self._published, self.events.now, self._observer.is_returning)
        if text is None:
            return
        self.fault_plan.count("junk")
        self._note(f"an unknown node publishes {text[:40]!r}")
        self.recorder.on_word(self.events.now, text, "")
        self._observer.call("hear", text)

    def _on_planner(self, name: str, *args: Any) -> None:
        self._note(f"the planner: {name} {args[0]}")
        self._observer.call(name, *args)

    # The record -------------------------------------------------------------------------------------------------------

    def _note(self, text: str) -> None:
        if self._record:
            self.lines.append(f"{self.events.now - START:9.3f}  {text}")

    def _log(self, level: str, text: str) -> None:
        if level != "info":
            self._note(f"observer, {level}: {text}")
            if not self.faulty:
                self._complaints.append(f"the observer warns: {text}")


def simulate_mission(stage: Stage, settings: Settings, seed: int, remaining: Optional[Remaining] = None,
         record: bool = False) -> Outcome:
    """One mission: the same for the same stage, settings and seed. `record`: with its play, a line for each event."""
    return SimulatedMission(stage, settings, seed, remaining, record).run()
