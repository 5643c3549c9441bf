"""The console's files: in the installed package, or beside it in a checkout."""

from __future__ import annotations

from pathlib import Path

from starlette.exceptions import HTTPException
from starlette.requests import Request
from starlette.responses import Response
from starlette.types import Receive, Scope, Send

# Not asked of the system: some answer types under which browsers run no script.
MEDIA_TYPES = {
    ".html": "text/html",
    ".js": "text/javascript",
    ".css": "text/css",
    ".svg": "image/svg+xml",
    ".png": "image/png",
    ".ico": "image/x-icon",
    ".woff2": "font/woff2",
}


def static_dir() -> Path:
    """The folder of the console. Raises FileNotFoundError when it is not installed."""
    package = Path(__file__).parents[1]
    for folder in (package / "_static", package.parent / "static"):
        if (folder / "index.html").is_file():
            return folder
    raise FileNotFoundError("the page's files are not installed; install deltaviz again")


class StaticFiles:
    """Serves the files that the folder has at the start, by their names and no others.

    They are few and small, so they are read in the event loop: the way through a thread took
    ten times as long, forty times a page.
    """

    def __init__(self, folder: Path) -> None:
        self._files = {
            f"/{file.relative_to(folder).as_posix()}": file
            for file in folder.rglob("*")
            if file.suffix in MEDIA_TYPES and file.is_file()
        }

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        if scope["type"] == "websocket":
            await send({"type": "websocket.close", "code": 1000})
            return
        response = self.answer(Request(scope), scope["path"])
        await response(scope, receive, send)

    def answer(self, request: Request, path: str) -> Response:
        """The file, or 304 when the browser has it. Raises HTTPException 404 and 405."""
        file = self._files.get(path)
        if file is None:
            raise HTTPException(404)
        if request.method not in ("GET", "HEAD"):
            raise HTTPException(405, headers={"Allow": "GET, HEAD"})
        try:
            status = file.stat()
            tag = f'"{status.st_mtime_ns:x}-{status.st_size:x}"'
            if request.headers.get("if-none-match") == tag:
                return Response(status_code=304, headers={"ETag": tag})
            content = file.read_bytes()
        except OSError:
            raise HTTPException(404) from None
        return Response(content, media_type=MEDIA_TYPES[file.suffix], headers={"ETag": tag})
