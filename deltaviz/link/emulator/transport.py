"""`emulate://`: the emulated board as a link."""

from __future__ import annotations

from typing import Self
from urllib.parse import parse_qsl, urlsplit

from deltaviz.link.emulator import firmware, qemu
from deltaviz.link.emulator.emulator import Emulator
from deltaviz.link.emulator.wire_pair import wire_pair
from deltaviz.link.messages import Configure
from deltaviz.link.socket_stream import SocketStream
from deltaviz.link.stream_transport import StreamTransport
from deltaviz.link.tap import Tap, untapped
from deltaviz.link.transport import LinkError


def check_emulator(url: str = "emulate://") -> None:
    """Raises LinkError for a wrong URL, and where no emulator can be started."""
    parts = urlsplit(url)
    if parts.netloc or parts.path or parts.fragment:
        raise LinkError(f"{url!r}: nothing may stand between emulate:// and a question mark")
    for key, value in parse_qsl(parts.query, keep_blank_values=True):
        if (key, value) != ("homed", "0"):
            raise LinkError(
                f"{url!r}: emulate:// has no option {key}={value}; it starts as a real board does, "
                "disabled and unhomed"
            )
    for there, missing in (
        (qemu.is_installed(), qemu.MISSING),
        (firmware.is_buildable(), firmware.MISSING),
    ):
        if not there:
            raise LinkError(f"{missing}. Or use the simulated board: sim://")


class EmulatedTransport(StreamTransport):
    """Closed, the board ends at once, as if its power were cut."""

    @classmethod
    def start(cls, configure: Configure, *, tap: Tap = untapped) -> Self:
        """Takes some seconds when the firmware has to be built first. Raises LinkError."""
        check_emulator()
        image = firmware.built()
        ours, theirs = wire_pair()
        with theirs:
            emulator = Emulator.start(configure, image=image, link=theirs)

        def broke(_: str) -> str:
            return f"The emulated board has ended: {emulator.last_words}. Connect again."

        return cls(tap(SocketStream(ours)), broke=broke, release=emulator.close)
