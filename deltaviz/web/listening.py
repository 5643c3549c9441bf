"""The listening socket: bound first, so that a taken port is known before anything starts."""

from __future__ import annotations

import errno
import ipaddress
import socket

# What a flooding page has on the way is bounded by the first, and with it the delay of a stop
# behind it; by the second, how old the states are that a slow page still has before it.
_RECEIVE_BUFFER = 32 * 1024  # bytes
_SEND_BUFFER = 256 * 1024
_BACKLOG = 128


class ListenError(Exception):
    """`status` is the program's exit status; the text tells a person what to do."""

    def __init__(self, text: str, *, status: int) -> None:
        super().__init__(text)
        self.status = status


def listen(host: str, port: int) -> socket.socket:
    """A socket that listens on a loopback address; port 0 takes any free one.

    Raises ListenError with status 2 for any other address, and with 1 when it cannot listen.
    """
    address = _loopback(host)
    family = socket.AF_INET6 if address.version == 6 else socket.AF_INET
    listener = socket.socket(family, socket.SOCK_STREAM)
    try:
        listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        listener.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, _RECEIVE_BUFFER)
        listener.setsockopt(socket.SOL_SOCKET, socket.SO_SNDBUF, _SEND_BUFFER)
        listener.bind((str(address), port))
        listener.listen(_BACKLOG)  # only now is a second server on this port refused
    except OSError as error:
        listener.close()
        raise ListenError(_why(error, host, port), status=1) from None
    return listener


def name_of(listener: socket.socket) -> tuple[str, int]:
    """The host, as it is written in a URL, and the port."""
    host, port = listener.getsockname()[:2]
    return (f"[{host}]" if ":" in host else host), port


def _loopback(host: str) -> ipaddress.IPv4Address | ipaddress.IPv6Address:
    bare = host.strip("[]")
    try:
        address = ipaddress.ip_address("127.0.0.1" if bare.lower() == "localhost" else bare)
    except ValueError:
        text = f"'{host}' is no address to listen on; use 127.0.0.1 or ::1."
        raise ListenError(text, status=2) from None
    if not address.is_loopback:
        raise ListenError(
            f"Listening on {host} would let the whole network move the robot, and there are no "
            "access tokens yet to prevent that. Use 127.0.0.1 (the default) or ::1.",
            status=2,
        )
    return address


def _why(error: OSError, host: str, port: int) -> str:
    match error.errno:
        case errno.EADDRINUSE:
            return (
                f"port {port} is in use, perhaps by another deltaviz; end that, or choose "
                "another port with --port (0: any free one)."
            )
        case errno.EACCES:
            return f"port {port} needs an administrator; choose one from 1024 up with --port."
        case errno.EADDRNOTAVAIL:
            return f"this computer has no address {host}; use 127.0.0.1."
        case _:
            return f"cannot listen on {host}, port {port}: {error.strerror}."
