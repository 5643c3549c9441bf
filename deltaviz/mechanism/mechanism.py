"""What every kind of robot can compute."""

from __future__ import annotations

from typing import Protocol

from numpy.typing import ArrayLike

from deltaviz.mechanism.arrays import Array
from deltaviz.mechanism.bounds import Bounds
from deltaviz.mechanism.kernel import Kernel
from deltaviz.mechanism.margin import Margin


class Mechanism(Protocol):
    """Lengths in mm, angles in rad, float64; all functions broadcast over the leading axes."""

    @property
    def joints(self) -> int:
        """How many joints move the effector: n."""
        ...

    @property
    def axes(self) -> tuple[str, ...]:
        """The coordinates that it has, in their order: X, Y, Z, or X, Z in a plane."""
        ...

    @property
    def margin_names(self) -> tuple[Margin, ...]: ...

    @property
    def forearm(self) -> tuple[float, ...]: ...

    @property
    def joint_scale(self) -> tuple[float, ...]:
        """mm of travel per rad of each joint, about: the upper arms."""
        ...

    def inverse(self, xyz: ArrayLike) -> Array:
        """(..., d) of the effector's centre to (..., n); rows of NaN where out of reach."""
        ...

    def forward(self, theta: ArrayLike) -> Array:
        """(..., n) to (..., d); rows of NaN where the forearms cannot meet."""
        ...

    def jacobian(self, theta: ArrayLike) -> Array:
        """(..., n) to (..., d, n): d xyz / d theta, mm/rad."""
        ...

    def margins(self, xyz: ArrayLike, theta: ArrayLike) -> Array:
        """The geometry's own margins, (..., m), in the order of `margin_names`."""
        ...

    def nearest_angles(self, xyz: ArrayLike) -> Array:
        """As `inverse`, but an arm that cannot reach gets the angle that comes nearest."""
        ...

    def sideways(self, xyz: ArrayLike) -> Array:
        """(..., n) mm: how far each forearm leans out of its arm's plane; (..., 0) in a plane."""
        ...

    def misses(self, xyz: ArrayLike) -> tuple[Array, Array]:
        """(too far, too near), each (..., n) mm: how far each arm is from reaching; negative
        where it reaches."""
        ...

    def kernel(self, bounds: Bounds) -> Kernel:
        """The compiled functions for the tool tip of a robot with these limits."""
        ...
