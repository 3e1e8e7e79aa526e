"""Solve W k = r with a sparse W of symbols, the elimination unrolled into plain arithmetic.

Pivots are taken on the diagonal, in Markowitz's order (the least fill first), chosen once from the
structure: in this project's W = M/(hγ) − J every diagonal entry is there, and the numbers decide
nothing, so the same arithmetic runs on every platform.
"""

from __future__ import annotations

from dataclasses import dataclass

import casadi as cs


@dataclass(frozen=True)
class Factors:
    """W = L U in elimination order: `lower[i, k]` are multipliers, `upper[k, j]` the rows of U."""

    order: tuple[int, ...]
    lower: dict[tuple[int, int], cs.SX]
    upper: dict[tuple[int, int], cs.SX]
    inverse: dict[int, cs.SX]  # 1 / pivot

    def solve(self, right: cs.SX) -> cs.SX:
        """k with W k = right, for right sides of shape (n, m)."""
        k = cs.vertsplit(right)
        for place, pivot in enumerate(self.order):
            for i in self.order[place + 1 :]:
                if (i, pivot) in self.lower:
                    k[i] = k[i] - self.lower[i, pivot] * k[pivot]
        for place in range(len(self.order) - 1, -1, -1):
            pivot = self.order[place]
            for j in self.order[place + 1 :]:
                if (pivot, j) in self.upper:
                    k[pivot] = k[pivot] - self.upper[pivot, j] * k[j]
            k[pivot] = k[pivot] * self.inverse[pivot]
        return cs.vertcat(*k)


def factorise(W: cs.SX) -> Factors:
    """LU factors of a square W of shape (n, n); its structural zeros are never touched."""
    n = W.shape[0]
    entries = {(i, j): W[i, j] for i in range(n) for j in range(n) if not W[i, j].is_zero()}
    remaining, order = set(range(n)), []
    lower: dict[tuple[int, int], cs.SX] = {}
    upper: dict[tuple[int, int], cs.SX] = {}
    inverse: dict[int, cs.SX] = {}
    while remaining:
        pivot = min(remaining, key=lambda k: (_fill(entries, remaining, k), k))
        remaining.remove(pivot)
        order.append(pivot)
        inverse[pivot] = 1 / entries[pivot, pivot]
        rows = sorted(i for i in remaining if (i, pivot) in entries)
        columns = sorted(j for j in remaining if (pivot, j) in entries)
        for j in columns:
            upper[pivot, j] = entries[pivot, j]
        for i in rows:
            lower[i, pivot] = entries[i, pivot] * inverse[pivot]
            for j in columns:
                entries[i, j] = entries.get((i, j), cs.SX(0)) - lower[i, pivot] * entries[pivot, j]
    return Factors(tuple(order), lower, upper, inverse)


def _fill(entries: dict[tuple[int, int], cs.SX], remaining: set[int], k: int) -> int:
    """Markowitz's count for pivot k: how many entries its elimination may touch."""
    rows = sum((i, k) in entries for i in remaining if i != k)
    columns = sum((k, j) in entries for j in remaining if j != k)
    return rows * columns
