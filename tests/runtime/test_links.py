"""Connections of publishers that were silent are made anew, once, then ever more rarely; a lost master is told from one
that is only out of reach."""

from __future__ import annotations

from typing import Any, Dict, List

import pytest

from pursue_runtime.links import FIRST_WAIT, LAST_WAIT, MASTER_PROBLEMS, MasterWatch, Peers, Unanswered

REGISTERED, NOT_REGISTERED, REFUSED, FOREIGN, UNREACHABLE = "known", "stranger", "refused", "foreign", "unreachable"


def spoken(peers: Any, until: float, since: float = 0.0, name: str = "/bot", first: int = 1) -> int:
    """The publisher speaks every second; how many messages it has sent then."""
    count, now = first, since
    while now < until:
        peers.update({name: count}, now)
        count, now = count + 1, now + 1.0
    return count - 1


def test_who_speaks_is_left_alone() -> None:
    peers = Peers()
    spoken(peers, until=500.0)
    assert peers.silent(500.0) == [] == peers.due()


def test_who_was_silent_gets_new_connections_even_if_received_again_before() -> None:
    peers = Peers(silence=3.0)
    count = spoken(peers, until=10.0)
    peers.update({"/bot": count}, 11.5)
    assert peers.due() == [], "not yet"
    peers.update({"/bot": count}, 12.0)
    assert peers.silent(12.0) == ["/bot"] == peers.due()
    peers.update({"/bot": count + 1}, 13.0)
    assert peers.silent(13.0) == [] and peers.due() == ["/bot"], "its other connections may still be dumb"
    peers.on_renewed("/bot", 13.5)
    spoken(peers, since=14.0, until=100.0)
    assert peers.due() == []


def test_it_is_due_until_it_could_be_done() -> None:
    peers = Peers()
    spoken(peers, until=3.0)
    for now in range(5, 200):
        peers.update({"/bot": 3}, float(now))
        assert peers.due() == ["/bot"]


def test_only_the_silent_one_is_due() -> None:
    peers = Peers()
    for now in range(10):
        peers.update({"/bot1": now, "/bot2": min(now, 2)}, float(now))
    assert peers.due() == ["/bot2"] and len(peers) == 2


def test_a_connection_without_an_answer_is_tried_anew_after_some_looks_and_again_after_as_many() -> None:
    unanswered = Unanswered()
    due = [unanswered.look([1, 2] if look != 5 else [1]) for look in range(1, 13)]
    assert [look for look, found in enumerate(due, 1) if 1 in found] == [4, 8, 12]
    assert [look for look, found in enumerate(due, 1) if 2 in found] == [4, 9], "it was away at the fifth look"


def tries(peers: Any, since: int, until: int, count: int) -> List[float]:
    """The moments at which the silent publisher gets new connections."""
    found: List[float] = []
    for now in range(since, until):
        peers.update({"/bot": 0 if found else count}, float(now))
        if peers.due():
            found.append(float(now))
            peers.on_renewed("/bot", float(now))
    return found


def test_who_stays_silent_on_new_connections_is_tried_ever_more_rarely() -> None:
    peers = Peers()
    peers.update({"/bot": 7}, 0.0)
    moments = tries(peers, 1, 600, count=7)
    pauses = [later - earlier for earlier, later in zip(moments, moments[1:])]
    assert pauses == sorted(pauses) and pauses[0] == FIRST_WAIT and pauses[-1] == LAST_WAIT
    peers.update({"/bot": 1}, 600.0)
    again = next(now for now in range(601, 700) if peers.update({"/bot": 1}, float(now)) or peers.due())
    assert again <= 604 + LAST_WAIT, "once heard, it is not forgotten"


def test_who_has_spoken_since_its_last_new_connections_is_tried_soon_again() -> None:
    peers = Peers()
    peers.update({"/bot": 7}, 0.0)
    tries(peers, 1, 600, count=7)
    count = spoken(peers, since=600.0, until=700.0)
    first, second = tries(peers, 700, 800, count)[:2]
    assert first < 710.0 and second - first == FIRST_WAIT


def test_connections_that_rospy_itself_made_anew_count_from_zero() -> None:
    peers = Peers(silence=3.0)
    count = spoken(peers, until=100.0)
    assert count == 100
    peers.update({}, 100.0)
    spoken(peers, since=101.0, until=200.0)
    assert peers.due() == [] and peers.silent(200.0) == []


def test_who_is_gone_is_forgotten() -> None:
    peers = Peers()
    spoken(peers, until=5.0)
    peers.update({}, 10.0)
    assert len(peers) == 1
    peers.update({}, 300.0)
    assert len(peers) == 0 and peers.due() == []


def verdicts(*answers: str) -> Dict[int, bool]:
    """second → is the master lost? It is asked every second."""
    watch = MasterWatch(patience=10.0)
    found = {}
    for second, answer in enumerate(answers):
        watch.update(answer, float(second))
        found[second] = watch.lost(float(second))
    return found


@pytest.mark.parametrize("gone", [[REFUSED] * 20, [NOT_REGISTERED] * 20, [REFUSED] * 5 + [NOT_REGISTERED] * 15,
                                  [FOREIGN] * 20, [REFUSED] * 5 + [FOREIGN] * 15])
def test_a_master_that_is_gone_or_another_one_is_given_up_after_a_while(gone: List[str]) -> None:
    found = verdicts(REGISTERED, *gone)
    assert not any(found[second] for second in range(11)) and found[11]


def test_a_master_that_cannot_be_reached_is_waited_for() -> None:
    assert not any(verdicts(REGISTERED, *[UNREACHABLE] * 300, REGISTERED).values())


def test_patience_starts_anew_when_it_was_back_or_out_of_reach() -> None:
    for between in (REGISTERED, UNREACHABLE):
        found = verdicts(*[REFUSED] * 9, between, *[REFUSED] * 9)
        assert not any(found.values())


def test_what_the_master_is_like_is_news_once() -> None:
    watch = MasterWatch()
    answers = REGISTERED, REFUSED, REFUSED, REGISTERED, UNREACHABLE, UNREACHABLE
    news = [watch.update(answer, 0.0) for answer in answers]
    assert news == [False, True, False, True, True, False]
    assert set(MASTER_PROBLEMS) == {REGISTERED, NOT_REGISTERED, REFUSED, FOREIGN, UNREACHABLE}
    assert MASTER_PROBLEMS[REGISTERED] == ""
