"""What the motion layer needs of a robot. `robots.Robot` is one; so are the tests' small machines."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Protocol

from deltaviz.mechanism.arrays import Array
from deltaviz.mechanism.kernel import Kernel
from deltaviz.mechanism.margin import Margin

if TYPE_CHECKING:
    from deltaviz.robots.robot import Joints, Limits, Workspace

__all__ = ["Array", "Followed", "Kernel", "Margin"]


class Followed(Protocol):
    """A robot that can be made to follow: n joints, as many axes."""

    @property
    def joint_count(self) -> int: ...
    @property
    def joints(self) -> Joints: ...
    @property
    def limits(self) -> Limits: ...
    @property
    def workspace(self) -> Workspace: ...
    @property
    def margin_names(self) -> Sequence[Margin]: ...
    @property
    def kernel(self) -> Kernel: ...
