"""Who may speak to us, by the headers that a browser writes and pages cannot."""

from __future__ import annotations

import itertools

import pytest
from fastapi import FastAPI
from fastapi.testclient import TestClient
from starlette.testclient import WebSocketDenialResponse

from deltaviz.web.origin import allowed_hosts, refusal

ALLOWED = allowed_hosts("127.0.0.1", 8000)
OURS = {"host": "127.0.0.1:8000"}


def refused(method: str, headers: dict[str, str]) -> bool:
    raw = [(name.encode(), value.encode()) for name, value in headers.items()]
    return refusal(method=method, headers=raw, allowed=ALLOWED) is not None


@pytest.mark.parametrize(
    ("host", "may"),
    [
        ("127.0.0.1:8000", True),
        ("localhost:8000", True),
        ("LOCALHOST:8000", True),
        ("[::1]:8000", True),
        ("127.0.0.1", False),
        ("127.0.0.1:80", False),
        ("127.0.0.1:8001", False),
        ("127.0.0.1:80000", False),
        ("127.0.0.2:8000", False),
        ("0.0.0.0:8000", False),
        ("localhost.:8000", False),
        ("evil.example:8000", False),
        ("localhost.evil.example:8000", False),
        ("evil.example#127.0.0.1:8000", False),
        ("", False),
    ],
)
@pytest.mark.parametrize("method", ["GET", "HEAD", "POST", "WEBSOCKET"])
def test_host_is_one_of_our_names_with_our_port(method: str, host: str, may: bool) -> None:
    assert refused(method, {"host": host}) is not may


@pytest.mark.parametrize("method", ["GET", "POST", "WEBSOCKET"])
def test_no_host_or_two_are_refused(method: str) -> None:
    assert refused(method, {})
    raw = [(b"host", b"127.0.0.1:8000"), (b"host", b"evil.example:8000")]
    assert refusal(method=method, headers=raw, allowed=ALLOWED)


@pytest.mark.parametrize(
    ("origin", "may"),
    [
        ("http://127.0.0.1:8000", True),
        ("HTTP://127.0.0.1:8000", True),
        ("http://localhost:8000", False),  # of ours, but not the one it speaks to
        ("https://127.0.0.1:8000", False),
        ("http://127.0.0.1:8001", False),
        ("http://127.0.0.1", False),
        ("http://127.0.0.1:8000.evil.example", False),
        ("http://evil.example", False),
        ("file://", False),
        ("null", False),
        ("", False),
    ],
)
@pytest.mark.parametrize("method", ["GET", "POST", "PUT", "DELETE", "OPTIONS", "WEBSOCKET"])
def test_origin_equals_our_own(method: str, origin: str, may: bool) -> None:
    assert refused(method, {**OURS, "origin": origin}) is not may


@pytest.mark.parametrize(
    ("site", "reads", "acts"),
    [
        ("same-origin", True, True),
        ("none", True, False),
        ("same-site", False, False),  # another port of this computer
        ("cross-site", False, False),
        ("", False, False),
        ("SAME-ORIGIN", False, False),
    ],
)
def test_sec_fetch_site(site: str, reads: bool, acts: bool) -> None:
    headers = {**OURS, "sec-fetch-site": site}
    for method in ("GET", "HEAD"):
        assert refused(method, headers) is not reads
    for method in ("POST", "PUT", "DELETE", "WEBSOCKET"):
        assert refused(method, headers) is not acts


def test_a_good_origin_does_not_excuse_a_foreign_site_nor_the_other_way_round() -> None:
    good, bad = "http://127.0.0.1:8000", "http://evil.example"
    assert refused("POST", {**OURS, "origin": good, "sec-fetch-site": "cross-site"})
    assert refused("POST", {**OURS, "origin": bad, "sec-fetch-site": "same-origin"})
    assert not refused("POST", {**OURS, "origin": good, "sec-fetch-site": "same-origin"})


def test_a_link_from_elsewhere_opens_the_page_but_nothing_is_embedded() -> None:
    foreign = {**OURS, "sec-fetch-site": "cross-site"}
    for mode, dest in itertools.product(
        ("navigate", "no-cors", "cors"), ("document", "iframe", "image", "script", "empty")
    ):
        headers = {**foreign, "sec-fetch-mode": mode, "sec-fetch-dest": dest}
        is_link = (mode, dest) == ("navigate", "document")
        assert refused("GET", headers) is not is_link
        assert refused("POST", headers)


def test_two_origins_are_refused() -> None:
    raw = [(b"host", b"127.0.0.1:8000"), *[(b"origin", b"http://127.0.0.1:8000")] * 2]
    assert refusal(method="POST", headers=raw, allowed=ALLOWED)


def test_the_default_port_may_be_left_out() -> None:
    headers = [(b"host", b"localhost"), (b"origin", b"http://localhost")]
    assert refusal(method="POST", headers=headers, allowed=allowed_hosts("127.0.0.1", 80)) is None


def test_the_bound_address_is_one_of_our_names() -> None:
    headers = [(b"host", b"127.0.0.9:8000")]
    assert refusal(method="GET", headers=headers, allowed=allowed_hosts("127.0.0.9", 8000)) is None


@pytest.mark.parametrize(
    ("method", "path"),
    [
        ("GET", "/"),
        ("GET", "/api/state"),
        ("POST", "/api/stop"),
        ("POST", "/api/move"),
        ("OPTIONS", "/api/move"),
        ("GET", "/scene/"),
        ("GET", "/docs"),
        ("GET", "/nowhere"),
    ],
)
def test_every_route_is_behind_the_guard(client: TestClient, method: str, path: str) -> None:
    answer = client.request(method, path, headers={"host": "evil.example:8000"})
    assert answer.status_code == 403
    assert "127.0.0.1:8000" in answer.json()["detail"]
    answer = client.request(method, path, headers={"origin": "http://evil.example"})
    assert answer.status_code == 403
    assert answer.headers.keys().isdisjoint({"access-control-allow-origin"})


@pytest.mark.parametrize("path", ["/ws", "/scene"])
def test_every_websocket_is_behind_the_guard(the_app: FastAPI, path: str) -> None:
    client = TestClient(the_app, base_url="http://127.0.0.1:8000")
    for headers in ({"origin": "null"}, {"sec-fetch-site": "same-site"}):
        with (
            pytest.raises(WebSocketDenialResponse) as denied,
            client.websocket_connect(f"ws://127.0.0.1:8000{path}", headers=headers),
        ):
            pass
        assert denied.value.status_code == 403
        assert denied.value.json()["detail"]
