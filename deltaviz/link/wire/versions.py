"""What stays the same in every version of the protocol: how a board of another one is understood.

The frames; Hello (type 0x01), which is its version and nothing else; and HelloReply (0x81), whose
first field is its version.
"""

from __future__ import annotations

from deltaviz.link.messages import PROTOCOL_VERSION, BoardMessage, HelloReply, StopCause
from deltaviz.link.wire.codec import decode_board, type_of
from deltaviz.link.wire.frames import Frame

_HELLO_REPLY = type_of(HelloReply)


def decode_from_any_board(frame: Frame) -> BoardMessage:
    """A board's message; a HelloReply of another version says no more than that. Raises
    Malformed.
    """
    version = int.from_bytes(frame.payload[:2], "little")
    if frame.type != _HELLO_REPLY or len(frame.payload) < 2 or version == PROTOCOL_VERSION:
        return decode_board(frame.type, frame.payload)
    return HelloReply(
        version=version, board="", build="", joints=0, tick_hz=0, queue_places=0, boot=0,
        last_epoch=0, homed=False, configuration=0, last_stop=StopCause.NONE,
    )  # fmt: skip
