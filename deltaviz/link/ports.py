"""The links that may be chosen by id: serial ports with what they are, and the simulated board."""

from __future__ import annotations

import re
from dataclasses import dataclass

SIM = "sim"


@dataclass(frozen=True, slots=True)
class Port:
    """`id` is safe in a URL and names the port as long as it stays where it is plugged in."""

    id: str
    device: str
    description: str


def list_ports() -> tuple[Port, ...]:
    """The serial ports of this computer, by device."""
    from serial.tools.list_ports import comports  # slow to load

    found = sorted(comports(), key=lambda port: port.device)
    ids = _ids([port.device for port in found])
    return tuple(
        Port(id=id_, device=port.device, description=_description(port.description, port.device))
        for id_, port in zip(ids, found, strict=True)
    )


def list_links() -> tuple[Port, ...]:
    """What a link may be chosen from: the simulated board first, then the serial ports."""
    return (Port(id=SIM, device="sim://", description="Simulated board"), *list_ports())


def _description(text: str | None, device: str) -> str:
    return text if text and text != "n/a" else f"Serial port {device.rsplit('/', 1)[-1]}"


def _ids(devices: list[str]) -> list[str]:
    """Lower-case letters, digits and dashes, at most 64; a number behind those that would clash."""
    ids: list[str] = []
    for device in devices:
        name = re.sub(r"[^a-z0-9]+", "-", device.removeprefix("/dev/").lower()).strip("-")[:60]
        id_, number = name or "port", 2
        while id_ in (*ids, SIM):
            id_, number = f"{name or 'port'}-{number}", number + 1
        ids.append(id_)
    return ids
