"""What rules, counts, states, assumptions and objectives are at, in the words that ui.yaml has for them."""

from __future__ import annotations

from typing import Any, Dict, Mapping, NamedTuple, Optional, Sequence, Tuple

from pursue_runtime.data import reading
from pursue_runtime.model import Model
from pursue_runtime.state import SystemState


class Status(NamedTuple):
    """An automaton or a variable, what it is called, and a text for each of its locations or values. `inside`: it is of
    the model, such as a rule that tells what comes after what, and says nothing to who runs a mission."""

    of: str
    label: str
    texts: Dict[str, str]
    inside: bool = False

    def text(self, locations: Mapping[str, str], values: Mapping[str, int]) -> Optional[str]:
        """What it is at where the automata are at these locations, and the variables have these values; None where it
        has no words for that."""
        return self.texts.get(locations.get(self.of) or str(values.get(self.of)))


def read_statuses(settings: Mapping[str, Any]) -> Tuple[Status, ...]:
    """The statuses in ui.yaml; none where it is of a version that had none. Raises DataError."""
    with reading("ui.yaml", "statuses"):
        given = [
            (each["of"], each["label"], dict(each["texts"]), each.get("inside", False))
            for each in settings.get("statuses", ())
        ]
    return tuple(
        Status(str(of), str(label), {str(key): str(text) for key, text in texts.items()}, inside is True)
        for of, label, texts, inside in given
    )


def status_texts(statuses: Sequence[Status], model: Model, state: SystemState, at: float) -> Dict[str, str]:
    """What each of them is at in a state that began at `at` (time units), and by when that has to change."""
    shown = {}
    for status in statuses:
        text = status.text(state.locations, state.values)
        if text is not None:
            due = deadline(status.of, model, state, at)
            shown[status.label] = text if due is None else f"{text}, by {round(due.moment, 1):g}"
    return shown


class Deadline(NamedTuple):
    """By when something has to change, and how long it may take in all; time units, `moment` since the start."""

    moment: float
    limit: float


def deadline(name: str, model: Model, state: SystemState, at: float) -> Optional[Deadline]:
    """The first deadline that an automaton has in a state that began at `at` (time units); None where it has none."""
    location = state.locations.get(name, "")
    known = any(each.name == name and location in each.invariants for each in model.automata)
    bounds = model.bounds_of(name, location, state.values) if known else ()
    known_clocks = [each for each in bounds if each.left in state.clocks]
    return min((Deadline(at + each.bound - state.clocks[each.left], each.bound) for each in known_clocks), default=None)
