"""Rounds of rules as expressions of which each symbol takes away the first part (a derivative), not as automata."""

from __future__ import annotations

from typing import Dict, List, Optional, Tuple, Union

from pursue_gen.language.scenario import Both, Choice, Event, Ref, RuleBody, Sequence

Rest = Union[str, Tuple[str, "Rest", "Rest"]]
"""The rest of a round: a symbol, or ("then" | "or" | "and", first, second); "" when it is over."""


def events_in(body: RuleBody) -> List[str]:
    """The events that a rule names."""
    return [body.name] if isinstance(body, Ref) else [*events_in(body.first), *events_in(body.second)]


def whole(body: RuleBody, events: Dict[str, Event]) -> Rest:
    """A round as an expression over symbols: an event without duration is one, a lasting one its beginning and end."""
    if isinstance(body, Ref):
        return body.name if events[body.name].duration is None else ("then", body.name, f"{body.name}DONE")
    word = {Sequence: "then", Choice: "or", Both: "and"}[type(body)]
    return word, whole(body.first, events), whole(body.second, events)


def after(rest: Rest, symbol: str) -> Optional[Rest]:
    """The rest behind a symbol; None where it is not the symbol's turn."""
    if isinstance(rest, str):
        return "" if rest == symbol else None
    word, first, second = rest
    left, right = after(first, symbol), after(second, symbol)
    if word == "or":
        return left if left is not None else right
    if word == "then":
        return None if left is None else second if left == "" else (word, left, second)
    if left is not None:
        return second if left == "" else (word, left, second)
    return None if right is None else first if right == "" else (word, first, right)
