"""What rules, counts, states, assumptions and objectives are at, in the words that ui.yaml has for them."""

from __future__ import annotations

from typing import Any, Dict, Mapping, NamedTuple, Optional, Sequence, Tuple

from pursue_runtime.data import reading
from pursue_runtime.model import Model
from pursue_runtime.state import SystemState


class Status(NamedTuple):
    """An automaton or a variable, what it is called, and a text for each of its locations or values."""

    of: str
    label: str
    texts: Dict[str, str]

    def text(self, locations: Mapping[str, str], values: Mapping[str, int]) -> Optional[str]:
        """What it is at where the automata are at these locations, and the variables have these values; None where it
        has no words for that."""
        return self.texts.get(locations.get(self.of) or str(values.get(self.of)))


def read_statuses(settings: Mapping[str, Any]) -> Tuple[Status, ...]:
    """The statuses in ui.yaml; none where it is of a version that had none. Raises DataError."""
    with reading("ui.yaml", "statuses"):
        given = [(each["of"], each["label"], dict(each["texts"])) for each in settings.get("statuses", ())]
    return tuple(
        Status(str(of), str(label), {str(key): str(text) for key, text in texts.items()}) for of, label, texts in given
    )


def status_texts(statuses: Sequence[Status], model: Model, state: SystemState, at: float) -> Dict[str, str]:
    """What each of them is at in a state that began at `at` (time units), and by when that has to change."""
    places = {automaton.name: automaton.invariants for automaton in model.automata}
    shown = {}
    for status in statuses:
        location = state.locations.get(status.of, "")
        text = status.text(state.locations, state.values)
        if text is None:
            continue
        bounds = model.bounds_of(status.of, location, state.values) if location in places.get(status.of, {}) else ()
        due = [at + bound.bound - state.clocks[bound.left] for bound in bounds if bound.left in state.clocks]
        shown[status.label] = f"{text}, by {round(min(due), 1):g}" if due else text
    return shown
