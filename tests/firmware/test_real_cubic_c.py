"""What single precision is off by in a joint's motion, against exact fractions."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.firmware import c_library
from tests.firmware.two_judges import POSITION_ERROR, RELATIVE_ERROR, TICK_HZ

MS = TICK_HZ // 1000
I32 = st.integers(-(1 << 31), (1 << 31) - 1)


def exact_position(k: tuple[int, int, int, int], ticks: int, u: Fraction) -> Fraction:
    """Microsteps from the start, after the part u of the time."""
    d = Fraction(k[1] - k[0], 1024)
    m0, m1 = (Fraction(v * 1000 * ticks, 65536 * TICK_HZ) for v in k[2:])
    return d * u * u * (3 - 2 * u) + u * (1 - u) * ((1 - u) * m0 - u * m1)


@settings(deadline=None, max_examples=500)
@given(
    p0=I32,
    v=st.tuples(st.integers(-100 << 16, 100 << 16), st.integers(-100 << 16, 100 << 16)),
    bend=st.integers(-(1 << 12), 1 << 12),
    ticks=st.integers(800, 10_000),
    u=st.floats(0, 1, width=32),
)
def test_a_cubic_in_single_precision(p0, v, bend, ticks, u):
    """At up to the fastest that a board steps: 100 microsteps per ms."""
    p1 = p0 + (v[0] + v[1]) * ticks * 1024 // (2 * MS << 16) + bend
    if not -(1 << 31) <= p1 < 1 << 31:
        return
    knots = (p0, p1, *v)
    cubic = c_library.joint_cubic(*knots, ticks=ticks, tick_hz=TICK_HZ)
    h = Fraction(ticks, TICK_HZ)
    d, v0, v1 = Fraction(p1 - p0, 1024), *(Fraction(x * 1000, 65536) for x in v)
    for ours, exact in (
        (cubic.a0, 6 * d / h**2 - (4 * v0 + 2 * v1) / h),
        (cubic.a1, (2 * v0 + 4 * v1) / h - 6 * d / h**2),
    ):
        assert abs(Fraction(ours) - exact) <= Fraction(RELATIVE_ERROR / 4) * abs(exact)
    off = abs(Fraction(c_library.position(cubic, u)) - exact_position(knots, ticks, Fraction(u)))
    assert off < POSITION_ERROR / 4, f"a position is off by {float(off):.4f} microsteps"


def test_top_speed_between_the_knots():
    knots = (0, round(79.8 * 1024), 258_867, 258_867)
    u = np.linspace(0, 1, 101)
    positions = [float(exact_position(knots, 4000, Fraction(part))) for part in u]
    top = np.gradient(positions, u * 0.020).max()
    cubic = c_library.joint_cubic(*knots, ticks=4000, tick_hz=TICK_HZ)
    assert c_library.top_speed(cubic) == pytest.approx(top, rel=1e-3)
    assert top > 1.005 * cubic.v0
