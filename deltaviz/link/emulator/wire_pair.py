"""The wire between host and emulated board: what one end writes, the other need not read yet."""

from __future__ import annotations

import socket


def wire_pair() -> tuple[socket.socket, socket.socket]:
    """Two connected sockets, by TCP. QEMU writes byte by byte, of which a Unix socket holds 278;
    then QEMU waits, and the board's time with it, which a real board's would not do.
    """
    with socket.create_server(("127.0.0.1", 0), backlog=1) as server:
        ours = socket.create_connection(server.getsockname())
        while True:
            theirs, address = server.accept()
            if address == ours.getsockname():
                break
            theirs.close()  # somebody else's
    for end in (ours, theirs):
        end.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
    return ours, theirs
