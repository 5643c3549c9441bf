from __future__ import annotations

import contextlib

import pytest
import viser._messages as messages
from websockets.exceptions import InvalidStatus
from websockets.sync.client import connect

from deltaviz.scene import listener


def test_a_stranger_is_refused_over_websocket_and_http() -> None:
    opened = listener.open_listener()
    try:
        with pytest.raises(InvalidStatus) as refusal:
            connect(f"ws://127.0.0.1:{opened.port}/")
        assert refusal.value.response.status_code == 403
        assert listener._status(opened.port, {}, upgrade=False) == 403
    finally:
        opened.close()


def test_the_program_does_not_start_when_the_guard_is_missing(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(listener, "_guarded", lambda secret: contextlib.nullcontext())
    with pytest.raises(listener.ListenerOpenError, match="without the secret"):
        listener.open_listener()


def test_the_program_does_not_start_when_plain_http_is_served(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    asking_for = listener._asking_for

    def only_websockets(secret, inner):
        guarded = asking_for(secret, inner)
        return lambda c, r: guarded(c, r) if "Upgrade" in r.headers else inner(c, r)

    monkeypatch.setattr(listener, "_asking_for", only_websockets)
    with pytest.raises(listener.ListenerOpenError, match="HTTP"):
        listener.open_listener()


def test_two_secrets_in_one_request_are_refused() -> None:
    opened = listener.open_listener()
    try:
        header = listener.SECRET_HEADER
        twice = [(header, opened.secret), (header, "x")]
        with pytest.raises(InvalidStatus):
            connect(f"ws://127.0.0.1:{opened.port}/", additional_headers=twice)
    finally:
        opened.close()


def test_each_start_has_its_own_secret_on_loopback() -> None:
    first, second = listener.open_listener(), listener.open_listener()
    try:
        assert first.secret != second.secret
        assert first.server.get_host() == "127.0.0.1"
    finally:
        first.close()
        second.close()


def test_nobody_can_open_the_share_tunnel() -> None:
    opened = listener.open_listener()
    try:
        handlers = opened.server._websock_server._incoming_handlers
        assert messages.ShareUrlRequest not in handlers
        with pytest.raises(RuntimeError, match="disabled"):
            opened.server.request_share_url()
    finally:
        opened.close()
