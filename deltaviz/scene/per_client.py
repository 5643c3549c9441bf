"""What viser shares with every browser, changed for one: the only use of its inner messages.

viser's public interface shows a server's node or input to all browsers alike. The messages
behind it can be sent to one, and stay in force until the next message of the same kind.
"""

from __future__ import annotations

from typing import Any

import viser
import viser._messages as messages
from viser import ClientHandle, GuiInputHandle


def uuid_of(handle: GuiInputHandle[Any]) -> str:
    """The name by which a browser speaks of an input."""
    return handle._impl.uuid


def set_visible(client: ClientHandle, node: str, visible: bool) -> None:
    """Show or hide a shared node in one browser."""
    client._websock_connection.queue_message(messages.SetSceneNodeVisibilityMessage(node, visible))


def set_enabled(client: ClientHandle, handle: GuiInputHandle[Any], enabled: bool) -> None:
    """Let one browser use a shared input, or only look at it."""
    client._websock_connection.queue_message(
        messages.GuiUpdateMessage(uuid_of(handle), {"disabled": not enabled})
    )


def set_draggable(
    client: ClientHandle, node: viser.SceneNodeHandle, bindings: list[tuple[str, str | None]]
) -> None:
    """Let one browser drag a shared node by these (button, modifier) pairs only."""
    client._websock_connection.queue_message(
        messages.SetSceneNodeDragBindingsMessage(
            node.name,
            tuple(messages.DragBinding(button, modifier) for button, modifier in bindings),  # type: ignore[arg-type]
        )
    )
