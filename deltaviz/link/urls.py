"""Links by URL. URLs come from the command line only: some of pyserial's forms write files."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, NamedTuple
from urllib.parse import urlsplit

from deltaviz.link.configuration import configure_from
from deltaviz.link.emulator.transport import EmulatedTransport, check_emulator
from deltaviz.link.serial_link import open_serial, serial_address
from deltaviz.link.sim import SimTransport, starts_homed
from deltaviz.link.tap import Tap, untapped
from deltaviz.link.transport import LinkError, Transport

if TYPE_CHECKING:
    from deltaviz.robots import Robot

__all__ = ["LinkError", "check_link", "open_link"]


class Scheme(NamedTuple):
    """`check` raises the LinkError that `open` would raise for a wrong URL, and opens nothing."""

    check: Callable[[str], object]
    open: Callable[[str, Robot, Tap], Transport]


def _open_sim(url: str, robot: Robot, tap: Tap) -> Transport:
    return SimTransport.start(homed=starts_homed(url), tap=tap)


def _open_serial(url: str, robot: Robot, tap: Tap) -> Transport:
    return open_serial(url, tap=tap)


def _open_emulator(url: str, robot: Robot, tap: Tap) -> Transport:
    check_emulator(url)
    return EmulatedTransport.start(configure_from(robot), tap=tap)


SCHEMES: dict[str, Scheme] = {
    "sim": Scheme(starts_homed, _open_sim),
    "emulate": Scheme(check_emulator, _open_emulator),
}
OTHERS = Scheme(serial_address, _open_serial)  # whatever pyserial opens


def open_link(url: str, robot: Robot, tap: Tap = untapped) -> Transport:
    """Opens the link to a board that will drive `robot`; it may take seconds.

    Raises LinkError for a URL that is malformed or of a kind that is not there, before anything
    is started, and for a link that cannot be opened.
    """
    return _scheme(url).open(url, robot, tap)


def check_link(url: str) -> None:
    """Raises the LinkError that `open_link` would raise for a wrong URL, and opens nothing."""
    _scheme(url).check(url)


def _scheme(url: str) -> Scheme:
    try:
        scheme = urlsplit(url).scheme
    except ValueError as error:
        raise LinkError(f"{url!r} is not a link: {error}. Try sim://") from None
    return SCHEMES.get(scheme, OTHERS)
