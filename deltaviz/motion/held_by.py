"""Which limits hold a motion back where the robot is, in words, and what leads out."""

from __future__ import annotations

import math

import numpy as np

from deltaviz.mechanism.margin import Margin, MarginKind
from deltaviz.motion.followed import Array, Followed
from deltaviz.motion.held import Held

NEAR = 1.0  # units of margin, about mm: a limit this close can hold a motion back
PROBE = 1e-3  # mm
TURN = "Tool"  # the direction that is a turn of the tool
CLEAR = 0.05  # a direction leads out if each margin grows at least by this per mm


class HeldBy:
    """Answers for one robot."""

    def __init__(self, robot: Followed) -> None:
        self._robot = robot
        self._names = robot.margin_names
        self._axes = (*robot.axes, TURN)[: robot.joint_count]

    def __call__(self, pose: Array, wanted: Array) -> tuple[Held, ...]:
        """The limits near a pose (n,) that are against going along `wanted` (n,)."""
        kernel = self._robot.kernel
        axes = len(pose)
        probes = np.concatenate((np.zeros((1, axes)), np.eye(axes), -np.eye(axes))) * PROBE
        places = np.ascontiguousarray(pose + probes)
        margins = kernel.margins(places, kernel.inverse(places))
        slopes = (margins[1 : axes + 1] - margins[axes + 1 :]) / (2 * PROBE)
        near = np.flatnonzero(margins[0] < NEAR)
        against = [c for c in near.tolist() if float(wanted @ slopes[:, c]) <= 0.0]
        out = self._ways_out(slopes[:, near])
        against.sort(key=lambda c: float(margins[0, c]))
        return tuple(Held(self.words(self._names[c]), self._names[c].arm, out) for c in against)

    def _ways_out(self, slopes: Array) -> tuple[str, ...]:
        """Signed axes along which all near margins grow; else none gets worse; else most grow."""
        if slopes.shape[1] == 0:
            return ()
        signed = [(sign, axis) for axis in range(slopes.shape[0]) for sign in (1, -1)]
        worst = {pair: float((pair[0] * slopes[pair[1]]).min()) for pair in signed}
        out = [pair for pair in signed if worst[pair] > CLEAR]
        return tuple(f"{'+' if sign > 0 else '-'}{self._axes[axis]}" for sign, axis in out)

    def words(self, name: Margin) -> str:
        """The limit of one margin, for a person."""
        robot, arm = self._robot, name.arm
        who = "" if arm is None else f"Arm {arm + 1} "
        space = robot.zone
        match name.kind:
            case MarginKind.JOINT_MIN if arm is not None:
                return f"{who}at its lower limit ({math.degrees(robot.joints.min[arm]):.1f}°)"
            case MarginKind.JOINT_MAX if arm is not None:
                return f"{who}at its upper limit ({math.degrees(robot.joints.max[arm]):.1f}°)"
            case MarginKind.BALL_JOINT:
                most = math.degrees(robot.joints.ball_joint_max or math.pi / 2)
                return f"{who}at its ball joints' limit ({most:.1f}°)"
            case MarginKind.TOOL_MIN:
                return f"Tool at its lower limit ({math.degrees(robot.joints.min[-1]):.1f}°)"
            case MarginKind.TOOL_MAX:
                return f"Tool at its upper limit ({math.degrees(robot.joints.max[-1]):.1f}°)"
            case MarginKind.TYPE_1:
                return f"{who}at the edge of its reach (arm and forearm in one line)"
            case MarginKind.TYPE_2:
                return "Near a pose in which the forearms lose hold of the effector"
            case MarginKind.PARALLELOGRAM:
                return "Near a pose in which the forearms let the effector tilt"
            case MarginKind.Z_MIN:
                return f"At the bottom of the workspace (Z {space.z[0]:.1f} mm)"
            case MarginKind.Z_MAX:
                return f"At the top of the workspace (Z {space.z[1]:.1f} mm)"
            case MarginKind.RADIUS if space.radius is not None:
                return f"At the workspace's radius ({space.radius:.1f} mm)"
            case MarginKind.X_MIN if space.x is not None:
                return f"At the workspace's end (X {space.x[0]:.1f} mm)"
            case MarginKind.X_MAX if space.x is not None:
                return f"At the workspace's end (X {space.x[1]:.1f} mm)"
            case MarginKind.Y_MIN if space.y is not None:
                return f"At the workspace's end (Y {space.y[0]:.1f} mm)"
            case MarginKind.Y_MAX if space.y is not None:
                return f"At the workspace's end (Y {space.y[1]:.1f} mm)"
            case _:
                return f"{who}{name.kind.value}"
