"""Motion: keeps a robot inside its limits, whatever it is asked to follow."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from deltaviz.motion.follower import Follower

__all__ = ["Follower"]


def __getattr__(name: str) -> Any:
    """`Follower` comes late: it brings numba, which only the controller's process needs."""
    if name == "Follower":
        from deltaviz.motion.follower import Follower

        return Follower
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
