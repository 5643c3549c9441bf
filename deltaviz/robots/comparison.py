"""Two robots, measured alike and put side by side."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

from deltaviz.robots.workspace.report import Report, report
from deltaviz.robots.workspace.shapes import Cuboid, Cylinder
from deltaviz.robots.workspace.workspace import TOLERANCES

if TYPE_CHECKING:
    from deltaviz.robots.robot import Robot


@dataclass(frozen=True, slots=True)
class Row:
    """One measure of both; None where a robot has none. Empty: `ratio` means nothing."""

    what: str
    key: str
    unit: str
    values: tuple[float | None, float | None]

    @property
    def ratio(self) -> float | None:
        """The second over the first."""
        one, other = self.values
        return None if one is None or other is None or one == 0 else other / one


@dataclass(frozen=True, slots=True)
class Comparison:
    reports: tuple[Report, Report]
    rows: tuple[Row, ...]

    @property
    def names(self) -> tuple[str, str]:
        one, other = (found.workspace.robot.name for found in self.reports)
        return one, other


def measure(robot: Robot, *, tolerance: float | None = None, payload: float = 0.0) -> Report:
    """`tolerance` mm of the boundary; without it a fraction of the robot's size. `payload` in kg,
    for the torques. Raises Empty."""
    own = max(robot.mechanism.forearm) / TOLERANCES
    return report(robot.workspace(tolerance=tolerance or own), payload=payload)


def compare(one: Report, other: Report) -> Comparison:
    first, second = dict(_measures(one)), dict(_measures(other))
    keys = [*first, *(key for key in second if key not in first)]
    rows = [
        Row(*_LABELS[key], values=(first.get(key), second.get(key)))
        for key in sorted(keys, key=list(_LABELS).index)
    ]
    return Comparison((one, other), tuple(rows))


# Each key's label, name in JSON, and unit, in the order of the table.
_LABELS = {
    key: (what, key, unit)
    for key, what, unit in (
        ("volume_l", "volume", "l"),
        ("area_cm2", "area", "cm²"),
        ("x_mm", "extent in x", "mm"),
        ("y_mm", "extent in y", "mm"),
        ("z_mm", "extent in z", "mm"),
        ("farthest_mm", "farthest from the axis", "mm"),
        ("all_around_mm", "reach all around, at best", "mm"),
        ("cylinder_diameter_mm", "largest cylinder: diameter", "mm"),
        ("cylinder_height_mm", "largest cylinder: height", "mm"),
        ("box_width_mm", "largest box: width", "mm"),
        ("box_height_mm", "largest box: height", "mm"),
        ("resolution_worst_mm", "resolution, worst", "mm"),
        ("resolution_median_mm", "resolution, median", "mm"),
        ("condition_worst", "conditioning, worst", ""),
        ("condition_median", "conditioning, median", ""),
        ("type_2_worst", "hold of the forearms, worst", ""),
        ("stiffness_median", "stiffness per joint's, median", "N/mm per N m/rad"),
        ("ball_joint_worst_deg", "ball joints tilt up to", "°"),
        ("holding_nm", "torque to hold anywhere", "N m"),
        ("crossing_s", "crossing the zone takes", "s"),
        ("peak_nm", "torque for it, peak", "N m"),
        ("rms_nm", "torque for it, rms", "N m"),
    )
}


def _measures(found: Report) -> Iterator[tuple[str, float]]:
    workspace = found.workspace
    planar = workspace.margins.dimensions == 2
    yield ("area_cm2", workspace.volume / 100) if planar else ("volume_l", workspace.volume / 1e6)
    for axis, side in zip(workspace.robot.axes, found.extents.size.tolist(), strict=True):
        yield f"{axis.lower()}_mm", side
    yield "farthest_mm", max((row.farthest or 0.0 for row in found.reach), default=0.0)
    yield "all_around_mm", max((row.all_around for row in found.reach), default=0.0)
    for inscribed in filter(None, (found.cylinder, found.box)):
        match inscribed.shape:
            case Cylinder(diameter=diameter, height=height):
                yield "cylinder_diameter_mm", diameter
                yield "cylinder_height_mm", height
            case Cuboid(size=size, height=height):
                yield "box_width_mm", size[0]
                yield "box_height_mm", height
    yield from _qualities(found)
    if found.holding is not None:
        yield "holding_nm", float(found.holding.max())
    if found.crossing is not None:
        yield "crossing_s", found.crossing.duration
        yield "peak_nm", float(found.crossing.peak.max())
        yield "rms_nm", float(found.crossing.rms.max())


def _qualities(found: Report) -> Iterator[tuple[str, float]]:
    quality = found.quality
    yield "resolution_worst_mm", quality["resolution"].worst
    yield "resolution_median_mm", quality["resolution"].median
    yield "condition_worst", quality["condition"].worst
    yield "condition_median", quality["condition"].median
    yield "type_2_worst", quality["type_2"].worst
    yield "stiffness_median", quality["stiffness"].median
    if found.workspace.margins.dimensions == 3:
        yield "ball_joint_worst_deg", quality["ball_joint_deg"].worst
