"""The names of the network: which locations are on the way or at work, and what they are called."""

from __future__ import annotations

import pytest

from pursue_gen.language.network_names import doing, going, in_words, is_doing, is_going, is_under_way


@pytest.mark.parametrize(
    ("location", "way", "work", "words"),
    [
        (going("a", "b"), True, False, "on the way from a to b"),
        (doing("catch", "b"), False, True, "doing catch at b"),
        ("a", False, False, "at a"),
        ("along_the_way", False, False, "at along_the_way"),
    ],
)
def test_a_location_shows_what_its_agent_does(location: str, way: bool, work: bool, words: str) -> None:
    assert (is_going(location), is_doing(location)) == (way, work)
    assert is_under_way(location) == (way or work)
    assert in_words(location) == words
