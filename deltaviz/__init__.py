"""deltaviz: a 3D viewer and jog controller for delta robots in the browser."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from deltaviz.robots import load_robot as load_robot

__all__ = ["load_robot"]


def __getattr__(name: str) -> Any:
    """Imports `load_robot` at its first use: `import deltaviz` alone stays quick."""
    if name != "load_robot":
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    from deltaviz.robots import load_robot

    return load_robot
