"""The snapshot as the pages and programs see it."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import asdict
from typing import Any

from deltaviz.machine.snapshot import LinkStatus, Snapshot
from deltaviz.robots import Robot
from deltaviz.robots.coordinates import SPACE, in_space

_DIGITS = 4  # of a mm or a degree: finer than any board's step


def state_json(snapshot: Snapshot, *, robot: Robot, client: str, now: float) -> dict[str, Any]:
    """The state for one client. `now` is the monotonic time (s), for the age of the telemetry.

    Angles in degrees, lengths in mm; null where unknown, never NaN, never -0.
    """
    return {
        "mode": str(snapshot.mode),
        "homed": snapshot.homed,
        "robot": snapshot.robot,
        "xyz_mm": _point(snapshot.xyz),
        "theta_deg": _angles(snapshot.theta),
        "command_xyz_mm": _point(snapshot.command_xyz),
        "command_theta_deg": _angles(snapshot.command_theta),
        "target_xyz_mm": _point(snapshot.target_xyz),
        "target_theta_deg": _angles(snapshot.target_theta),
        "xyz_speed_share": _point_shares(snapshot.xyz_speed, robot.limits.cartesian.velocity),
        "theta_speed_share": _shares(snapshot.theta_speed, robot.limits.joint.velocity),
        "margins": [_number(margin) for margin in snapshot.margins],
        "held_by": [
            {"limit": held.limit, "arm": held.arm, "way_out": list(held.way_out)}
            for held in snapshot.held_by
        ],
        "link": _link(snapshot.link, waited=max(0.0, now - snapshot.at)),
        "control": _control(snapshot.holder, client),
        "stop_reason": snapshot.stop_reason,
        "fault": snapshot.fault,
        "override": _number(snapshot.override),
        "next_step": snapshot.next_step,
        "board_time_s": None if snapshot.board_time is None else _number(snapshot.board_time),
        "underruns": snapshot.underruns,
        "capture": None if snapshot.capture is None else asdict(snapshot.capture),
    }


def _link(link: LinkStatus, *, waited: float) -> dict[str, Any]:
    age = None if link.age is None else link.age + waited
    return {
        "id": link.id,
        "connected": link.connected,
        "phase": str(link.phase),
        "age_ms": _milliseconds(age),
        "problem": link.problem,
        "note": link.note,
        "board": link.board,
        "round_trip_ms": _milliseconds(link.round_trip),
        "dropped": link.dropped,
        "queued": link.queued,
        "queue_places": link.queue_places,
        "ahead_ms": _milliseconds(link.ahead),
    }


def _milliseconds(seconds: float | None) -> float | None:
    return None if seconds is None else _number(seconds * 1000, digits=1)


def _control(holder: str | None, client: str) -> dict[str, Any]:
    you = holder == client
    return {"holder": "you" if you else None if holder is None else "another", "you": you}


def _point(xyz: Sequence[float] | None) -> list[float | None] | None:
    return None if xyz is None else [_number(value) for value in in_space(xyz)]


def _angles(theta: Sequence[float] | None) -> list[float | None] | None:
    return None if theta is None else [_number(math.degrees(angle)) for angle in theta]


def _point_shares(speed: Sequence[float] | None, limit: float) -> list[float | None] | None:
    return None if speed is None else _shares(in_space(speed), [limit] * len(SPACE))


def _shares(speed: Sequence[float] | None, limits: Sequence[float]) -> list[float | None] | None:
    if speed is None:
        return None
    # A robot just chosen may have another number of joints than this older snapshot.
    return [_number(min(1.0, abs(v) / limit)) for v, limit in zip(speed, limits, strict=False)]


def _number(value: float, *, digits: int = _DIGITS) -> float | None:
    return round(value, digits) + 0.0 if math.isfinite(value) else None
