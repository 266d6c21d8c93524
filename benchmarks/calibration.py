"""How large a share of later drives is in the windows that `pursue-gen calibrate` makes of a few.

    python -m benchmarks.calibration --out docs

Times are drawn at random: a window is made of some, and later ones are held against it, many times over.
"""

from __future__ import annotations

import argparse
import re
import sys
from pathlib import Path
from random import Random
from typing import Callable, Dict, List, Optional, Tuple

from pursue_gen.language import parse
from pursue_gen.tools.calibration.picture import draw
from pursue_gen.tools.calibration.proposal import Options, propose
from pursue_gen.tools.calibration.samples import Measured, Sample, Samples, Way, Work
from pursue_gen.tools.calibration.windows import spread_of, window_of

NOISES: Dict[str, Callable[[Random], float]] = {
    "normal": lambda random: max(0.2, random.gauss(1.0, 0.1)),
    "lognormal": lambda random: random.lognormvariate(0.0, 0.15),
    "skewed": lambda random: 0.8 + random.gammavariate(2.0, 0.1),
    "uniform": lambda random: random.uniform(0.9, 1.3),
    "two routes": lambda random: random.gauss(1.0 if random.random() < 0.6 else 1.5, 0.05),
    "blocked": lambda random: random.gauss(1.0, 0.05) + (random.uniform(0.3, 0.8) if random.random() < 0.03 else 0.0),
}
"""How long drives take, as multiples of the usual time."""

ABOUT = {
    "normal": "normal, deviation 10 %",
    "lognormal": "lognormal, deviation 15 %",
    "skewed": "a minimum, and a gamma-distributed rest",
    "uniform": "uniform from 0.9 to 1.3",
    "two routes": "two routes, 1 and 1.5, chosen 6 : 4",
    "blocked": "3 of 100 drives wait for somebody in the way",
}

COUNTS = (5, 10, 20, 50, 100, 473)
_PART = re.compile(r"(<!-- measured: coverage -->\n)(.*?)(<!-- end -->)", re.DOTALL)


def coverage(noise: str, count: int, windows: int = 400, later: int = 1000, seed: int = 1) -> float:
    """The share of later times in windows of so many times; the mean of all windows."""
    return measured(noise, count, windows, later, seed)[0]


def measured(noise: str, count: int, windows: int, later: int, seed: int) -> Tuple[float, float]:
    """The share, and how wide the windows are: the median of their width, in usual times."""
    random, draw, held = Random(f"{noise} {count} {seed}"), NOISES[noise], 0
    widths: List[float] = []
    for _ in range(windows):
        window = window_of([draw(random) for _ in range(count)])
        held += sum(window.low <= draw(random) <= window.high for _ in range(later))
        widths.append(window.high - window.low)
    return held / (windows * later), spread_of(widths).median


def table(windows: int = 400, later: int = 1000, seed: int = 1) -> str:
    """The table of the page."""
    lines = [
        "| times of drives | " + " | ".join(f"{count} drives" for count in COUNTS) + " |",
        "| --- |" + " ---: |" * len(COUNTS),
    ]
    for noise in NOISES:
        found = (measured(noise, count, windows, later, seed) for count in COUNTS)
        lines.append(f"| {ABOUT[noise]} | " + " | ".join(f"{100 * s:.2f} ({w:.2f})" for s, w in found) + " |")
    return "\n".join(lines) + "\n"


FLOOR = """\
poi "desk"
poi "shelf"
poi "window"
connect desk and shelf distance 4
connect desk and window distance 9
event "fetch" location shelf duration 3
agent "bot1" controllable mobile 1 location desk can_do fetch
agent "bot2" controllable mobile 2 location desk
reach_objective: do fetch
"""


def picture() -> str:
    """An example of what calibrate draws: simulated drives, one of them with somebody in the way."""
    random, scenario = Random("picture"), parse(FLOOR, "my_floor.pur", "my_floor")
    kinds: List[Tuple[Measured, float, int]] = [
        (Way("bot1", "desk", "shelf"), 5.0, 18),
        (Way("bot1", "shelf", "desk"), 5.6, 18),
        (Way("bot1", "desk", "window"), 11.0, 40),
        (Way("bot1", "window", "desk"), 10.0, 3),
        (Way("bot2", "desk", "shelf"), 9.2, 12),
        (Work("fetch"), 3.6, 15),
    ]
    samples = [Sample(what, usual * random.lognormvariate(0.0, 0.08)) for what, usual, n in kinds for _ in range(n)]
    samples.append(Sample(Way("bot1", "desk", "window"), 19.0))
    return draw(propose(scenario, Samples(tuple(samples), unit=1.0), Options()))


def filled(page: str, text: str) -> str:
    """The page with this table."""
    return _PART.sub(lambda match: f"{match[1]}\n{text}\n{match[3]}", page)


def main(arguments: Optional[List[str]] = None) -> int:
    """Prints the table, and writes it into the page, with the picture."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--out", type=Path, help="the folder of calibrate.md")
    given = parser.parse_args(arguments)
    text = table()
    print(text, end="")
    if given.out is not None:
        from pursue_gen.files import write_texts

        page = given.out / "calibrate.md"
        texts = {page: filled(page.read_text(encoding="utf-8"), text)}
        write_texts({**texts, given.out / "pictures" / "measured_times.svg": picture()})
    return 0


if __name__ == "__main__":
    sys.exit(main())
