"""What holds a motion back, and what leads out: the sentence the operator reads."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Held:
    """One limit that holds the motion back now.

    `limit` names it for a person ("Arm 2 at its upper limit (90.0°)"), `arm` is its joint
    (0-based) or None, `way_out` the directions that lead away from it, as signed names: of the
    base's axes ("-X", "+Z"), or of the tool's turn ("-Tool").
    """

    limit: str
    arm: int | None = None
    way_out: tuple[str, ...] = ()
