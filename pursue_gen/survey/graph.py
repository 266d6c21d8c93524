"""The graph in which ways are looked for: regions of free cells, and which of them are neighbours.

The grid is cut into square blocks, and the free cells of a block into regions that are connected within the block. So a
door of one cell stays a door, however large the blocks are. Small maps have blocks of one cell.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import List, Tuple

import numpy as np
from scipy import ndimage, sparse
from scipy.sparse import csgraph

from pursue_gen.survey.grid import Array, Grid, Point, touched

NODES = 60_000
"""The regions that a graph has about at most: 30 searches take some seconds then."""

_AROUND = ((0, 1), (1, 0), (1, 1), (1, -1), (1, 2), (2, 1), (1, -2), (2, -1))
"""Blocks (rows up, columns to the right) whose regions are joined where one sees the other; opposite ones follow."""

_DETOUR = 1.5
"""How much longer than the straight line a step between neighbours is taken to be that do not see each other."""


@dataclass(frozen=True)
class Graph:
    """Regions as nodes. `block`: cells along a block's side; `regions[row, column]`: the node of a cell, -1 for none.

    `points[node]` is a cell's centre (column, row) in the region; `steps`: a sparse matrix of lengths in cells.
    """

    grid: Grid
    block: int
    regions: Array
    points: Array
    steps: Array

    def node(self, point: Point) -> int:
        """The node of a free point."""
        return int(self.regions[math.floor(point[1]), math.floor(point[0])])

    def searched(self, nodes: List[int], most: float = math.inf) -> Tuple[Array, Array]:
        """For each of these nodes: the length from it to every node (inf: none, or more than `most`), and the node
        before that."""
        found: Tuple[Array, Array] = csgraph.dijkstra(self.steps, indices=nodes, return_predecessors=True, limit=most)
        return found


def graph_of(grid: Grid, nodes: int = NODES) -> Graph:
    """The graph of a grid that has free cells, with blocks so large that it has about so many nodes."""
    block = max(1, math.ceil(math.sqrt(np.count_nonzero(grid.free) / nodes)))
    regions, count = _regions(grid.free, block)
    points, main = _points(regions, count, block)
    touching = _touching(regions, block, count)
    pairs = _distinct(np.concatenate([touching, _around(main, count)]))
    a, b = pairs // count, pairs % count
    seen = _seen(grid.free, points[a], points[b])
    lengths = np.hypot(*(points[a] - points[b]).T) * np.where(seen, 1.0, _DETOUR)
    wanted = seen
    wanted[np.searchsorted(pairs, touching)] = True
    a, b, lengths = a[wanted], b[wanted], lengths[wanted]
    both = np.concatenate([a, b]), np.concatenate([b, a])
    steps = sparse.csr_matrix((np.concatenate([lengths, lengths]), both), shape=(count, count))
    rows, columns = grid.free.shape
    return Graph(grid, block, regions[:rows, :columns], points, steps)


def _regions(free: Array, block: int) -> Tuple[Array, int]:
    """The node of each cell (-1: none), for whole blocks, and the number of nodes."""
    rows, columns = (math.ceil(size / block) for size in free.shape)
    whole = np.zeros((rows * block, columns * block), dtype=np.bool_)
    whole[: free.shape[0], : free.shape[1]] = free
    apart = np.zeros((rows, block + 1, columns, block + 1), dtype=np.bool_)  # a wall between any two blocks
    apart[:, :block, :, :block] = whole.reshape(rows, block, columns, block)
    labels, count = ndimage.label(apart.reshape(rows * (block + 1), columns * (block + 1)))
    cells = labels.reshape(rows, block + 1, columns, block + 1)[:, :block, :, :block]
    return cells.reshape(whole.shape) - 1, int(count)


def _points(regions: Array, count: int, block: int) -> Tuple[Array, Array]:
    """The point of each node, nearest to the middle of its block, and for each block the node nearest to its middle."""
    cells = np.full((count, 2), -1, dtype=np.int64)
    rows, columns = (size // block for size in regions.shape)
    main = np.full(rows * columns, -1, dtype=np.int64)
    middle = (block - 1) / 2
    inside = [(row, column) for row in range(block)[::-1] for column in range(block)[::-1]]
    left = _counts(regions, count, block)  # how many regions of each block have no point yet
    open_ = np.flatnonzero(left)
    for row, column in sorted(inside, key=lambda one: math.hypot(one[0] - middle, one[1] - middle)):
        y, x = open_ // columns * block + row, open_ % columns * block + column
        here = regions[y, x]
        new = (here >= 0) & (cells[here, 0] < 0)
        cells[here[new]] = np.column_stack([x[new], y[new]])
        first = new & (main[open_] < 0)
        main[open_[first]] = here[first]
        left[open_[new]] -= 1
        open_ = open_[left[open_] > 0]
    return cells + 0.5, main.reshape(rows, columns)


def _counts(regions: Array, count: int, block: int) -> Array:
    """How many regions each block has, row by row."""
    rows, columns = (size // block for size in regions.shape)
    blocks = np.arange(rows * columns).reshape(rows, columns).repeat(block, axis=0).repeat(block, axis=1)
    of = np.zeros(count + 1, dtype=np.int64)
    of[regions] = blocks  # the last one is that of no region
    return np.bincount(of[:count], minlength=rows * columns)


def _touching(regions: Array, block: int, count: int) -> Array:
    """The pairs of nodes of two blocks that have cells side by side, as a * count + b with a < b."""
    found = []
    for turned in (regions, regions.T):
        a, b = turned[block - 1 : -1 : block], turned[block::block]
        found.append(_pairs(a, b, count))
    return _distinct(np.concatenate(found))


def _distinct(numbers: Array) -> Array:
    """The numbers in order, each once."""
    ordered = np.sort(numbers)
    return ordered[np.flatnonzero(np.diff(ordered, prepend=-1))]


def _around(main: Array, count: int) -> Array:
    """The pairs of main nodes of blocks near each other."""
    found = []
    for up, right in _AROUND:
        lower, upper = main[: main.shape[0] - up], main[up:]
        if right < 0:
            lower, upper = lower[:, -right:], upper[:, :right]
        elif right:
            lower, upper = lower[:, :-right], upper[:, right:]
        found.append(_pairs(lower, upper, count))
    return np.concatenate(found)


def _pairs(a: Array, b: Array, count: int) -> Array:
    both = (a >= 0) & (b >= 0)
    first, second = a[both].astype(np.int64), b[both].astype(np.int64)
    return np.minimum(first, second) * count + np.maximum(first, second)


def _seen(free: Array, a: Array, b: Array) -> Array:
    """For each pair of points whether one sees the other; as `Grid.sees`, for many short lines at once."""
    steep = np.abs(b - a)[:, 1] > np.abs(b - a)[:, 0]
    found = np.zeros(len(a), dtype=np.bool_)
    for turned, where in ((free, np.flatnonzero(~steep)), (free.T, np.flatnonzero(steep))):
        ends = [one[where, ::-1] if turned is not free else one[where] for one in (a, b)]
        forward = (ends[0][:, 0] <= ends[1][:, 0])[:, None]
        found[where] = _seen_along(turned, np.where(forward, *ends), np.where(forward, *ends[::-1]))
    return found


def _seen_along(free: Array, a: Array, b: Array) -> Array:
    (u, v), (to_u, to_v) = a.T, b.T
    slope = np.divide(to_v - v, to_u - u, out=np.zeros_like(u), where=to_u > u)
    first, last = np.floor(u).astype(np.int64), np.floor(to_u).astype(np.int64)
    found = np.zeros(len(u), dtype=np.bool_)
    open_ = np.arange(len(u))  # the lines that are free so far, and go on
    while len(open_):
        column = first
        enter = v + slope * (np.maximum(column, u) - u)
        leave = v + slope * (np.minimum(column + 1, to_u) - u)
        is_free = np.all([free[rows, column] for rows in touched(enter, leave)], axis=0)
        found[open_[is_free & (column == last)]] = True
        goes_on = is_free & (column < last)
        first = column + 1
        open_, first, last, u, v, to_u, slope = (one[goes_on] for one in (open_, first, last, u, v, to_u, slope))
    return found
