"""The serial ports of this computer, with what they are."""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Port:
    """`id` is safe in a URL and names the port as long as it stays where it is plugged in."""

    id: str
    device: str
    description: str


def list_ports(reserved: Iterable[str] = ()) -> tuple[Port, ...]:
    """By device. No id is one of those `reserved`."""
    from serial.tools.list_ports import comports  # slow to load

    found = sorted(comports(), key=lambda port: port.device)
    ids = port_ids([port.device for port in found], reserved)
    return tuple(
        Port(id=id_, device=port.device, description=_description(port.description, port.device))
        for id_, port in zip(ids, found, strict=True)
    )


def port_ids(devices: Iterable[str], reserved: Iterable[str] = ()) -> list[str]:
    """Lower-case letters, digits and dashes, at most 64; a number behind those that would clash."""
    ids: list[str] = []
    for device in devices:
        name = re.sub(r"[^a-z0-9]+", "-", device.removeprefix("/dev/").lower()).strip("-")[:60]
        id_, number = name or "port", 2
        while id_ in (*ids, *reserved):
            id_, number = f"{name or 'port'}-{number}", number + 1
        ids.append(id_)
    return ids


def _description(text: str | None, device: str) -> str:
    """Two adapters of one kind are told apart by their device."""
    name = device.rsplit("/", 1)[-1]
    return f"{text} ({name})" if text and text not in ("n/a", name) else f"Serial port {name}"
