"""What UPPAAL-TIGA logged about a scenario: read from the output of `verifytga -t0` as it was published."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Dict, Optional, Union

_ESCAPE = re.compile(r"\x1b\[[0-9;?]*[A-Za-z]")
_PROGRESS = re.compile(r"Throughput: (\d+) states/sec, Size: (\d+) states, Load: (\d+) states")
_HEADER = re.compile(r"^[ \t]*(?:Strategy|Counter[ -]strategy) to [^\n:]*:", re.MULTILINE | re.IGNORECASE)


@dataclass(frozen=True)
class Figures:
    """`states` and `waiting`: symbolic states on the last progress line, and how many of them were still to be looked
    at (the run went on for a little). `rate`: symbolic states per second, the best of its throughput lines.
    `blocks`, `commands`: of its strategy or counter-strategy. None: the output does not say.
    """

    states: Optional[int]
    waiting: Optional[int]
    rate: Optional[int]
    blocks: Optional[int]
    commands: Optional[int]

    def as_json(self) -> Dict[str, Union[int, None]]:
        """The figures by name."""
        return dict(vars(self))


NOTHING = Figures(None, None, None, None, None)
"""Where no output of TIGA is at hand."""


def figures(output: str) -> Figures:
    """The figures in an output of verifytga, complete or cut; one without any of them gives `NOTHING`."""
    text = _ESCAPE.sub("", output)
    progress = [tuple(map(int, match.groups())) for match in _PROGRESS.finditer(text)]
    header = _HEADER.search(text)
    blocks = commands = None
    if header is not None:
        lines = text[header.end() :].splitlines()
        blocks = sum(line.lstrip().startswith("State:") for line in lines)
        commands = sum(line.lstrip().startswith("When you are in") for line in lines)
    if not progress:
        return Figures(None, None, None, blocks, commands)
    _, states, waiting = progress[-1]
    return Figures(states, waiting, max(rate for rate, _, _ in progress), blocks, commands)
