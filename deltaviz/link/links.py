"""The links that may be chosen, each by an id: no URL ever comes from a surface."""

from __future__ import annotations

import os
import re
from dataclasses import dataclass
from urllib.parse import urlsplit

from deltaviz.link.ports import list_ports, port_ids
from deltaviz.link.serial_link import serial_address
from deltaviz.link.transport import LinkError
from deltaviz.link.urls import SCHEMES


@dataclass(frozen=True, slots=True)
class Link:
    id: str
    url: str
    description: str


BUILT_IN = (
    Link("sim", "sim://", "Simulated board"),
    Link("emulate", "emulate://", "Emulated board: the real firmware"),
)
_RESERVED = tuple(SCHEMES)
_ID = re.compile(r"[a-z0-9][a-z0-9_-]{0,63}")


def is_link_id(text: str) -> bool:
    """Whether it may be one; no URL and no path is."""
    return _ID.fullmatch(text) is not None


class Links:
    """`given` is the one that the command line names; the serial ports are those of the moment."""

    def __init__(self, url: str) -> None:
        """Raises LinkError for a URL that is none."""
        self.given = _given(url)

    def list(self) -> tuple[Link, ...]:
        """What is built in, then what the command line gave, then the serial ports."""
        given = self.given
        links = {link.id: link for link in BUILT_IN}
        links[given.id] = Link(given.id, given.url, self._description())
        for port in list_ports(_RESERVED):
            if not _same_device(port.device, given.url):
                links.setdefault(port.id, Link(port.id, port.device, port.description))
        return tuple(links.values())

    def url(self, id_: str) -> str:
        """Raises LinkError when there is none, or no more."""
        links = {link.id: link for link in self.list()}
        if id_ not in links:
            raise LinkError(
                f"There is no link '{id_}' (any more); there is: {', '.join(links)}. Plug the "
                "board in, or choose another link in Set-up, then connect."
            )
        return links[id_].url

    def _description(self) -> str:
        """A port of this computer is called what it is, if it is plugged in."""
        for port in list_ports():
            if _same_device(port.device, self.given.url):
                return port.description
        return self.given.description


def _given(url: str) -> Link:
    scheme = urlsplit(url).scheme
    for link in BUILT_IN:
        if link.id == scheme:
            return Link(link.id, url, link.description)
    if scheme in SCHEMES:
        return Link(scheme, url, url)
    address = serial_address(url)
    if address.is_port:
        (id_,) = port_ids([_short(address.target)], _RESERVED)
        return Link(id_, url, f"Serial port {address.target}")
    return Link(scheme, url, url)


def _short(device: str) -> str:
    """A name made to be stable, such as those in /dev/serial/by-id, is known by its end."""
    below = device.removeprefix("/dev/")
    return below if below != device and below.count("/") < 2 else os.path.basename(device)


def _same_device(device: str, url: str) -> bool:
    if urlsplit(url).scheme in SCHEMES:
        return False
    address = serial_address(url)
    return address.is_port and os.path.realpath(address.target) == os.path.realpath(device)
