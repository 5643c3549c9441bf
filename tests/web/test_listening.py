"""Where the server listens, and what it says when it may or can not."""

from __future__ import annotations

import contextlib
import socket

import pytest

from deltaviz.web.listening import ListenError, listen, name_of


@pytest.mark.parametrize(
    ("host", "name"),
    [("127.0.0.1", "127.0.0.1"), ("localhost", "127.0.0.1"), ("127.0.0.7", "127.0.0.7")],
)
def test_loopback_is_listened_on(host: str, name: str) -> None:
    with contextlib.closing(listen(host, 0)) as listener:
        found, port = name_of(listener)
        assert found == name
        socket.create_connection((name, port)).close()


def test_ipv6_is_named_as_in_a_url() -> None:
    try:
        listener = listen("[::1]", 0)
    except ListenError as error:
        pytest.skip(str(error))
    with contextlib.closing(listener):
        assert name_of(listener)[0] == "[::1]"


@pytest.mark.parametrize(
    "host", ["0.0.0.0", "::", "192.168.1.10", "10.0.0.1", "example.org", "", "127.0.0.1.nip.io"]
)
def test_nothing_but_loopback(host: str) -> None:
    with pytest.raises(ListenError) as refused:
        listen(host, 0)
    assert refused.value.status == 2
    assert "127.0.0.1" in str(refused.value)


def test_a_taken_port_is_told_with_what_to_do() -> None:
    with contextlib.closing(listen("127.0.0.1", 0)) as first:
        port = first.getsockname()[1]
        with pytest.raises(ListenError) as refused:
            listen("127.0.0.1", port)
    assert refused.value.status == 1
    assert f"port {port} is in use" in str(refused.value)
    assert "--port" in str(refused.value)


def test_a_port_is_free_again_at_once() -> None:
    with contextlib.closing(listen("127.0.0.1", 0)) as first:
        port = first.getsockname()[1]
        caller = socket.create_connection(("127.0.0.1", port))
        answered, _ = first.accept()
        answered.close()  # our side closes first: the port waits a while, as the system sees it
        caller.close()
    listen("127.0.0.1", port).close()
