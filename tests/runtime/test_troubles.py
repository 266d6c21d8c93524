"""What a page says of robots with which something is wrong: each sentence once."""

from __future__ import annotations

from typing import Any

from pursue_runtime.sentences import Troubles, trouble_values

SENT = "on its way to {b}: sent elsewhere by another node; its goal is sent again"


def values(**robots: str) -> Any:
    """The values of a controller."""
    return {"ready": "true", "seq": "7", **trouble_values(robots)}


def test_what_is_wrong_is_said_once_and_again_when_it_happens_again() -> None:
    troubles = Troubles()
    assert troubles.take("controller", values(), "") == []
    assert troubles.take("controller", values(bot=SENT), "") == [f"{{bot}} {SENT}"]
    assert troubles.take("controller", values(bot=SENT), "") == []
    assert troubles.take("controller", values(bot=SENT, bot2="is 3.0 m from {a}"), "") == ["{bot2} is 3.0 m from {a}"]
    assert troubles.take("controller", values(), "") == []
    assert troubles.take("controller", values(bot=SENT), "") == [f"{{bot}} {SENT}"]


def test_controllers_do_not_mix() -> None:
    troubles = Troubles()
    assert troubles.take("controller_bot", values(bot=SENT), "") == [f"{{bot}} {SENT}"]
    assert troubles.take("controller_bot2", values(), "") == []
    assert troubles.take("controller_bot", values(bot=SENT), "") == []


def test_what_is_the_reason_of_the_state_is_not_said_twice() -> None:
    assert Troubles().take("controller", values(bot="is 3.0 m from {a}"), "{bot} is 3.0 m from {a}, where …") == []
