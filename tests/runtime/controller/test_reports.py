"""A report is published until it is answered, at once when an observer appears, with the time at which it became true.
"""

from __future__ import annotations

from pursue_runtime.event_words import FAILED, RobotReport, Word, parse_report, parse_word
from pursue_runtime.resend import RepeatedReport


def test_what_is_published_again_carries_the_time_of_the_first() -> None:
    report = RepeatedReport(Word("", "bot_going_a_to_b2b", as_of=7), reaction=0.1)
    assert report.next_moment() is None
    assert report.due(1000.25, 50.0) == "bot_going_a_to_b2b#7"
    for number in range(40):
        moment = report.next_moment()
        assert moment is not None and report.due(1001.0 + number, moment - 0.001) is None
        assert report.due(1001.0 + number, moment) == "bot_going_a_to_b2b#7~1000.250000"
    report.confirmed = True
    assert report.due(2000.0, 1e6) is None and report.next_moment() is None


def test_it_is_published_at_once_when_an_observer_appears_however_often_it_was() -> None:
    report = RepeatedReport(RobotReport("bot", FAILED, "no way", 3), reaction=0.1)
    real = 10.0
    for _ in range(30):  # it has waited for long: the next one would come seconds later
        report.due(500.0, real)
        real = report.next_moment() or 0.0
    assert report.due(600.0, real) is not None and report.due(600.0, real + 1.0) is None
    report.say_again()
    text = report.due(600.0, real + 1.0)
    assert text == "bot:_failed_#3~500.000000 no way" and parse_word(text) is None
    read = parse_report(text)
    assert read is not None and (read.text, read.at) == ("no way", 500.0)
    assert report.due(600.0, real + 1.001) is None


def test_what_is_confirmed_or_was_never_due_is_not_published_for_an_observer_that_appears() -> None:
    report = RepeatedReport(Word("", "done", as_of=1))
    report.due(1.0, 1.0)
    report.confirmed = True
    report.say_again()
    assert report.due(2.0, 2.0) is None


def test_a_report_without_a_number_has_no_time() -> None:
    report = RepeatedReport(Word("", "done"))
    assert [report.due(1.0, real) for real in (1.0, 100.0)] == ["done", "done"]
