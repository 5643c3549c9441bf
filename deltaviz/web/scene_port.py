"""What the web application needs of the scene."""

from __future__ import annotations

from collections.abc import Callable
from typing import Protocol

from fastapi import APIRouter
from starlette.requests import HTTPConnection

from deltaviz.scene.items import AnyItem


class ScenePort(Protocol):
    """The 3D view, running elsewhere; thread-safe."""

    def router(
        self,
        *,
        session_of: Callable[[HTTPConnection], str | None],
        holds_control: Callable[[str], bool],
    ) -> APIRouter:
        """Routes for the page at `/scene/` and its websocket at `/scene`."""
        ...

    def camera_yaw(self, session: str) -> float | None:
        """The turn (rad, about Z) from base +X to the right of this session's view, if any."""
        ...

    def items(self, session: str) -> tuple[AnyItem, ...] | None:
        """What this session may choose of its view, and what it is told; the same object while
        nothing changes. None while it has no view."""
        ...

    def choose(self, session: str, key: str, value: object, refused: Callable[[str], None]) -> None:
        """Choose one of the items; `refused` is called with the reason, from another thread."""
        ...

    def set_theme(self, session: str, dark: bool) -> None:
        """Show this session's view dark or light."""
        ...
