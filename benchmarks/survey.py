"""What `pursue-gen survey` takes on a large map: python -m benchmarks.survey [--size 4000] [--places 30].

The map is a building of rooms of 10 m with doors of 0.9 m and things that stand about, at 5 cm per cell, written as a
PGM like map_saver's; the command then runs as a program of its own. The same seed makes the same map everywhere.
"""

from __future__ import annotations

import argparse
import random
import resource
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import List

RESOLUTION = 0.05
WALL, FREE = 0, 254
_ROOM, _DOOR, _THICK, _THING = 200, 18, 3, 6  # cells
_SHARE = 0.01  # of the floor is taken by things


def building(size: int, seed: int) -> List[bytearray]:
    """The rows of a map of so many cells a side."""
    rng = random.Random(seed)
    rows = [bytearray([FREE]) * size for _ in range(size)]

    def fill(x: int, y: int, width: int, height: int, grey: int) -> None:
        width, height = min(width, size - x), min(height, size - y)
        for row in rows[y : y + height]:
            row[x : x + width] = bytes([grey]) * width

    for at in [*range(0, size, _ROOM), size - _THICK]:
        fill(at, 0, _THICK, size, WALL)
        fill(0, at, size, _THICK, WALL)
    for x in range(0, size - _ROOM, _ROOM):
        for y in range(0, size - _ROOM, _ROOM):
            fill(x + _ROOM, y + 20 + rng.randrange(_ROOM - 60), _THICK, _DOOR, FREE)
            if rng.random() < 0.6:
                fill(x + 20 + rng.randrange(_ROOM - 60), y + _ROOM, _DOOR, _THICK, FREE)
    for _ in range(int(size * size * _SHARE / _THING**2)):
        fill(rng.randrange(size - _THING), rng.randrange(size - _THING), _THING, _THING, WALL)
    return rows


def scenario(rows: List[bytearray], places: int, seed: int) -> str:
    """A scenario of two robots and so many places on free ground."""
    rng, size, room = random.Random(seed), len(rows), 16
    lines: List[str] = []
    while len(lines) < places:
        x, y = rng.randrange(room, size - room), rng.randrange(room, size - room)
        if all(set(row[x - room : x + room]) == {FREE} for row in rows[y - room : y + room]):
            pose = f"{(x + 0.5) * RESOLUTION:.3f}, {(size - y - 0.5) * RESOLUTION:.3f}"
            lines.append(f'poi "p{len(lines)}" //[{pose}, 0, 0, 0, 0, 1]')
    lines += ['event "work" location p0 duration 3']
    lines += [f'agent "bot{k}" controllable mobile 2.5 location p{k} can_do work' for k in (1, 2)]
    return "\n".join([*lines, "reach_objective: do work", ""])


def main() -> None:
    """Prints the processor time, the time and the memory of the command."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--size", type=int, default=4000, help="cells along a side of the map")
    parser.add_argument("--places", type=int, default=30)
    parser.add_argument("--seed", type=int, default=1)
    chosen = parser.parse_args()
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        rows = building(chosen.size, chosen.seed)
        head = b"P5\n%d %d\n255\n" % (chosen.size, chosen.size)
        (folder / "floor.pgm").write_bytes(head + b"".join(rows))
        (folder / "map.yaml").write_text(f"image: floor.pgm\nresolution: {RESOLUTION}\norigin: [0, 0, 0]\n")
        (folder / "large.pur").write_text(scenario(rows, chosen.places, chosen.seed))
        command = [sys.executable, "-m", "pursue_gen", "survey", "map.yaml", "large.pur", "--speed", "0.4"]
        subprocess.run(command, cwd=name, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, check=True)
        copy = (folder / "large_surveyed.pur").read_text()
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    print(f"{chosen.size} x {chosen.size} cells, {chosen.places} places: {copy.count('connect')} ways")
    print(f"{used.ru_utime + used.ru_stime:.1f} s of processor time, {used.ru_maxrss / 1024:.0f} MiB")


if __name__ == "__main__":
    main()
