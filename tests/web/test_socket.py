"""/ws over a real socket: the newest state for everyone, whatever the others do."""

from __future__ import annotations

import contextlib
import dataclasses
import json
import socket
import threading
import time
from collections.abc import Callable
from typing import Any

import httpx
import pytest
from websockets.exceptions import ConnectionClosed
from websockets.sync.client import ClientConnection

from deltaviz.machine.intent import ClientGone, ClientHere, Enable, JogStart, RefusalKind, Refused
from deltaviz.machine.mode import Mode
from deltaviz.scene.items import Readout, Toggle
from deltaviz.scene.rows import ColourKey, Row
from deltaviz.web.conversation import MAX_MESSAGE
from deltaviz.web.socket import STATE_PERIOD

STOP = json.dumps({"type": "stop"})


def receive(connection: ClientConnection, kind: str) -> dict[str, Any]:
    """The next message of this kind."""
    while True:
        message = json.loads(connection.recv(timeout=20))
        if message["type"] == kind:
            return message


def stops(machine: Any) -> int:
    return sum(told[0] == "stop" for told in machine.told if isinstance(told, tuple))


def test_states_come_by_themselves(live: Any) -> None:
    with live.socket() as connection:
        states = [receive(connection, "state") for _ in range(10)]
    assert states[0].keys() >= {"mode", "xyz_mm", "theta_deg", "link", "control"}


def test_they_are_meant_to_come_at_30_hz_or_better() -> None:
    assert STATE_PERIOD <= 0.8 / 30  # with room for a busy computer's delays


def test_a_state_is_the_newest(live: Any, machine: Any, eventually: Any) -> None:
    with live.socket() as connection:
        for mode in (Mode.JOGGING, Mode.STOPPING, Mode.ESTOP):
            machine.show(mode=mode)
            eventually(lambda mode=mode: receive(connection, "state")["mode"] == mode, mode)


def test_requests_and_sockets_of_a_page_are_one_client(live: Any, machine: Any) -> None:
    page = live.page()
    with live.socket(page) as connection:
        receive(connection, "state")
        httpx.post(f"{live.url}/api/enable", headers={"Cookie": page})
        (here,), (told,) = machine.told_of(ClientHere), machine.told_of(Enable)
        assert here.client == told.client
        machine.show(holder=told.client)
        while not receive(connection, "state")["control"]["you"]:
            pass
        state = httpx.get(f"{live.url}/api/state", headers={"Cookie": page}).json()
        assert state["control"] == {"holder": "you", "you": True}
        with live.socket(live.page()) as other:
            assert receive(other, "state")["control"] == {"holder": "another", "you": False}
        with live.socket() as program:
            assert receive(program, "state")["control"] == {"holder": "another", "you": False}


def test_a_cookie_without_an_open_page_is_nobody_s(live: Any, machine: Any) -> None:
    httpx.post(f"{live.url}/api/enable", headers={"Cookie": live.page()})
    assert machine.told == [Enable("http")]


def test_the_scene_s_frames_belong_to_the_page(live: Any, machine: Any, scene: Any) -> None:
    page = live.page()
    session = page.split("=")[1]
    machine.show(holder=session)
    assert scene.holds_control(session)
    assert not scene.holds_control("another")


def test_the_view_is_told_when_it_changes(live: Any, scene: Any, eventually: Any) -> None:
    page = live.page()
    session = page.split("=")[1]
    rows = (Row("Reach: 31 l", dot=(1, 2, 3)), ColourKey("Resolution", "1", "2", ((0, 0, 0),)))
    toggle = Toggle("Workspace: Reach", "Workspace", "Reach", False)
    scene.shown[session] = (toggle, Readout("Workspace: told", "Workspace", rows))
    with live.socket(page) as connection:
        first, second = receive(connection, "view")["items"]
        assert first == {
            "kind": "toggle",
            "key": "Workspace: Reach",
            "group": "Workspace",
            "label": "Reach",
            "value": False,
        }
        assert second["rows"] == [
            {"kind": "row", "text": "Reach: 31 l", "value": "", "dot": [1, 2, 3]},
            {"kind": "colours", "name": "Resolution", "low": "1", "high": "2", "stops": [[0] * 3]},
        ]
        kinds = [json.loads(connection.recv(timeout=20))["type"] for _ in range(10)]
        assert kinds == ["state"] * 10  # nothing new, nothing said
        scene.shown[session] = (dataclasses.replace(toggle, value=True),)
        assert receive(connection, "view")["items"][0]["value"] is True
        del scene.shown[session]
        assert receive(connection, "view")["items"] is None


def test_the_last_socket_of_a_page_takes_it_along(live: Any, machine: Any, eventually: Any) -> None:
    page = live.page()
    with live.socket(page):
        with live.socket(page):
            pass
        with live.socket() as program:
            receive(program, "state")
        eventually(lambda: machine.told_of(ClientGone), "the program's end")
        assert page.split("=")[1] not in [gone.client for gone in machine.told_of(ClientGone)]
    eventually(lambda: len(machine.told_of(ClientGone)) == 2, "the page's end")
    assert machine.told_of(ClientGone)[1] == ClientGone(page.split("=")[1])


def test_a_page_that_breaks_off_is_gone(live: Any, machine: Any, eventually: Any) -> None:
    connection = live.socket()
    receive(connection, "state")
    connection.socket.shutdown(socket.SHUT_RDWR)
    eventually(lambda: machine.told_of(ClientGone), "the end")


@pytest.mark.parametrize(
    "bad",
    ["nonsense", "", b"\x00\x01", '{"type": "jog_start", "v_mm_s": [NaN]}', "x" * MAX_MESSAGE * 2],
)
def test_after_a_malformed_message_the_socket_goes_on(live: Any, machine: Any, bad: Any) -> None:
    with live.socket() as connection:
        connection.send(bad)
        assert receive(connection, "error")["detail"]
        connection.send(STOP)
        receive(connection, "state")
        while not stops(machine):
            receive(connection, "state")


def close_code(connection: ClientConnection) -> int | None:
    """Read until the server closes; its code."""
    try:
        while True:
            connection.recv(timeout=20)
    except ConnectionClosed as closed:
        return closed.rcvd.code if closed.rcvd else None


def test_errors_without_end_are_hung_up_on(live: Any) -> None:
    with live.socket() as connection:
        with contextlib.suppress(ConnectionClosed):  # it need not hear all of them
            for _ in range(40):
                connection.send("nonsense")
        assert close_code(connection) == 1008


@pytest.mark.parametrize("bad", [b"\xff\xfe", b"x" * 100_000])
def test_what_is_no_websocket_message_ends_that_socket_only(live: Any, bad: bytes) -> None:
    with live.socket() as other:
        with live.socket() as connection:
            connection.send(bad, text=True)
            assert close_code(connection) in (1007, 1009)
        receive(other, "state")


def test_a_refusal_comes_back(live: Any, machine: Any) -> None:
    machine.answer = Refused(RefusalKind.MODE, "Home first.")
    with live.socket() as connection:
        jog = {"type": "jog_start", "id": "a", "frame": "base", "v_mm_s": [1, 0, 0]}
        connection.send(json.dumps(jog))
        told = receive(connection, "refused")
        assert told == {"type": "refused", "to": "jog_start", "id": "a", "detail": "Home first."}
        assert machine.told_of(JogStart)[0].at <= time.monotonic()


class Flood:
    """A page that sends as fast as it can, from a thread of its own."""

    def __init__(self, connection: ClientConnection) -> None:
        self._connection = connection
        self._over = threading.Event()
        self._thread = threading.Thread(target=self._run)

    def _run(self) -> None:
        message = json.dumps({"type": "override", "value": 1})
        while not self._over.is_set():
            for _ in range(200):
                self._connection.send(message)

    def __enter__(self) -> Flood:
        self._thread.start()
        return self

    def __exit__(self, *_: object) -> None:
        self._over.set()
        self._thread.join(20)


def test_stops_arrive_while_another_floods(
    live: Any, machine: Any, eventually: Callable[..., Any]
) -> None:
    with live.socket() as flooding, live.socket() as calm, Flood(flooding):
        eventually(lambda: len(machine.told) > 50, "the flood")
        for n in range(10):
            calm.send(STOP)
            eventually(lambda n=n: stops(machine) == n + 1, "a stop")
        for _ in range(5):
            assert httpx.post(f"{live.url}/api/stop").status_code == 200
    assert stops(machine) == 15


def test_a_flooding_page_s_own_stop_arrives(
    live: Any, machine: Any, eventually: Callable[..., Any]
) -> None:
    with live.socket() as flooding, Flood(flooding):
        for n in range(5):
            flooding.send(STOP)
            eventually(lambda n=n: stops(machine) == n + 1, "a stop")


def test_a_page_that_reads_nothing_holds_nobody_up(live: Any, machine: Any) -> None:
    deaf = socket.create_connection(("127.0.0.1", live.port))
    deaf.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 2048)
    deaf.sendall(
        b"GET /ws HTTP/1.1\r\nHost: 127.0.0.1:%d\r\nUpgrade: websocket\r\n"
        b"Connection: Upgrade\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n"
        b"Sec-WebSocket-Version: 13\r\n\r\n" % live.port
    )
    machine.show(stop_reason="x" * 20_000)  # fills what is between us in a moment
    try:
        with live.socket() as connection:
            for _ in range(60):
                receive(connection, "state")
            connection.send(STOP)
            while not stops(machine):
                receive(connection, "state")
    finally:
        deaf.close()


def test_so_many_pages_and_no_more(live: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("deltaviz.web.socket.MAX_SOCKETS", 2)
    with live.socket() as one, live.socket() as two:
        receive(one, "state")
        receive(two, "state")
        with live.socket() as three:
            assert close_code(three) == 1013
