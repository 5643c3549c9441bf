"""What holds for every response: headers, sizes, cookies, nothing from elsewhere."""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from fastapi import FastAPI
from fastapi.testclient import TestClient

from deltaviz.web.body_limit import MAX_BODY
from deltaviz.web.static_files import static_dir

EVERY_KIND = [
    ("GET", "/", 200),
    ("GET", "/main.js", 200),
    ("GET", "/docs", 200),
    ("GET", "/docs/style.css", 200),
    ("GET", "/openapi.json", 200),
    ("GET", "/api/state", 200),
    ("GET", "/scene/", 200),
    ("POST", "/api/stop", 200),
    ("POST", "/api/move", 422),
    ("GET", "/nowhere", 404),
    ("GET", "/api/nowhere", 404),
    ("GET", "/api/stop", 405),
    ("GET", "/failing", 500),
]


@pytest.fixture
def failing(make_app: Callable[..., FastAPI]) -> TestClient:
    app = make_app()

    async def fail() -> None:
        raise RuntimeError("inside knowledge")

    app.router.add_api_route("/failing", fail)
    app.router.routes.insert(0, app.router.routes.pop())
    return TestClient(app, base_url="http://127.0.0.1:8000")


@pytest.mark.parametrize(("method", "path", "status"), EVERY_KIND)
def test_every_response_is_hardened(
    failing: TestClient, method: str, path: str, status: int
) -> None:
    answer = failing.request(method, path)
    assert answer.status_code == status
    _assert_hardened(answer.headers)


def test_refused_and_too_large_are_hardened_too(client: TestClient) -> None:
    for answer in (
        client.get("/", headers={"host": "evil.example"}),
        client.post("/api/move", content=b"x" * (MAX_BODY + 1)),
    ):
        assert answer.status_code in (403, 413)
        _assert_hardened(answer.headers)


def _assert_hardened(headers: Any) -> None:
    assert headers["x-content-type-options"] == "nosniff"
    assert headers["referrer-policy"] == "no-referrer"
    assert headers["cross-origin-opener-policy"] == "same-origin"
    assert headers["cross-origin-resource-policy"] == "same-origin"
    assert headers["content-security-policy"]
    assert headers["cache-control"]
    assert "access-control-allow-origin" not in headers


def test_the_console_runs_its_own_scripts_only_and_is_framed_by_nobody(client: TestClient) -> None:
    policy = client.get("/").headers["content-security-policy"].split("; ")
    assert {"default-src 'self'", "script-src 'self'", "frame-ancestors 'none'"} <= set(policy)
    assert not [part for part in policy if "unsafe" in part or "*" in part]


def test_the_scene_keeps_its_own_policy(client: TestClient) -> None:
    assert client.get("/scene/").headers["content-security-policy"] == "sandbox"


def test_a_failure_tells_nothing_of_the_inside(failing: TestClient) -> None:
    answer = failing.get("/failing")
    assert answer.status_code == 500
    assert "inside" not in answer.text


@pytest.mark.parametrize("path", ["/api/move", "/api/ik", "/api/enable"])
def test_a_body_may_have_so_much_and_no_more(client: TestClient, machine: Any, path: str) -> None:
    fits = client.post(path, content=b" " * MAX_BODY)
    assert fits.status_code != 413
    machine.told.clear()
    announced = client.post(path, content=b" " * (MAX_BODY + 1))
    assert announced.status_code == 413
    assert "64 KiB" in announced.json()["detail"]

    def streamed() -> Any:
        for _ in range(MAX_BODY // 1024 + 1):
            yield b" " * 1024

    answer = client.post(path, content=streamed(), headers={"content-type": "application/json"})
    assert answer.status_code == 413
    assert machine.told == []


def test_opening_the_page_gives_a_session_once(client: TestClient) -> None:
    cookie = client.get("/").headers["set-cookie"]
    name, value = cookie.split(";")[0].split("=")
    assert name == "deltaviz_session_8000"
    assert len(value) >= 32
    assert "HttpOnly" in cookie
    assert "samesite=strict" in cookie.lower()
    assert "Path=/" in cookie
    assert "set-cookie" not in client.get("/").headers  # it brought its own
    assert "set-cookie" not in client.get("/api/state").headers


def test_sessions_differ(client: TestClient) -> None:
    def given() -> str:
        client.cookies.clear()
        return client.get("/").headers["set-cookie"].split(";")[0]

    assert len({given() for _ in range(20)}) == 20


def test_a_cookie_that_is_none_of_ours_is_replaced(client: TestClient) -> None:
    for value in ("short", "a" * 65, "a" * 31 + "!", ""):
        answer = client.get("/", headers={"cookie": f"deltaviz_session_8000={value}"})
        assert "set-cookie" in answer.headers
        client.cookies.clear()


def test_a_link_from_another_site_does_not_replace_the_session(client: TestClient) -> None:
    foreign = {
        "sec-fetch-site": "cross-site",
        "sec-fetch-mode": "navigate",
        "sec-fetch-dest": "document",
    }
    first = client.get("/", headers=foreign)  # SameSite=Strict: the cookie stayed behind
    assert "set-cookie" not in first.headers
    again = re.search(r"url=([^\"]+)", first.text)
    assert again
    second = client.get(again[1], headers=foreign)  # whatever a browser says of it: no loop
    assert "console" in second.text


@pytest.mark.parametrize(
    "path",
    [
        "/../secret.txt",
        "/..%2fsecret.txt",
        "/%2e%2e/secret.txt",
        "/%2e%2e%2fsecret.txt",
        "/..%5csecret.txt",
        "/....//secret.txt",
        "/static/../../secret.txt",
        "/main.js/../../secret.txt",
        "/secret.txt%00.js",
        "/%00",
        "/" + "a" * 5000,
        "/notes.txt",
        "/.hidden",
    ],
)
def test_nothing_outside_the_console_s_folder_is_served(client: TestClient, path: str) -> None:
    answer = client.get(path)
    assert answer.status_code == 404
    assert "secret" not in answer.text.replace("secret.txt", "")


def test_files_have_the_types_that_browsers_need(client: TestClient) -> None:
    assert client.get("/").headers["content-type"].startswith("text/html")
    assert client.get("/main.js").headers["content-type"].startswith("text/javascript")


def test_a_file_is_sent_again_only_when_it_changed(
    make_app: Callable[..., FastAPI], tmp_path: Path
) -> None:
    file = tmp_path / "main.js"
    file.write_text("export {};")
    client = TestClient(make_app(tmp_path), base_url="http://127.0.0.1:8000")
    tag = client.get("/main.js").headers["etag"]
    again = client.get("/main.js", headers={"if-none-match": tag})
    assert (again.status_code, again.content) == (304, b"")
    file.write_text("export const changed = true;")
    assert "changed" in client.get("/main.js", headers={"if-none-match": tag}).text
    file.unlink()
    assert client.get("/main.js").status_code == 404


def test_head_tells_the_size_and_sends_nothing(client: TestClient) -> None:
    head, get = client.head("/main.js"), client.get("/main.js")
    assert head.headers["content-length"] == get.headers["content-length"]
    assert head.content == b""


FOREIGN = re.compile(
    r"""(?:src|href|action|data)\s*=\s*["']?\s*(?:https?:)?//|url\(\s*["']?\w*:?//"""
)
IMPORTS = re.compile(r"""(?:import|from)\s*\(?\s*["'](?:https?:)?//""")


def test_no_page_loads_anything_from_another_host(client: TestClient) -> None:
    texts = {path: client.get(path).text for path in ("/", "/docs", "/docs/style.css")}
    for file in static_dir().rglob("*.*"):
        if file.suffix in (".html", ".js", ".css", ".svg"):
            texts[file.name] = file.read_text()
    for name, text in texts.items():
        assert not FOREIGN.search(text), name
        assert not IMPORTS.search(text), name


def test_the_documentation_tells_every_call(client: TestClient) -> None:
    page = client.get("/docs").text
    for path in client.get("/openapi.json").json()["paths"]:
        assert path in page
    assert "xyz_mm" in page
    assert "<script" not in page
