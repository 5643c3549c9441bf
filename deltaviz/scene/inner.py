"""The only use of viser's inner messages, for what its public interface cannot do.

It shows a node or an input to all browsers alike: the messages behind that can be sent to one,
and stay in force until the next of the same kind. And it compares every pose by numpy before
it sends it, which cost two thirds of a frame (6 ms against 1.6).
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import viser
import viser._messages as messages
from viser import ClientHandle, GuiButtonHandle, GuiHtmlHandle, GuiInputHandle


def uuid_of(handle: GuiInputHandle[Any] | GuiButtonHandle | GuiHtmlHandle) -> str:
    """The name by which a browser speaks of an input."""
    return handle._impl.uuid


def place(node: viser.SceneNodeHandle, position: tuple[float, float, float]) -> None:
    """Move a node, if it is not there already; metres from its parent."""
    inner = node._impl
    if tuple(inner.position) != position:
        inner.position[:] = position
        inner.api._queue_scene_message(messages.SetPositionMessage(inner.name, position))


def turn(node: viser.SceneNodeHandle, wxyz: tuple[float, float, float, float]) -> None:
    """Turn a node to a unit quaternion, if it is not turned so already."""
    inner = node._impl
    if tuple(inner.wxyz) != wxyz:
        inner.wxyz[:] = wxyz
        inner.api._queue_scene_message(messages.SetOrientationMessage(inner.name, wxyz))


def set_visible(client: ClientHandle, node: str, visible: bool) -> None:
    """Show or hide a shared node in one browser."""
    client._websock_connection.queue_message(messages.SetSceneNodeVisibilityMessage(node, visible))


def set_enabled(client: ClientHandle, handle: GuiInputHandle[Any], enabled: bool) -> None:
    """Let one browser use a shared input, or only look at it."""
    client._websock_connection.queue_message(
        messages.GuiUpdateMessage(uuid_of(handle), {"disabled": not enabled})
    )


def set_draggable(
    client: ClientHandle,
    node: viser.SceneNodeHandle,
    bindings: Sequence[tuple[messages.DragButton, messages.KeyModifier | None]],
) -> None:
    """Let one browser drag a shared node by these (button, modifier) pairs only."""
    client._websock_connection.queue_message(
        messages.SetSceneNodeDragBindingsMessage(
            node.name,
            tuple(messages.DragBinding(button, modifier) for button, modifier in bindings),
        )
    )
