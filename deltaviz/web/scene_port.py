"""What the web application needs of the scene."""

from __future__ import annotations

from collections.abc import Callable
from typing import Protocol

from fastapi import APIRouter
from starlette.requests import HTTPConnection


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

    def set_theme(self, session: str, dark: bool) -> None:
        """Show this session's view dark or light."""
        ...
