"""What a person asks of a workspace first, as one value: for the terminal, and as JSON."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from typing import Any

import numpy as np

from deltaviz.mechanism.arrays import Array
from deltaviz.robots.robot import Robot
from deltaviz.robots.torques import Torques, crossing, holding
from deltaviz.robots.workspace.cells import Box
from deltaviz.robots.workspace.extent import ReachAtHeight
from deltaviz.robots.workspace.limits import Limit
from deltaviz.robots.workspace.parts import Nearest, nearest_parts
from deltaviz.robots.workspace.quality import WORSE_ABOVE, Quality
from deltaviz.robots.workspace.workspace import Inscribed, Workspace

ZONE_POINTS = 100_000
WAY = 0.8  # of the zone's half width, that the motion for torques crosses


@dataclass(frozen=True)
class Spread:
    """Of one measure of `Quality` over the workspace; `where` (d,) mm it is worst."""

    worst: float
    median: float
    best: float
    where: Array


@dataclass(frozen=True)
class Report:
    """What `deltaviz workspace` tells. Where a robot's file does not tell masses or thicknesses,
    what needs them is None. `not_crossed` tells why its zone is not crossed, with masses."""

    workspace: Workspace
    extents: Box
    reach: list[ReachAtHeight]
    cylinder: Inscribed | None
    box: Inscribed | None
    quality: dict[str, Spread]
    zone_reached: float
    parts: Nearest | None
    payload: float
    holding: Array | None
    crossing: Torques | None
    not_crossed: str | None


def report(
    workspace: Workspace,
    *,
    floor: float | None = None,
    anywhere: bool = False,
    payload: float = 0.0,
) -> Report:
    """With `floor` (z, mm) what fits stands there, and the table tells of that height alone.
    Centred, or with `anywhere` about any vertical line. Raises Empty."""
    robot = workspace.robot
    planar = workspace.margins.dimensions == 2
    centre = None if anywhere else (0.0,) * (workspace.margins.dimensions - 1)
    points = workspace.inside()
    with ThreadPoolExecutor(workspace.threads) as pool:  # its compiled loops let others run
        box = pool.submit(workspace.largest_box, floor=floor, centre=centre)
        extents = pool.submit(lambda: workspace.extents)
        cylinder = pool.submit(
            lambda: None if planar else workspace.largest_cylinder(floor=floor, centre=centre)
        )
        parts = pool.submit(nearest_parts, robot)
    crossed, not_crossed = _crossing(robot, payload)
    return Report(
        workspace=workspace,
        extents=extents.result(),
        reach=workspace.reach(None if floor is None else [floor]),
        cylinder=cylinder.result(),
        box=box.result(),
        quality=_spreads(workspace.quality(points), points),
        zone_reached=zone_reached(workspace),
        parts=parts.result(),
        payload=payload,
        holding=_holding(robot, points, payload),
        crossing=crossed,
        not_crossed=not_crossed,
    )


def zone_reached(workspace: Workspace) -> float:
    """Share of the zone that the robot file allows, by counting on a grid."""
    zone = workspace.robot.zone
    round_ = (-(zone.radius or 0.0), zone.radius or 0.0)
    ranges = {"X": zone.x or round_, "Y": zone.y or round_, "Z": zone.z}
    axes = [ranges[axis] for axis in workspace.robot.axes]
    each = max(2, round(ZONE_POINTS ** (1 / len(axes))))
    lines = [np.linspace(low, high, each) for low, high in axes]
    points = np.stack(np.meshgrid(*lines, indexing="ij"), axis=-1).reshape(-1, len(axes))
    if zone.radius is not None:
        points = points[np.linalg.norm(points[:, :-1], axis=-1) <= zone.radius]
    return float((workspace.margins.least(points) >= 0).mean())


def as_json(found: Report) -> dict[str, Any]:
    """Plain numbers, each with its unit in its name."""
    workspace = found.workspace
    planar = workspace.margins.dimensions == 2
    axes = [axis.lower() for axis in workspace.robot.axes]
    low, high = found.extents.low.tolist(), found.extents.high.tolist()
    return {
        "robot": workspace.robot.name,
        **limits_json(workspace),
        "empty": False,
        ("area_mm2" if planar else "volume_mm3"): workspace.volume,
        "extents_mm": {a: [lo, hi] for a, lo, hi in zip(axes, low, high, strict=True)},
        "boundary": {
            "deviation_mm": workspace.boundary.deviation,
            "cell_mm": workspace.boundary.cell,
        },
        "reach": [
            {
                "z_mm": row.z,
                "farthest_mm": row.farthest,
                "all_around_mm": row.all_around,
                "nearest_mm": row.nearest,
            }
            for row in found.reach
        ],
        "largest_cylinder": inscribed_json(found.cylinder),
        "largest_box": inscribed_json(found.box),
        "quality": {
            name: {
                "worst": s.worst,
                "median": s.median,
                "best": s.best,
                "where_mm": s.where.tolist(),
            }
            for name, s in found.quality.items()
        },
        "zone": {
            "reached": found.zone_reached,
            "least_gap_of_parts_mm": None if found.parts is None else found.parts.gap,
        },
        "torque": _torque_json(found),
    }


def inscribed_json(found: Inscribed | None) -> dict[str, Any] | None:
    return None if found is None else {**shape_json(found.shape), "none_above": found.most}


def shape_json(shape: Any) -> dict[str, Any]:
    """The fields of a shape, lengths in mm."""
    names = {"diameter", "size", "height", "floor", "centre", "width"}
    return {f"{n}_mm": getattr(shape, n) for n in sorted(names) if hasattr(shape, n)}


def limits_json(workspace: Workspace) -> dict[str, Any]:
    """What was considered, and why what else was asked for was not."""
    left_out = {limit_name(limit): why for limit, why in workspace.not_considered.items()}
    return {"limits": limit_names(workspace.considered), "not_considered": left_out}


def limit_names(limits: Limit) -> list[str]:
    return [limit_name(limit) for limit in limits]


def limit_name(limit: Limit) -> str:
    return (limit.name or "").lower().replace("_", "-")


def _spreads(quality: Quality, points: Array) -> dict[str, Spread]:
    out: dict[str, Spread] = {}
    planar = points.shape[-1] == 2
    for name in quality.measures():
        if planar and name == "ball_joint_deg":
            continue  # it has none
        values = np.asarray(getattr(quality, name))
        order = np.argsort(values)
        order = order[: np.isfinite(values).sum()]  # NaN stands last
        if not len(order):
            continue
        if name in WORSE_ABOVE:
            order = order[::-1]
        worst, middle, best = order[0], order[len(order) // 2], order[-1]
        out[name] = Spread(
            float(values[worst]), float(values[middle]), float(values[best]), points[worst]
        )
    return out


def _holding(robot: Robot, points: Array, payload: float) -> Array | None:
    """The largest of each arm."""
    if robot.masses is None:
        return None
    tau = np.abs(holding(robot, points, payload=payload))
    return np.nanmax(tau, axis=0)


def zone_way(robot: Robot) -> tuple[Array, Array]:
    """From where to where the motion for the torques goes: straight through the middle of the zone
    along x; mm."""
    zone = robot.zone
    half = WAY * (zone.radius if zone.radius is not None else min(map(abs, zone.x or (0.0, 0.0))))
    end = np.zeros(len(robot.tool_offset))
    end[0], end[-1] = half, sum(zone.z) / 2
    start = end.copy()
    start[0] = -half
    return start, end


def _crossing(robot: Robot, payload: float) -> tuple[Torques | None, str | None]:
    """Through the zone, or why not."""
    if robot.masses is None:
        return None, None
    start, end = zone_way(robot)
    try:
        return crossing(robot, start, end, payload=payload), None
    except ValueError as error:
        return None, str(error)


def _torque_json(found: Report) -> dict[str, Any] | None:
    if found.holding is None:
        return None
    moved = found.crossing
    return {
        "payload_kg": found.payload,
        "holding_nm": found.holding.tolist(),
        "crossing": None
        if moved is None
        else {
            "duration_s": moved.duration,
            "peak_nm": moved.peak.tolist(),
            "rms_nm": moved.rms.tolist(),
            "fastest_deg_s": np.degrees(moved.fastest).tolist(),
        },
        "not_crossed": found.not_crossed,
    }
