"""What the page shows, as values for JSON, and what it may ask for.

Moments are time units since the start of the mission.
"""

from __future__ import annotations

from types import MappingProxyType
from typing import Any, Dict, List, Mapping, NamedTuple, Optional, Sequence, Tuple

from pursue_runtime.data import reading
from pursue_runtime.event_words import START, event_in
from pursue_runtime.locations import FINDING_OUT, TO_BE_SAID, is_action, is_end, is_movement
from pursue_runtime.model import ACTING, Automaton, Model
from pursue_runtime.poses import read_poses
from pursue_runtime.sentences import Told, in_words, listed
from pursue_runtime.simulator.simulator import end_window, report_word
from pursue_runtime.state import HOLDING, LIVE, RUNNING, WAITING, SystemState
from pursue_runtime.ui.floor import Floor
from pursue_runtime.ui.lanes import Lanes
from pursue_runtime.ui.mission_view import possible_words, tasks
from pursue_runtime.ui.outlook import Outlook
from pursue_runtime.ui.promise import NOTHING, Guarantee, Promise, objectives_now, with_written
from pursue_runtime.ui.statuses import Status, status_texts
from pursue_runtime.ui.strategies import Strategies
from pursue_runtime.ui.waits import AtDoors
from pursue_runtime.vocabulary import awaited, begin_of, deed, place, said_at_start, sentence, value_found, where

MAX_ENTRIES = 300  # entries of the log
SHOWN_ANSWERS = 4  # the newest answers to orders
NOTE, GOOD, BAD = "note", "good", "bad"


class FloorPlan(NamedTuple):
    """Where the points of interest are (metres), and which of them are connected, at which distance.

    `one_ways`: the connections that go from the first to the second place only.
    """

    places: Dict[str, Tuple[float, float]]
    ways: Tuple[Tuple[str, str, float], ...]
    one_ways: Tuple[Tuple[str, str], ...] = ()


def read_floor_plan(poses: Mapping[str, Any], settings: Mapping[str, Any]) -> FloorPlan:
    """The map, from poses.yaml and ui.yaml. Raises DataError."""
    places = {name: (pose[0], pose[1]) for name, pose in read_poses(poses).places.items()}
    with reading("ui.yaml"):
        given = [(str(a), str(b), float(length), more) for a, b, length, *more in settings.get("connections", ())]
    known = [way for way in given if way[0] in places and way[1] in places]
    one_ways = tuple((a, b) for a, b, _, more in known if more == ["one_way"])
    return FloorPlan(places, tuple((a, b, length) for a, b, length, _ in known), one_ways)


class Facts(NamedTuple):
    """What the node knows: its phase, who is missing, the last state and its moment, the end, and the present.

    `answers` is False while the observer does not answer; `received` is when the last state came (Unix time). `stays`:
    the page outlives the mission; `offers` is what it offers then (requests without a word).
    """

    phase: str
    missing: Sequence[str]
    state: Optional[SystemState]
    at: float
    now: float
    verdict: Optional[Tuple[int, str]] = None
    answers: bool = True
    received: float = 0.0
    stays: bool = False
    offers: Tuple[str, ...] = ()

    @property
    def live(self) -> bool:
        """True while time counts."""
        return self.state is not None and self.state.status in LIVE


class Page:
    """What there is to show, from the states of one mission."""

    def __init__(
        self,
        model: Model,
        plan: FloorPlan,
        reporters: Sequence[str] = (),
        statuses: Sequence[Status] = (),
        promise: Promise = NOTHING,
        strategies: Strategies = MappingProxyType({}),
        floor: Optional[Floor] = None,
        at_doors: Optional[AtDoors] = None,
    ) -> None:
        """`reporters`: the agents whose ends are reported on the page; `statuses`: the words for all but agents;
        `promise`: what is to be achieved; `strategies`: those of all plans, where they are known; `floor`: what
        lies under the map; `at_doors`: who waits for which door or lift."""
        self._model = model
        self._told, self._at_doors = Told(), at_doors or AtDoors({}, str)
        self._statuses = statuses
        self._promise = promise
        watching = {name for objective in promise.objectives for name in objective.of}
        others = [status for status in statuses if status.of not in watching]  # than those of objectives
        self._others = [status for status in others if not status.inside]
        self._inside = [status for status in others if status.inside]
        self._guarantee = Guarantee(promise, model)
        self._outlook = Outlook(model, statuses, strategies)
        self._plan = plan
        self._floor = floor
        self._reporters = reporters
        self._acting = model.acting
        self._last: Optional[SystemState] = None
        self._lanes = Lanes(model, promise)
        self._answers: List[Dict[str, Any]] = []
        self._number = 0
        self.log: List[Dict[str, Any]] = []

    def scene(self) -> Dict[str, Any]:
        """What stays as it is: the map, who takes part, whose ends are reported here, and a button for each thing that
        nobody controls."""
        return {
            "scenario": self._model.scenario,
            "counts": self._promise.counts or "time units",
            "finishes": not self._model.goal,
            "labels": self._model.labels,
            "places": {name: list(place) for name, place in self._plan.places.items()},
            "floor": None if self._floor is None else self._floor.scene(),
            "ways": [list(way) for way in self._plan.ways],
            "one_ways": [list(way) for way in self._plan.one_ways],
            "agents": [{"name": automaton.name, "kind": automaton.kind} for automaton in self._acting],
            "start": {automaton.name: automaton.initial for automaton in self._acting},
            "reporters": [automaton.name for automaton in self._acting if automaton.name in self._reporters],
            "orders": [{"word": word, "label": self._model.shown(word)} for word in self._model.orders],
            "buttons": [button for automaton in self._model.of_kind("agent") for button in self._buttons(automaton)],
        }

    def view(self, facts: Facts) -> Dict[str, Any]:
        """What changes."""
        state = facts.state or self._unstarted()
        offers = possible_words(self._model, state, state.clocks, ACTING, ends=True) if state.status in LIVE else []
        opens = {offer.word: [_round(facts.at + offer.opens), _end(facts.at, offer.closes)] for offer in offers}
        agents = [self._agent(automaton, state, facts.at) for automaton in self._acting]
        sight = self._outlook.sight(state, facts.at, offers)
        for agent in agents:
            agent.update(sight.agents.get(agent["name"], {"why": "", "then": None}))
            agent["next"] = [
                {"may": self._may(offer.agent, offer.word, state), "opens": opens[offer.word][0],
                 "closes": opens[offer.word][1], "answer": sight.answers.get(offer.word)}
                for offer in offers if offer.agent == agent["name"]
            ]
        others = [automaton.name for automaton in self._model.automata if automaton not in self._acting]
        return {
            "phase": facts.phase, "missing": list(facts.missing), "status": state.status,
            "reason": in_words(state.reason, self._model.shown),
            "verdict": facts.verdict[1] if facts.verdict else "", "good": bool(facts.verdict and not facts.verdict[0]),
            "at": _round(facts.at), "now": _round(facts.now), "live": state.status in LIVE, "unit": state.unit,
            "turn": self._turn(agents, state, sight.planned), "agents": agents, "open": opens,
            "tasks": self._tasks(state, agents),
            "objectives": objectives_now(
                with_written(self._promise, self._model, state), self._statuses, self._model, state, facts.at
            ),
            "guarantee": self._guarantee.now(state), "next": sight.next, "planned": sight.planned,
            "clocks": {name: _round(value) for name, value in state.clocks.items()},
            "statuses": {**self._broken(state), **status_texts(self._others, self._model, state, facts.at)},
            "inside": status_texts(self._inside, self._model, state, facts.at),
            "rest": {**{name: state.locations.get(name, "") for name in others}, **state.values},
            "seq": state.seq, "plan": state.plan, "lost": list(state.lost),
            "out_of_service": list(state.out_of_service),
            "ordered": self._answers, "answers": facts.answers, "received": _round(facts.received),
            "stays": facts.stays, "offers": list(facts.offers),
            "lanes": self._lanes.shown() if facts.verdict else None,
        }

    def add_plan(self, plan: Mapping[str, Any]) -> None:
        """Take a new plan, as `parse_plan` returns it; its strategies are among those of the page."""
        self._guarantee.add_plan(plan["plan"], plan)

    def on_state(self, state: SystemState, at: float) -> List[Dict[str, Any]]:
        """A state came; what is new in the log."""
        last, self._last = self._last, state
        self._guarantee.on_state(state, at)
        self._outlook.on_state(state)
        self._lanes.on_state(state, at)
        fresh: List[Dict[str, Any]] = []
        if (last is None and state.event == START) or (last and last.status == WAITING and state.status in LIVE):
            fresh.append(self.note(at, f"the mission starts{said_at_start(self._model)}"))
        if state.seq and state.event not in ("", START) and (last is None or last.seq != state.seq):
            fresh.append(self.note(at, sentence(self._model, state, last), self._kind(state.agent), state.event))
        for name in state.lost if last is None else sorted(set(state.lost) - set(last.lost)):
            fresh.append(self.note(at, f"{self._model.shown(name)} counts as lost", BAD))
        if last is not None:
            for name in sorted(set(last.lost) - set(state.lost)):
                fresh.append(self.note(at, f"{self._model.shown(name)} is back"))
            if last.plan != state.plan:
                fresh.append(self.note(at, f"plan {state.plan} is in force"))
        news = self._told.news(state.reason or "no reason is given") if state.status == HOLDING else ""
        if news:
            fresh.append(self.note(at, f"the mission holds: {in_words(news, self._model.shown)}", BAD))
        if last is not None and last.status == HOLDING and state.status == RUNNING:
            self._told.forget()
            fresh.append(self.note(at, "the mission goes on"))
        if state.status == RUNNING and state.reason and (last is None or state.reason != last.reason):
            fresh.append(self.note(at, in_words(state.reason, self._model.shown)))
        return fresh

    def on_answer(self, at: float, order: str, accepted: bool, text: str) -> None:
        """Take the answer to an order."""
        answer = {"at": _round(at), "order": order, "accepted": accepted, "text": in_words(text, self._model.shown)}
        self._answers = [answer, *self._answers][:SHOWN_ANSWERS]
        self.note(at, f"{order}: {answer['text']}", GOOD if accepted else BAD)

    def note(self, at: float, text: str, kind: str = NOTE, word: str = "") -> Dict[str, Any]:
        """Adds an entry to the log, and returns it."""
        self._number += 1
        entry = {"n": self._number, "at": _round(at), "text": text, "kind": kind, "word": word}
        self.log = [*self.log, entry][-MAX_ENTRIES:]
        return entry

    # Agents -----------------------------------------------------------------------------------------------------------

    def _agent(self, automaton: Automaton, state: SystemState, at: float) -> Dict[str, Any]:
        """Where an agent is, what it does, and between which moments that ends."""
        location = state.locations.get(automaton.name, automaton.initial)
        origin, to = self._where(automaton, location)
        window = end_window(self._model, automaton, location)
        agent: Dict[str, Any] = {
            "name": automaton.name, "place": origin, "to": to,
            "doing": f"is {place(self._model, automaton, location)}",
            "awaited": awaited(self._model, automaton, location),
            "notes": [text for text, agents in self._notes(state) if automaton.name in agents],
            "since": None, "low": None, "high": None, "lost": automaton.name in state.lost,
        }
        if window is not None and window.clock in state.clocks:
            since = at - state.clocks[window.clock]
            agent.update(since=_round(since), low=_round(since + window.low), high=_end(since, window.high))
        return agent

    def _broken(self, state: SystemState) -> Dict[str, str]:
        """The assumptions that are broken."""
        broken = [each.says for each in self._model.assumptions if state.values.get(each.variable) == 0]
        return dict.fromkeys(broken, "broken: not assumed any more")

    def _notes(self, state: SystemState) -> Sequence[Tuple[str, Sequence[str]]]:
        """What has to be known of agents besides, and of which."""
        return (
            ("counts as lost", state.lost), ("held, until it is resumed", state.held),
            ("is not known to be there", [name for name in state.displaced if name not in state.returning]),
            ("is sent back there", state.returning), ("has finished", state.finished),
            ("out of service", state.out_of_service),
            ("is not needed in this mission", () if state.plan else self._promise.unneeded),
            *((says, [name]) for name, says in self._at_doors.says(state).items()),
        )

    def _where(self, automaton: Automaton, location: str) -> Tuple[str, str]:
        """The point of interest where that is, and the one that it leads to ("" where there is none)."""
        if location in self._plan.places:
            return location, ""
        if location in TO_BE_SAID:
            return "", ""  # nobody has said yet where it is
        end = next((edge.target for edge in automaton.edges_from(location) if is_end(location, edge.target)), "")
        begin = begin_of(automaton, location)
        if is_movement(location) and begin is not None and end:
            return begin.source, end
        # An action ends where it began; it may be on a way.
        return self._where(automaton, end) if end and end != location and not is_action(end) else ("", "")

    def _turn(self, agents: Sequence[Mapping[str, Any]], state: SystemState, planned: bool) -> str:
        """Whom the mission waits for, in a sentence; "" where it is nobody, and what is next is said anyhow."""
        if state.status == HOLDING:
            return "No commands are sent while the mission holds."
        if state.status != RUNNING:
            return ""
        present = [agent for agent in agents if not agent["lost"]]
        shown = self._model.shown
        under_way = [f"{shown(agent['name'])} to {agent['awaited']}" for agent in present if agent["awaited"]]
        if under_way:
            return f"Waits for {listed(under_way)}."
        if planned:
            return ""
        alone = {automaton.name for automaton in self._model.of_kind("agent")}
        free = [shown(agent["name"]) for agent in present if agent["name"] in alone and agent["next"]]
        others = f", or for what {listed(free, 'or')} may do" if free else ""
        return f"Waits for the next command of the strategy{others}."

    def _tasks(self, state: SystemState, agents: Sequence[Mapping[str, Any]]) -> List[Dict[str, Any]]:
        """What agents do now whose ends are reported here, and the word for the end."""
        if state.status not in LIVE:
            return []
        windows = {agent["name"]: {key: agent[key] for key in ("since", "low", "high")} for agent in agents}
        return [{**task._asdict(), **windows[task.agent]} for task in tasks(self._model, state, self._reporters)]

    # Words ------------------------------------------------------------------------------------------------------------

    def _buttons(self, automaton: Automaton) -> List[Dict[str, Any]]:
        """One for each thing that the agent may begin, possible now or not, with the locations where it may."""
        found: Dict[str, Dict[str, Any]] = {}
        for edge in automaton.edges:
            if edge.sync != "receive" and (not edge.is_end or edge.source in TO_BE_SAID):
                word = report_word(self._model, automaton.name, edge.word)
                label = self._label(automaton.name, word)
                button = found.setdefault(word, {"agent": automaton.name, "word": word, "label": label, "from": []})
                if edge.source not in button["from"]:
                    button["from"].append(edge.source)
        return list(found.values())

    def _label(self, agent: str, word: str) -> str:
        """What its agent does with a word, for a button."""
        automaton = self._model.automaton(agent)
        event = event_in(word)
        edges = (edge for edge in automaton.edges if edge.word == event and edge.source != edge.target)
        edge = next(edges, None)
        if edge is not None and edge.source == FINDING_OUT:
            return f"is {value_found(edge)}"
        if edge is not None and edge.source in TO_BE_SAID:
            return f"starts at {self._model.shown(edge.target)}"
        moves = edge is not None and is_movement(edge.target)
        return where(self._model, automaton, edge.target) if edge and moves else self._model.shown(event)

    def _may(self, agent: str, word: str, state: SystemState) -> str:
        """What its agent may do with a word, behind the word may."""
        automaton = self._model.automaton(agent)
        event = event_in(word)
        edges = (edge for edge in automaton.edges_from(state.locations[agent]) if edge.word == event)
        edge = next(edges, None)
        return deed(self._model, automaton, edge).do if edge is not None else self._model.shown(event)

    def _kind(self, agent: str) -> str:
        return next((automaton.kind for automaton in self._acting if automaton.name == agent), NOTE)

    def _unstarted(self) -> SystemState:
        """Before the first state."""
        return SystemState(0, 0.0, *self._model.initial(), status=WAITING)


def _round(number: float) -> float:
    """Milliseconds are enough, and short."""
    return round(number, 3)


def _end(start: float, after: float) -> Optional[float]:
    """The moment that long after the start; None: never."""
    return None if after == float("inf") else _round(start + after)
