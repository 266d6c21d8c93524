"""Strongly connected components: where edges lead to and fro."""

from __future__ import annotations

from typing import Dict, Iterable, List, Mapping, Sequence, Set, Tuple


def components(edges: Iterable[Tuple[str, str]]) -> List[Set[str]]:
    """The sets of nodes from each of which edges lead to each, itself included (Kosaraju; Sharir 1981), in order."""
    led: Dict[str, List[str]] = {}
    back: Dict[str, List[str]] = {}
    for source, target in edges:
        led.setdefault(source, []).append(target)
        back.setdefault(target, []).append(source)
    met: Set[str] = set()
    last: List[str] = []
    for start in led:
        last += _left(led, start, met)
    met, found = set(), []
    for start in reversed(last):
        part = set(_left(back, start, met))
        if len(part) > 1 or (part and start in led.get(start, ())):
            found.append(part)
    return sorted(found, key=sorted)


def _left(led: Mapping[str, Sequence[str]], start: str, met: Set[str]) -> List[str]:
    """The nodes to which edges lead from there, those that were met aside, in the order in which a search in depth
    leaves them; they are met then."""
    left: List[str] = []
    if start in met:
        return left
    met.add(start)
    way = [(start, iter(led.get(start, ())))]
    while way:
        node, following = way[-1]
        new = next((each for each in following if each not in met), None)
        if new is None:
            left.append(node)
            way.pop()
        else:
            met.add(new)
            way.append((new, iter(led.get(new, ()))))
    return left
