"""The fast path: what the control loop calls for a few poses, thousands of times a second."""

from __future__ import annotations

from typing import Protocol

from deltaviz.mechanism.arrays import Array


class Kernel(Protocol):
    """Batch functions on C-contiguous float64 arrays of N poses.

    A pose is given by as many numbers as there are joints (d = n): `xyz` is the tool tip, and
    where the tool turns, the turn behind it (see `robots.tool_kernel`).

    Arrays of another type, shape or layout are the caller's mistake and are not checked.
    """

    def inverse(self, xyz: Array) -> Array:
        """(N, d) mm to (N, n) rad; rows of NaN where out of reach."""
        ...

    def forward(self, theta: Array) -> Array:
        """(N, n) rad to (N, d) mm; rows of NaN where the forearms cannot meet."""
        ...

    def margins(self, xyz: Array, theta: Array) -> Array:
        """(N, m) of poses whose `theta` belongs to their `xyz`; legal where all are >= 0.

        Angles that are NaN (out of reach) are replaced by those nearest to reaching, so that
        margins are finite wherever `xyz` is.
        """
        ...

    def joint_velocity(self, xyz: Array, theta: Array, velocity: Array) -> Array:
        """Tip velocity (N, d) mm/s to joint velocity (N, n) rad/s; not finite at type 1."""
        ...

    def tip_velocity(self, xyz: Array, theta: Array, velocity: Array) -> Array:
        """Joint velocity (N, n) rad/s to tip velocity (N, d) mm/s; not finite at type 2."""
        ...

    def warm_up(self) -> None:
        """Compile everything now, so that no later call stalls."""
        ...
