"""Where lines cross the boundary of a workspace."""

from __future__ import annotations

import numpy as np

from deltaviz.mechanism.arrays import Array
from deltaviz.robots.workspace.margins import Margins

CLOSE = 1e-6  # mm, of margin: near enough to the boundary
MOST_STEPS = 40


def crossing(margins: Margins, inside: Array, outside: Array) -> Array:
    """A boundary point between each inner point and its outer one, (n, d), to a nanometre or so.

    False position with the Illinois rule: the margin is continuous, but has kinks.
    """
    near, far = np.zeros(len(inside)), np.ones(len(inside))
    way = outside - inside
    low, high = margins.least(inside), margins.least(outside)
    share = near.copy()
    stuck = np.zeros(len(inside), dtype=np.int8)  # the side that was kept last time
    active = np.flatnonzero((low > CLOSE) & (high < 0))
    for _ in range(MOST_STEPS):
        if not len(active):
            break
        a, b, fa, fb = near[active], far[active], low[active], high[active]
        middle = (a * fb - b * fa) / (fb - fa)
        value = margins.least(inside[active] + middle[:, None] * way[active])
        share[active] = middle
        inner = value >= 0
        near[active] = np.where(inner, middle, a)
        far[active] = np.where(inner, b, middle)
        side = np.where(inner, 1, -1).astype(np.int8)
        again = side == stuck[active]
        low[active] = np.where(inner, value, np.where(again, fa / 2, fa))
        high[active] = np.where(inner, np.where(again, fb / 2, fb), value)
        stuck[active] = side
        active = active[np.abs(value) > CLOSE]
    return inside + share[:, None] * way
