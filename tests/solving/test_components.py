"""Strongly connected components, held against what each node reaches."""

from __future__ import annotations

from typing import Dict, List, Set, Tuple

from hypothesis import given
from hypothesis import strategies as st

from pursue_gen.solving.components import components

NODES = "abcdefg"


@given(st.lists(st.tuples(st.sampled_from(NODES), st.sampled_from(NODES)), max_size=14))
def test_from_each_node_of_a_part_edges_lead_to_each(edges: List[Tuple[str, str]]) -> None:
    reached: Dict[str, Set[str]] = {node: {b for a, b in edges if a == node} for node in NODES}
    for via in NODES:
        for node in NODES:
            if via in reached[node]:
                reached[node] |= reached[via]
    parts = {frozenset(b for b in reached[a] if a in reached[b]) for a in NODES}
    assert components(edges) == sorted((set(part) for part in parts if part), key=sorted)
    assert components(reversed(edges)) == components(edges)
