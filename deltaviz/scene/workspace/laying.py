"""What there is to compute of a thing that lies in the scene.

Runs in the computing processes.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from deltaviz.robots import Robot
from deltaviz.robots.workspace import Belt, Limit, Margins
from deltaviz.robots.workspace.cells import Box, hull
from deltaviz.robots.workspace.empty import why_empty
from deltaviz.robots.workspace.sheets import Chart, Sheet, best_level, farthest, spare
from deltaviz.robots.workspace.stretch import Stretch, stretch
from deltaviz.scene.units import metres
from deltaviz.scene.workspace.objects import BELT, Thing
from deltaviz.scene.workspace.pictures import Laid, Section, Served

REACHED = (64, 170, 120)
UNREACHED = (206, 92, 52)
STRIPE = (255, 226, 196)
_STRIPES = 16  # across a sheet's longest side
_STRIPE_SHARE = 0.4


@dataclass(frozen=True)
class Lay:
    """A thing at a height (mm), or with None where it fits best."""

    robot: Robot
    thing: Thing
    level: float | None

    def pictures(self) -> Iterator[Laid]:
        margins = Margins.of(self.robot, Limit.MACHINE)
        box = hull(margins)
        if box is None:
            yield self._unreached(margins)
            return
        level = self.level
        if level is None:
            level = float(round(best_level(margins, box, lambda z: self.thing.sheet(z, box))))
        sheet = self.thing.sheet(level, box)
        chart = Chart.of(margins, sheet)
        text = f"{self.thing} at Z {level:g} mm: {self._verdict(margins, sheet, chart)}"
        span = (float(box.low[2]), float(box.high[2]))
        yield _drawn(chart, span, text)

    def _verdict(self, margins: Margins, sheet: Sheet, chart: Chart) -> str:
        axis = self.thing.kind.belt_axis
        if not chart.reached.any():
            return "nothing of it is within reach."
        if axis is not None:
            return _served_about(chart, axis)
        left = spare(margins, sheet)
        if left >= 0:
            return f"fits, with at least {math.floor(left)} mm to spare on all sides."
        miss = farthest(margins, chart)
        if miss is None:
            return f"does not fit: {-left:.1f} mm of its edge are out of reach."
        x, y, _ = miss.point.tolist()
        return (
            f"does not fit, {_percent(chart.share)} within reach. The farthest point is "
            f"{miss.out:.0f} mm out, at X {x:.0f}, Y {y:.0f} mm: {miss.limit}."
        )

    def _unreached(self, margins: Margins) -> Laid:
        heights = self.robot.zone.z
        level = self.level if self.level is not None else float(round(sum(heights) / 2))
        nowhere = Box(np.zeros(3), np.zeros(3))
        chart = Chart.of(margins, self.thing.sheet(level, nowhere))
        reason = why_empty(self.robot, Limit.MACHINE) or ""
        return _drawn(chart, heights, f"{self.thing}: nothing of it is within reach. {reason}")


@dataclass(frozen=True)
class Serve:
    """Which stretch of a belt at a height (mm) is served."""

    robot: Robot
    thing: Thing
    level: float

    def pictures(self) -> Iterator[Served]:
        axis = self.thing.kind.belt_axis
        margins = Margins.of(self.robot, Limit.MACHINE)
        box = hull(margins)
        if axis is None or box is None:
            return
        found = stretch(margins, box, Belt(BELT, 0.0, self.level, axis))
        yield Served(f"{self.thing} at Z {self.level:g} mm: {_served(found)}")


def _served(found: Stretch) -> str:
    along = "XY"[found.belt.axis]
    before, after = ("no limit" if limit is None else str(limit) for limit in found.limits)
    if found.start is not None and found.end is not None:
        return (
            f"served over its whole width for {found.length:.0f} mm, "
            f"{along} {found.start:.0f} to {found.end:.0f} mm; it ends at: {before}, {after}."
        )
    if found.widest_at is None:
        return "not served over its whole width; nothing of its middle is within reach."
    return (
        f"not served over its whole width; {math.floor(found.widest)} mm of it are, at {along} "
        f"{found.widest_at:.0f} mm; beyond, to either side: {before}, {after}."
    )


def _served_about(chart: Chart, axis: int) -> str:
    """From the drawn points, before it is proved."""
    whole = chart.reached.all(axis=0 if axis == 0 else 1)
    places = (chart.x, chart.y)[axis]
    if whole.any():
        length = float(np.ptp(places[whole]))
        return f"served over its whole width for about {length:.0f} mm."
    return "not served over its whole width."


def _percent(share: float) -> str:
    """Never rounded to all or nothing."""
    return f"{min(max(100 * share, 1), 99):.0f}\u00a0%"


def _drawn(chart: Chart, span: tuple[float, float], text: str) -> Laid:
    half = np.array((*chart.steps, 0.0)) / 2  # a pixel is as wide as the way between two points
    section = Section(
        axis=2,
        level=chart.level,
        image=_painted(chart),
        low=metres(chart.place(0, 0) - half),
        high=metres(chart.place(-1, -1) + half),
        span=span,
        scale=None,
    )
    return Laid(section, text)


def _painted(chart: Chart) -> NDArray[np.uint8]:
    """RGBA: what is out of reach is hatched, so that no eye needs to tell two hues apart."""
    period = max(float(np.ptp(chart.x)), float(np.ptp(chart.y))) / _STRIPES
    along = (chart.x[None, :] + chart.y[:, None]) / period % 1.0
    hatched = np.where((along < _STRIPE_SHARE)[..., None], STRIPE, UNREACHED)
    down, right = np.gradient(chart.margin)  # of a pixel
    slope = np.maximum(np.hypot(down, right), 1e-9)
    share = np.clip(0.5 + chart.margin / slope, 0.0, 1.0)[..., None]
    image = np.empty((*chart.margin.shape, 4), np.uint8)
    image[..., :3] = share * np.array(REACHED) + (1 - share) * hatched
    image[..., 3] = np.where(chart.on, 255, 0)
    return image
