"""The robot: what it is built from, what limits it, what drives it. Immutable values."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from deltaviz.mechanism.arrays import Array, rows
from deltaviz.mechanism.bounds import ROUNDING, Bounds
from deltaviz.mechanism.kernel import Kernel
from deltaviz.mechanism.margin import Margin, MarginKind
from deltaviz.mechanism.masses import Masses
from deltaviz.mechanism.mechanism import Mechanism
from deltaviz.robots.bodies import Bodies, PlanarBodies

if TYPE_CHECKING:
    from deltaviz.robots.reach import Reach
    from deltaviz.robots.workspace import Limit, Workspace


@dataclass(frozen=True, slots=True)
class Joints:
    """Angles in rad, one per joint; `ball_joint_max` is the same for all forearms, None where
    they have no ball joints."""

    min: tuple[float, ...]
    max: tuple[float, ...]
    ball_joint_max: float | None


@dataclass(frozen=True, slots=True)
class Zone:
    """Where the tool tip must stay, mm: a height, and a cylinder or a box around the centre.

    What a person allows, `[workspace]` in the file; what the arms reach is `Robot.workspace`.
    """

    z: tuple[float, float]
    radius: float | None = None
    x: tuple[float, float] | None = None
    y: tuple[float, float] | None = None


@dataclass(frozen=True, slots=True)
class JointMotion:
    """rad/s and rad/s², one per joint."""

    velocity: tuple[float, ...]
    acceleration: tuple[float, ...]
    unhomed_velocity: tuple[float, ...]


@dataclass(frozen=True, slots=True)
class CartesianMotion:
    """Norms of the tool tip's motion: mm/s, mm/s², mm/s³."""

    velocity: float
    acceleration: float
    jerk: float


@dataclass(frozen=True, slots=True)
class Limits:
    joint: JointMotion
    cartesian: CartesianMotion


class DriveKind(Enum):
    STEP_DIR = "step_dir"
    SERVO = "servo"  # pulse-width servos: no board drives them yet, only the simulated one


@dataclass(frozen=True, slots=True)
class Drive:
    """`microsteps_per_rad` of the joint's own angle; for a servo, its smallest steps.

    `driver` and `enable_active` are None for a servo.
    """

    kind: DriveKind
    microsteps_per_rad: tuple[float, ...]
    invert: tuple[bool, ...]
    driver: str | None
    enable_active: str | None

    @property
    def simulation_only(self) -> bool:
        return self.kind is DriveKind.SERVO


@dataclass(frozen=True, slots=True)
class Homing:
    """`direction` is the sign of the joint's motion towards its switch (arms up: -1).

    Angles in rad, speeds in rad/s, one per joint.
    """

    direction: int
    switch: tuple[float, ...]
    switch_active: str
    fast: tuple[float, ...]
    slow: tuple[float, ...]
    backoff: tuple[float, ...]
    max_travel: tuple[float, ...]
    together: bool
    ready: tuple[float, ...]


@dataclass(frozen=True)
class Robot:
    """Positions are the tool tip's: the tool offset is applied here and nowhere else.

    With a `tool_axis` the last joint turns the tool about its tip: the joints are the mechanism's
    and that one.
    """

    name: str
    kind: str
    mechanism: Mechanism
    tool_offset: tuple[float, ...]
    joints: Joints
    zone: Zone
    limits: Limits
    drive: Drive
    homing: Homing
    tool_axis: bool = False
    bodies: Bodies | PlanarBodies | None = None
    masses: Masses | None = None

    @property
    def joint_count(self) -> int:
        return self.mechanism.joints + self.tool_axis

    @property
    def axes(self) -> tuple[str, ...]:
        """The coordinates of the tool tip, in their order: X, Y, Z, or X, Z in a plane."""
        return self.mechanism.axes

    @property
    def joint_names(self) -> tuple[str, ...]:
        """For a person: θ1, θ2, .. and Tool."""
        arms = tuple(f"θ{arm + 1}" for arm in range(self.mechanism.joints))
        return (*arms, "Tool") if self.tool_axis else arms

    def inverse(self, xyz: ArrayLike) -> Array:
        """Joint angles (..., n) rad of tool tip positions (..., d) mm; NaN rows out of reach.

        A tool axis, of which the tip tells nothing, stands at its ready angle.
        """
        arms = self.mechanism.inverse(self._centre(xyz))
        if not self.tool_axis:
            return arms
        tool = np.full((*arms.shape[:-1], 1), self.homing.ready[-1])
        return np.concatenate((arms, tool + 0.0 * arms[..., :1]), axis=-1)  # a NaN stays one

    def forward(self, theta: ArrayLike) -> Array:
        """Tool tip positions (..., d) mm of joint angles (..., n) rad; NaN where impossible."""
        return self.mechanism.forward(self._arms(theta)) + np.asarray(self.tool_offset)

    def jacobian(self, theta: ArrayLike) -> Array:
        """d xyz / d theta, (..., d, n) mm/rad."""
        jacobian = self.mechanism.jacobian(self._arms(theta))
        still = np.zeros((*jacobian.shape[:-1], int(self.tool_axis)))
        return np.concatenate((jacobian, still), axis=-1)

    @cached_property
    def bounds(self) -> Bounds:
        """What binds the mechanism."""
        arms = self.mechanism.joints
        return Bounds(
            tool_offset=self.tool_offset,
            joint_min=self.joints.min[:arms],
            joint_max=self.joints.max[:arms],
            ball_joint_max=self.joints.ball_joint_max,
            z=self.zone.z,
            x=self.zone.x,
            y=self.zone.y,
            radius=self.zone.radius,
        )

    @cached_property
    def kernel(self) -> Kernel:
        """Compiled batch functions for the control loop; the first use imports numba."""
        arms = self.mechanism.kernel(self.bounds)
        if not self.tool_axis:
            return arms
        from deltaviz.robots.tool_kernel import ToolKernel

        return ToolKernel(
            arms, low=self.joints.min[-1], high=self.joints.max[-1], scale=self.turn_scale
        )

    @cached_property
    def turn_scale(self) -> float:
        """mm of travel that a rad of the tool's turn counts for: at full speed, as much as the
        tip travels at its own."""
        return self.limits.cartesian.velocity / self.limits.joint.velocity[-1]

    def pose(self, xyz: ArrayLike, tool: float | None = None) -> Array:
        """(n,) as the kernel has it: a place of the tip (d,) mm and, with a tool axis, the tool's
        angle (rad) as travel."""
        tip = rows(xyz, len(self.axes), "xyz")
        return tip if not self.tool_axis else np.append(tip, (tool or 0.0) * self.turn_scale)

    @cached_property
    def margin_names(self) -> tuple[Margin, ...]:
        """What each column of `margins` tells."""
        arms = range(self.mechanism.joints)
        kinds = (MarginKind.TOOL_MIN, MarginKind.TOOL_MAX) if self.tool_axis else ()
        return (
            *self.mechanism.margin_names,
            *(Margin(MarginKind.BALL_JOINT, arm) for arm, _ in enumerate(self._sideways_max)),
            *(Margin(MarginKind.JOINT_MIN, arm) for arm in arms),
            *(Margin(MarginKind.JOINT_MAX, arm) for arm in arms),
            *(Margin(kind) for axis in self._box for kind in axis[1]),
            *([Margin(MarginKind.RADIUS)] if self.zone.radius is not None else []),
            *(Margin(kind, len(arms)) for kind in kinds),
        )

    def margins(self, xyz: ArrayLike, theta: ArrayLike) -> Array:
        """(..., m) as `margin_names`: a pose (tip `xyz` mm, its angles `theta` rad) is legal
        where all are at least 0. NaN angles are replaced by those nearest to reaching, so the
        margins are finite wherever `xyz` is."""
        tip = rows(xyz, len(self.tool_offset), "xyz")
        theta = rows(theta, self.joint_count, "theta")
        leading = np.broadcast_shapes(tip.shape[:-1], theta.shape[:-1])
        tip = np.broadcast_to(tip, (*leading, tip.shape[-1]))
        theta = np.broadcast_to(theta, (*leading, theta.shape[-1]))
        centre, arms = self._centre(tip), self.mechanism.joints
        angles = theta[..., :arms]
        angles = np.where(np.isnan(angles), self.mechanism.nearest_angles(centre), angles)
        most = np.asarray(self._sideways_max)
        scale = np.asarray(self.mechanism.joint_scale)
        groups = [
            self.mechanism.margins(centre, angles),
            (most**2 - self.mechanism.sideways(centre) ** 2) / (2 * most),
            (angles - np.asarray(self.joints.min[:arms])) * scale,
            (np.asarray(self.joints.max[:arms]) - angles) * scale,
        ]
        for (low, high), _, axis in self._box:
            groups.append(np.stack([tip[..., axis] - low, high - tip[..., axis]], axis=-1))
        radius = self.zone.radius
        if radius is not None:
            square = (tip[..., :-1] ** 2).sum(axis=-1, keepdims=True)
            groups.append((radius**2 - square) / (2 * radius))
        if self.tool_axis:
            turn = np.nan_to_num(theta[..., arms:], nan=self.homing.ready[-1])
            groups += [
                (turn - self.joints.min[-1]) * self.turn_scale,
                (self.joints.max[-1] - turn) * self.turn_scale,
            ]
        return np.concatenate(groups, axis=-1) + ROUNDING

    def workspace(
        self, limits: Limit | None = None, *, tolerance: float | None = None, threads: int = 1
    ) -> Workspace:
        """All tool tips within reach under limits (those of the machine, without the zone), its
        boundary to a tolerance in mm: 1, or for small robots 1/150 of the longest forearm."""
        from deltaviz.robots.workspace import Limit, Workspace, own_tolerance

        near = own_tolerance(self) if tolerance is None else tolerance
        return Workspace(self, limits or Limit.MACHINE, tolerance=near, threads=threads)

    def reach(self, xyz: ArrayLike) -> Reach:
        """Whether the tool tip may be at one point (d,) mm, and if not, why."""
        from deltaviz.robots.reach import reach

        return reach(self, xyz)

    @cached_property
    def _sideways_max(self) -> tuple[float, ...]:
        most = self.joints.ball_joint_max
        sine = 1.0 if most is None else float(np.sin(most))
        width = self.mechanism.sideways(np.zeros(len(self.axes))).shape[-1]
        return tuple(fore * sine for fore in self.mechanism.forearm[:width])

    @cached_property
    def _box(self) -> tuple[tuple[tuple[float, float], tuple[MarginKind, MarginKind], int], ...]:
        kinds = MarginKind
        axes = (
            (self.zone.z, (kinds.Z_MIN, kinds.Z_MAX), -1),
            (self.zone.x, (kinds.X_MIN, kinds.X_MAX), 0),
            (self.zone.y, (kinds.Y_MIN, kinds.Y_MAX), 1),
        )
        return tuple((box, kind, axis) for box, kind, axis in axes if box is not None)

    def _centre(self, xyz: ArrayLike) -> Array:
        return rows(xyz, len(self.tool_offset), "xyz") - np.asarray(self.tool_offset)

    def _arms(self, theta: ArrayLike) -> Array:
        return rows(theta, self.joint_count, "theta")[..., : self.mechanism.joints]
