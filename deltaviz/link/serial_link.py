"""Serial ports, and whatever else pyserial opens by a URL, as transports."""

from __future__ import annotations

import contextlib
import os
import re
import socket
import time
from collections.abc import Callable
from dataclasses import dataclass
from importlib.util import find_spec
from typing import TYPE_CHECKING, Any, cast
from urllib.parse import parse_qsl, urlencode, urlsplit

from deltaviz.link.stream_transport import StreamTransport
from deltaviz.link.tap import Tap, untapped
from deltaviz.link.transport import LinkError

if TYPE_CHECKING:
    from serial import SerialBase

    from deltaviz.link.pumped_stream import Port
    from deltaviz.link.wire.stream import ByteStream

BAUD = 921600  # unless the URL says otherwise: what our firmware speaks
_BAUD_MAX = 20_000_000
_PORT_NAME = re.compile(r"COM\d+", re.IGNORECASE)


@dataclass(frozen=True, slots=True)
class SerialAddress:
    """`target` is what pyserial opens."""

    target: str
    baud: int = BAUD

    @property
    def is_port(self) -> bool:
        """Whether it is a port of this computer, and not some URL of pyserial's."""
        return "://" not in self.target


def serial_address(url: str) -> SerialAddress:
    """Reads `serial://DEVICE?baud=N`, a device's path, or any URL of pyserial's, which may have
    a `baud` among its options. Raises LinkError for what is none of these.
    """
    if "://" not in url:
        return SerialAddress(_port(url, url))
    parts = urlsplit(url)
    options = parse_qsl(parts.query, keep_blank_values=True)
    bauds = [value for key, value in options if key == "baud"]
    baud = _baud(url, bauds[-1]) if bauds else BAUD
    others = [(key, value) for key, value in options if key != "baud"]
    if parts.scheme == "serial":
        if others:
            raise LinkError(f"{url!r}: serial:// has no option {others[0][0]!r}; it has baud")
        return SerialAddress(_port(parts.netloc + parts.path, url), baud)
    if not re.fullmatch(r"[a-z0-9]+", parts.scheme) or not _pyserial_has(parts.scheme):
        raise LinkError(_unknown(url))
    rest = urlencode(others, safe="/:")
    return SerialAddress(url.partition("?")[0] + (f"?{rest}" if rest else ""), baud)


def open_serial(
    url: str, *, tap: Tap = untapped, clock: Callable[[], float] = time.monotonic
) -> StreamTransport:
    """Opens what `url` names, for this program alone. Raises LinkError. May take seconds."""
    address = serial_address(url)
    stream, release = open_stream(address)
    name = address.target
    return StreamTransport(
        tap(stream), broke=lambda reason: broke(name, reason), release=release, clock=clock
    )


def broke(name: str, reason: str) -> str:
    """What to tell of a link that was open and has ended."""
    return (
        f"The link to {name} broke: {reason}. A moving board brakes by itself. Check its cable and "
        "power, then connect; nothing is resumed."
    )


def open_stream(address: SerialAddress) -> tuple[ByteStream, Callable[[], None]]:
    """The open port as a stream, and what is to be called after the stream was closed.

    Raises LinkError.
    """
    port = _open(address)
    descriptor = _descriptor(port)
    if descriptor is not None:
        from deltaviz.link.descriptor_stream import DescriptorStream, window

        claim(descriptor, os.ttyname(descriptor))
        _answer_at_once(port)
        stream = DescriptorStream(descriptor, in_system=window(address.baud))
        return stream, lambda: _close(port)
    if (sock := getattr(port, "_socket", None)) is not None and type(port).__module__.endswith(
        "protocol_socket"
    ):
        from deltaviz.link.socket_stream import SocketStream

        own = socket.socket(fileno=os.dup(sock.fileno()))
        own.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        return SocketStream(own), lambda: _close(port)
    from deltaviz.link.pumped_stream import PumpedStream

    return PumpedStream(cast("Port", port)), lambda: None


def _open(address: SerialAddress) -> SerialBase:
    from serial import SerialException, serial_for_url

    from deltaviz.link.port_trouble import trouble
    from deltaviz.link.pumped_stream import LOOK

    options: dict[str, Any] = {"exclusive": True} if os.name == "posix" else {}
    try:
        return serial_for_url(address.target, baudrate=address.baud, timeout=LOOK, **options)
    except (SerialException, OSError, ValueError, LookupError, TypeError) as error:
        if address.is_port:
            raise LinkError(trouble(address.target, error)) from error
        raise LinkError(
            f"{address.target} cannot be opened ({_cause(error)}). Check its address, and that "
            "the other side is running, then connect."
        ) from error


def _descriptor(port: SerialBase) -> int | None:
    """That of a serial port of this system, unless its class does more than read from it."""
    from serial import Serial

    if os.name != "posix" or type(port).read is not Serial.read:
        return None
    return port.fileno()


def claim(descriptor: int, device: str) -> None:
    """Keep also those out who do not ask for a lock, as pyserial does. A pseudo-terminal would
    remember the claim of a program that was killed.
    """
    import fcntl
    import termios

    if not device.startswith("/dev/pts/"):
        fcntl.ioctl(descriptor, termios.TIOCEXCL)


def _answer_at_once(port: SerialBase) -> None:
    """Let the driver hand on what arrives without collecting it first, where it can."""
    set_low_latency: Callable[[bool], None] | None = getattr(port, "set_low_latency_mode", None)
    with contextlib.suppress(ValueError, OSError):  # a driver that has no such mode
        if set_low_latency is not None:
            set_low_latency(True)


def _close(port: SerialBase) -> None:
    with contextlib.suppress(OSError):
        port.close()


def _port(name: str, url: str) -> str:
    if name and (os.sep in name or _PORT_NAME.fullmatch(name)):
        return name
    raise LinkError(_unknown(url))


def _baud(url: str, text: str) -> int:
    if text.isdecimal() and 0 < int(text) <= _BAUD_MAX:
        return int(text)
    raise LinkError(f"{url!r}: baud is {text!r}; it is a number from 1 to {_BAUD_MAX}")


def _pyserial_has(scheme: str) -> bool:
    return find_spec(f"serial.urlhandler.protocol_{scheme}") is not None


def _unknown(url: str) -> str:
    return (
        f"{url!r} is not a link. Use sim://, a serial port such as /dev/ttyUSB0 "
        "(deltaviz ports lists them), or socket://HOST:PORT"
    )


def _cause(error: Exception) -> str:
    """pyserial wraps what went wrong in its own words and the address."""
    cause = error.__context__
    return str((cause.strerror if isinstance(cause, OSError) else None) or cause or error)
