"""A rotary delta's inverse and forward for very many poses at once, some nanoseconds each."""

from __future__ import annotations

import numpy as np

from deltaviz.mechanism import rotary_delta_batch_compiled as compiled
from deltaviz.mechanism.arrays import Array
from deltaviz.mechanism.rotary_delta import RotaryDelta
from deltaviz.mechanism.rotary_delta_numbers import geometry
from deltaviz.mechanism.threads import in_threads

Three = tuple[Array, Array, Array]


class RotaryDeltaBatch:
    """The mechanism's `inverse` and `forward`, compiled.

    Fastest with each coordinate in an array of its own. Arrays are float64, C-contiguous and of
    one length, which is the caller's duty. The first call in a process compiles, or takes from
    the cache what an earlier one compiled.
    """

    def __init__(self, mechanism: RotaryDelta) -> None:
        self._g = geometry(mechanism, (0.0, 0.0, 0.0))

    def inverse(
        self, x: Array, y: Array, z: Array, *, out: Three | None = None, threads: int = 1
    ) -> Three:
        """(N,) each: mm to the three arms' angles in rad, all NaN where one is out of reach."""
        a, b, c = out or (np.empty_like(x), np.empty_like(x), np.empty_like(x))

        def run(part: slice) -> None:
            compiled.inverse_arrays(x[part], y[part], z[part], a[part], b[part], c[part], self._g)

        in_threads(run, len(x), threads)
        return a, b, c

    def forward(
        self, a: Array, b: Array, c: Array, *, out: Three | None = None, threads: int = 1
    ) -> Three:
        """(N,) each: the arms' angles in rad to x, y, z in mm, all NaN where nothing meets."""
        x, y, z = out or (np.empty_like(a), np.empty_like(a), np.empty_like(a))

        def run(part: slice) -> None:
            compiled.forward_arrays(a[part], b[part], c[part], x[part], y[part], z[part], self._g)

        in_threads(run, len(a), threads)
        return x, y, z

    def inverse_rows(self, xyz: Array, *, threads: int = 1) -> Array:
        """(..., 3) mm to (..., 3) rad."""
        points, theta = np.ascontiguousarray(xyz).reshape(-1, 3), np.empty(xyz.shape)
        angles = theta.reshape(-1, 3)

        def run(part: slice) -> None:
            compiled.inverse_rows(points[part].reshape(-1), angles[part].reshape(-1), self._g)

        in_threads(run, len(points), threads)
        return theta

    def forward_rows(self, theta: Array, *, threads: int = 1) -> Array:
        """(..., 3) rad to (..., 3) mm."""
        angles, xyz = np.ascontiguousarray(theta).reshape(-1, 3), np.empty(theta.shape)
        points = xyz.reshape(-1, 3)

        def run(part: slice) -> None:
            compiled.forward_rows(angles[part].reshape(-1), points[part].reshape(-1), self._g)

        in_threads(run, len(angles), threads)
        return xyz
