"""Links by URL. URLs come from the command line only: some of pyserial's forms write files."""

from __future__ import annotations

from typing import TYPE_CHECKING
from urllib.parse import SplitResult, parse_qsl, urlsplit

from deltaviz.link.sim import SimTransport
from deltaviz.link.transport import LinkError, Transport

if TYPE_CHECKING:
    from deltaviz.robots import Robot

__all__ = ["LinkError", "check_link", "open_link"]


def open_link(url: str, robot: Robot) -> Transport:
    """Opens the link to a board that will drive `robot`.

    Raises LinkError for a URL that is malformed or of a kind that is not there, before anything
    is started.
    """
    homed = _sim_homed(url)
    return SimTransport.start(homed=homed)


def check_link(url: str) -> None:
    """Raises the LinkError that `open_link` would raise for this URL, and opens nothing."""
    _sim_homed(url)


def _sim_homed(url: str) -> bool:
    """Whether the simulated board of this URL starts enabled and homed."""
    try:
        parts = urlsplit(url)
    except ValueError as error:
        raise LinkError(f"{url!r} is not a link: {error}. Try sim://") from None
    if parts.scheme != "sim":
        raise LinkError(_not_there(url, parts.scheme))
    if parts.netloc or parts.path or parts.fragment:
        raise LinkError(f"{url!r}: nothing may stand between sim:// and a question mark")
    return _homed_option(url, parts)


def _homed_option(url: str, parts: SplitResult) -> bool:
    homed = True
    for key, value in parse_qsl(parts.query, keep_blank_values=True):
        if key != "homed":
            raise LinkError(f"{url!r}: sim:// has no option {key!r}; it has homed=0 or homed=1")
        if value not in ("0", "1"):
            raise LinkError(f"{url!r}: homed is {value!r}; it may be 0 or 1")
        homed = value == "1"
    return homed


def _not_there(url: str, scheme: str) -> str:
    if scheme == "emulate":
        return "The emulated board (emulate://) is not available yet. Use sim://"
    if scheme:
        return f"{url!r}: links to serial boards are not available yet. Use sim://"
    return (
        f"{url!r} is not a link that can be opened: serial ports are not available yet. Use sim://"
    )
