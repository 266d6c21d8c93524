"""What an answer has to be: each function makes one that reads an answer, or says what was expected (ValueError)."""

from __future__ import annotations

import difflib
from typing import Callable, Collection, Sequence, Tuple

from pursue_gen.language.names import check_names
from pursue_gen.language.parser import read


def a_name(taken: Collection[str]) -> Callable[[str], str]:
    """A name that the language knows and that nobody else has."""

    def accept(answer: str) -> str:
        reading = read(f'poi "{answer}"', "name.pur")
        if reading.scenario is None or [poi.name for poi in reading.scenario.pois] != [answer]:
            raise ValueError(f"expected a name of letters, digits and _, a letter first, not {answer!r}")
        for finding in check_names(reading.scenario):
            raise ValueError(f"{finding.message}; {finding.hint}")
        if answer in taken:
            raise ValueError(f"{answer} is taken already: a name stands for one thing; choose another one")
        return answer

    return accept


def a_name_or_nobody(taken: Collection[str]) -> Callable[[str], str]:
    """A name, or "" for nobody."""
    return lambda answer: "" if answer in ("", "-", "no", "nobody") else a_name(taken)(answer)


def names(taken: Collection[str], least: int, most: int) -> Callable[[str], Tuple[str, ...]]:
    """Some names, with commas between them."""

    def accept(answer: str) -> Tuple[str, ...]:
        found: Tuple[str, ...] = ()
        for word in answer.split(","):
            if word.strip() or not found:
                found += (a_name((*taken, *found))(word.strip()),)
        if not least <= len(found) <= most:
            raise ValueError(f"expected {least} to {most} names with commas between them, not {len(found)}")
        return found

    return accept


def a_number(least: int, most: int, why: str = "", or_nothing: bool = False) -> Callable[[str], int]:
    """A whole number; `why` tells where its limits come from; with `or_nothing` also 0 for nothing."""

    def accept(answer: str) -> int:
        if or_nothing and answer == "0":
            return 0
        if not (answer.isascii() and answer.isdigit() and len(answer) < 9 and least <= int(answer) <= most):
            expected = f"expected {'0, or ' * or_nothing}a whole number from {least} to {most}"
            raise ValueError(f"{expected}, not {answer!r}" + (why and f": {why}"))
        return int(answer)

    return accept


def one_of(choices: Sequence[str]) -> Callable[[str], str]:
    """One of these names."""

    def accept(answer: str) -> str:
        if answer in choices:
            return answer
        near = difflib.get_close_matches(answer, choices, n=1)
        hint = f" (did you mean {near[0]}?)" if near else ""
        raise ValueError(f"expected one of {', '.join(choices)}, not {answer!r}{hint}")

    return accept


def a_choice(words: Sequence[str]) -> Callable[[str], str]:
    """One of these words, or its number in the list."""

    def accept(answer: str) -> str:
        if answer.isascii() and answer.isdigit() and len(answer) < 9 and 1 <= int(answer) <= len(words):
            return words[int(answer) - 1]
        if answer not in words:
            raise ValueError(f"expected a number from 1 to {len(words)} or one of the words, not {answer!r}")
        return answer

    return accept
