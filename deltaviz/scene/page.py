"""viser's page as we serve it: our style in it, and a policy that lets nothing else run."""

from __future__ import annotations

import base64
import hashlib
from dataclasses import dataclass
from html.parser import HTMLParser
from pathlib import Path

import numpy as np
import viser
import zstandard

STYLE = """
.mantine-Notifications-root{display:none!important}
label,.mantine-Slider-markLabel{color:#495057!important}
[data-mantine-color-scheme="dark"] label,
[data-mantine-color-scheme="dark"] .mantine-Slider-markLabel{color:#b4bac1!important}
.mantine-NumberInput-root{pointer-events:none}
@media (max-width:36em){
.mantine-Paper-root[style*="position: fixed"]{display:none!important}
}
"""
"""Labels dark enough to read; no pop-ups; number boxes only show (half-typed numbers would be
sent); on a phone no sheet over the robot."""

_DARK = "html,body{background:#141414}"  # until viser's own theme arrives

_ALPHABET = "".join(c for c in map(chr, range(0x21, 0x7F)) if c not in "\"&<>'`")


@dataclass(frozen=True)
class Page:
    """`light` and `dark` are whole HTML documents; `policy` is their Content-Security-Policy."""

    light: str
    dark: str
    policy: str


class PageFormatError(RuntimeError):
    """The installed viser's page is not put together as this program knows it."""


def load_page() -> Page:
    """Read the packaged client. Raises PageFormatError when it is not of the known form."""
    path = Path(viser.__file__).parent / "client" / "build" / "index.html"
    html = path.read_bytes().decode()
    if html.count("</head>") != 1:
        raise PageFormatError(f"{path}: one </head> was expected, found {html.count('</head>')}")

    def styled(style: str) -> str:
        return html.replace("</head>", f"<style>{style}</style></head>")

    return Page(
        light=styled(STYLE), dark=styled(STYLE + _DARK), policy=content_policy(scripts_of(html))
    )


def content_policy(scripts: list[bytes]) -> str:
    """The policy under which only `scripts` run."""
    hashes = " ".join(
        f"'sha256-{base64.b64encode(hashlib.sha256(script).digest()).decode()}'"
        for script in scripts
    )
    return (
        "default-src 'none'; "
        f"script-src {hashes} 'wasm-unsafe-eval'; "
        "style-src 'unsafe-inline'; img-src 'self' data: blob:; "
        "connect-src 'self' data: blob:; worker-src blob:; font-src data:; "
        "frame-ancestors 'self'; base-uri 'none'; form-action 'none'"
    )


def scripts_of(html: str) -> list[bytes]:
    """The page's scripts: the inline loader, and the program that it unpacks from its own
    attribute (base 88 over zstd: style, then script) and inserts."""
    parser = _Loader()
    parser.feed(html)
    if len(parser.loaders) != 1:
        raise PageFormatError(f"one inline script was expected, found {len(parser.loaders)}")
    attributes, text = parser.loaders[0]
    try:
        style_size, script_size = int(attributes["data-ss"]), int(attributes["data-cs"])
        content = zstandard.ZstdDecompressor().decompress(
            _from_base88(attributes["data-p"]), max_output_size=style_size + script_size
        )
    except (KeyError, ValueError, zstandard.ZstdError) as error:
        raise PageFormatError(f"the packed program cannot be read: {error}") from error
    return [text.encode(), content[style_size : style_size + script_size]]


class _Loader(HTMLParser):
    """Collects the page's script elements: (attributes, text)."""

    def __init__(self) -> None:
        super().__init__(convert_charrefs=False)
        self.loaders: list[tuple[dict[str, str], str]] = []
        self._inside = False

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        if tag == "script":
            self._inside = True
            self.loaders.append(({name: value or "" for name, value in attrs}, ""))

    def handle_endtag(self, tag: str) -> None:
        self._inside = self._inside and tag != "script"

    def handle_data(self, data: str) -> None:
        if self._inside:
            attributes, text = self.loaders[-1]
            self.loaders[-1] = (attributes, text + data)


def _from_base88(text: str) -> bytes:
    """Five characters make four bytes, big-endian; a last group of k makes k - 1."""
    digits = np.zeros(128, dtype=np.uint64)
    digits[[ord(c) for c in _ALPHABET]] = np.arange(88)
    values = digits[np.frombuffer(text.encode("ascii"), dtype=np.uint8)]
    whole = len(values) // 5 * 5
    groups = values[:whole].reshape(-1, 5) @ (88 ** np.arange(4, -1, -1)).astype(np.uint64)
    tail = 0
    for digit in values[whole:]:
        tail = tail * 88 + int(digit)
    rest = len(values) - whole
    return groups.astype(">u4").tobytes() + (tail.to_bytes(rest - 1, "big") if rest > 1 else b"")
