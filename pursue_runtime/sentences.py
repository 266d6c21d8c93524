"""What nodes say of a mission, and of what is wrong with robots, on its way to people: a sentence in which the names of
the model are marked.

Marks are those of Python's format strings: `{bot1} is late on its way to {b}`. Who shows a sentence to people puts the
names there, or their labels; all other words stay as they are.
"""

from __future__ import annotations

from string import Formatter
from typing import Callable, Dict, Iterable, List, Mapping, Optional, Protocol, Set, Tuple

Log = Callable[[str, str], None]
"""Takes a level (debug, info, warn, err) and a sentence."""


class Names(Protocol):
    """What people read for a name: a model's labels, or MARKED."""

    def shown(self, name: str) -> str:
        """What stands in a text for this name."""


class _Marked:
    def shown(self, name: str) -> str:
        return marked(name)


MARKED: Names = _Marked()
"""In place of a model: what is made with it is part of a sentence."""


def marked(name: str) -> str:
    """Return the name of an agent, a place or an event as a part of a sentence."""
    return "{" + name + "}"


def quoted(text: str) -> str:
    """Return any text as a part of a sentence: nothing in it is marked."""
    return text.replace("{", "{{").replace("}", "}}")


def listed(names: Iterable[str], last: str = "and") -> str:
    """`a`, `a and b`, `a, b and c`; at least one."""
    *others, end = names
    return f"{', '.join(others)} {last} {end}" if others else end


def as_sentence(text: str) -> str:
    """Return a text of another program as a sentence: as it is if it is one, else quoted."""
    return quoted(text) if _parts(text) is None else text


def in_words(sentence: str, shown: Callable[[str], str] = str) -> str:
    """Return a sentence as people read it, with `shown` of each name; by default with the names. A text that is no
    sentence stays as it is."""
    parts = _parts(sentence)
    return sentence if parts is None else "".join(text + (shown(name) if name else "") for text, name in parts)


class Told:
    """What was said of the reason of a mission that holds. Parts of the reason (between semicolons) come and go while
    plans are looked for: people read each of them once."""

    def __init__(self) -> None:
        self._said: Set[str] = set()

    def news(self, reason: str) -> str:
        """Return the parts of the reason that were not said before; "" if there are none."""
        parts = [part for part in reason.split("; ") if part not in self._said]
        self._said.update(parts)
        return "; ".join(parts)

    def forget(self) -> None:
        """Begin anew: the mission goes on."""
        self._said.clear()


def _parts(sentence: str) -> Optional[List[Tuple[str, str]]]:
    """Return its words, piece by piece, each with the name behind it ("": none); None for what is no sentence."""
    try:
        parts = list(Formatter().parse(sentence))
    except ValueError:
        return None
    if any(name is not None and (spec or how or not name.isidentifier()) for _, name, spec, how in parts):
        return None
    return [(text, name or "") for text, name, _, _ in parts]


PREFIX = "robot "
"""Before the name of a robot: the key of what is wrong with it among a controller's values."""


def trouble_values(troubles: Mapping[str, str]) -> Dict[str, object]:
    """Return the values for /diagnostics of what is wrong with these robots."""
    return {f"{PREFIX}{robot}": text for robot, text in troubles.items()}


class Troubles:
    """Finds what is new in the values of controllers, which come once a second."""

    def __init__(self) -> None:
        self._known: Dict[str, Dict[str, str]] = {}

    def take(self, node: str, values: Mapping[str, str], reason: str) -> List[str]:
        """Return a sentence for each robot with which something is wrong that the values of this node did not say
        before, and that is not in the `reason` of the state."""
        found = {key[len(PREFIX) :]: as_sentence(text) for key, text in values.items() if key.startswith(PREFIX)}
        known, self._known[node] = self._known.get(node, {}), found
        news = {robot: text for robot, text in found.items() if text and known.get(robot) != text}
        return [f"{marked(robot)} {text}" for robot, text in news.items() if text not in reason]
