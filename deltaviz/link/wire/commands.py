"""Which messages are commands: numbered, sent one at a time, repeated until they are answered.

The others (Stop, EStop, Segment, Keep; Telemetry, Stopped) carry the sequence 0.
"""

from __future__ import annotations

from deltaviz.link.messages import (
    Arm,
    BoardMessage,
    Configure,
    Configured,
    Done,
    Enable,
    Hello,
    HelloReply,
    Home,
    HostMessage,
    Refused,
    Reset,
    Tool,
)

COMMANDS = (Hello, Configure, Enable, Home, Arm, Reset, Tool)
NAMES = {kind.__name__.lower() for kind in COMMANDS}


def name_of(command: HostMessage) -> str:
    """As answers call it."""
    return type(command).__name__.lower()


def answered_by(message: BoardMessage) -> str | None:
    """The name of the command that a message answers; None for what answers none."""
    match message:
        case HelloReply():
            return "hello"
        case Configured():
            return "configure"
        case Done() | Refused() if message.command in NAMES:
            return message.command
        case _:
            return None


def next_sequence(sequence: int) -> int:
    """1 to 255, and 1 again."""
    return sequence % 255 + 1


def is_newer(sequence: int, last: int) -> bool:
    """Whether it comes 1 to 127 after the last one, modulo 256."""
    return 1 <= (sequence - last) & 0xFF <= 127
