"""What is wrong with robots, as their controllers' /diagnostics have it."""

from __future__ import annotations

from typing import Dict, List, Mapping

from pursue_runtime.sentences import as_sentence, marked

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
