"""The web application: one origin for the console, the API, the live socket and the scene."""

from __future__ import annotations

from collections.abc import Mapping
from importlib.metadata import version
from pathlib import Path

from fastapi import FastAPI, Request, Response
from fastapi.exceptions import RequestValidationError
from fastapi.responses import HTMLResponse, JSONResponse, PlainTextResponse
from starlette.exceptions import HTTPException as StarletteHTTPException

from deltaviz.machine.port import MachinePort
from deltaviz.web import docs, models
from deltaviz.web.api import make_api
from deltaviz.web.body_limit import BodyLimit
from deltaviz.web.faults import sentence
from deltaviz.web.origin import OriginGuard
from deltaviz.web.scene_port import ScenePort
from deltaviz.web.session import Sessions
from deltaviz.web.shield import Shield
from deltaviz.web.socket import Pages
from deltaviz.web.static_files import StaticFiles

_DESCRIPTION = (
    "Lengths in mm, angles in degrees. Calls that move the robot answer 409 with the reason when "
    "another holds control or the mode does not allow it, and 422 when a value is malformed or "
    "breaks a limit. Stop and E-stop are taken from anyone, always. Live state and jogging go "
    "over the websocket /ws: JSON both ways, and every message has a type."
)


def create_app(
    *,
    machine: MachinePort,
    scene: ScenePort,
    allowed_hosts: frozenset[str],
    port: int,
    static_dir: Path,
) -> FastAPI:
    """The application for one machine and its scene.

    `allowed_hosts` are the values of Host that mean us (`origin.allowed_hosts`), `port` names
    the session cookie, `static_dir` holds the console.
    """
    app = FastAPI(
        title="deltaviz",
        version=version("deltaviz"),
        description=_DESCRIPTION,
        docs_url=None,
        redoc_url=None,
        redirect_slashes=False,
    )
    sessions = app.state.sessions = Sessions(port=port)
    pages = Pages(machine=machine, sessions=sessions, scene=scene)

    def holds_control(session: str) -> bool:
        return machine.snapshot.holder == session

    app.include_router(make_api(machine))
    app.include_router(scene.router(session_of=sessions.of, holds_control=holds_control))
    app.add_api_websocket_route("/ws", pages.serve)
    _add_docs(app)
    _add_console(app, sessions=sessions, files=StaticFiles(static_dir))

    app.add_exception_handler(RequestValidationError, _malformed)
    app.add_exception_handler(StarletteHTTPException, _failed)
    app.add_middleware(BodyLimit)  # the last one added is the outermost
    app.add_middleware(OriginGuard, allowed=allowed_hosts)
    app.add_middleware(Shield)
    return app


def _add_docs(app: FastAPI) -> None:
    @app.get("/docs", include_in_schema=False)
    async def documentation(request: Request) -> HTMLResponse:
        return HTMLResponse(docs.page(app.openapi(), base=str(request.base_url).rstrip("/")))

    @app.get("/docs/style.css", include_in_schema=False)
    async def style() -> Response:
        return PlainTextResponse(docs.STYLE, media_type="text/css")


def _add_console(app: FastAPI, *, sessions: Sessions, files: StaticFiles) -> None:
    async def console(request: Request) -> Response:
        if _comes_from_elsewhere(request):
            return HTMLResponse(_BOUNCE)
        response = files.answer(request, "/index.html")
        sessions.welcome(request, response)
        return response

    for path in ("/", "/index.html"):
        app.add_api_route(path, console, methods=["GET", "HEAD"], include_in_schema=False)
    # Not mounted: a mount at "/" would answer 404 where a call with another method is 405.
    app.router.default = files


# A page opened by a link of another site comes without its SameSite=Strict cookie; a new
# session would take the place of the one that this browser's other pages go by. This page asks
# again, as ourselves, and then the cookie comes along.
_BOUNCE = (
    '<!doctype html><title>deltaviz</title><meta http-equiv="refresh" content="0;url=/?opened">'
)


def _comes_from_elsewhere(request: Request) -> bool:
    return request.headers.get("sec-fetch-site") == "cross-site" and not request.url.query


async def _malformed(request: Request, error: Exception) -> JSONResponse:
    assert isinstance(error, RequestValidationError)
    return JSONResponse({"detail": sentence(error.errors(), tags=models.TAGS)}, status_code=422)


_UNREADABLE = 400  # FastAPI's answer when the body cannot even be read as JSON


async def _failed(request: Request, error: Exception) -> JSONResponse:
    assert isinstance(error, StarletteHTTPException)
    status, detail = error.status_code, str(error.detail)
    headers: Mapping[str, str] | None = error.headers
    if status == _UNREADABLE:
        status, detail = 422, "This is no JSON that can be read."
    elif status in (404, 405):
        detail = f"{request.method} {request.url.path[:80]} is nothing here; see /docs."
    return JSONResponse({"detail": detail}, status_code=status, headers=headers)
