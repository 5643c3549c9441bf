"""What an input of the panel does when a person uses it, and not when we set it."""

from __future__ import annotations

from collections.abc import Callable, Coroutine
from typing import Any

from viser import GuiEvent


def by_a_person(
    change: Callable[[Any], None],
) -> Callable[[GuiEvent[Any]], Coroutine[None, None, None]]:
    """A callback that hands the new value on. Async callbacks keep their order."""

    async def update(event: GuiEvent[Any]) -> None:
        if event.client is not None:
            change(event.target.value)

    return update
