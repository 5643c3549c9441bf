"""`deltaviz ports`: the serial ports, which of them has a board, and which cannot be asked."""

from __future__ import annotations

import json
from collections.abc import Sequence
from typing import Any

from deltaviz.link.impression import Kind
from deltaviz.link.messages import PROTOCOL_VERSION
from deltaviz.link.ports import Port
from deltaviz.link.probe import Finding

NONE = "No serial port found. Plug the board in, or use the simulated one: --link sim://"


def text(ports: Sequence[Port], findings: dict[str, Finding]) -> str:
    if not ports:
        return NONE
    width = max(len(port.device) for port in ports)
    return "\n".join(
        f"{port.device:<{width}}  {port.description}" + _told(findings.get(port.device))
        for port in ports
    )


def as_json(ports: Sequence[Port], findings: dict[str, Finding]) -> str:
    return json.dumps({"ports": [_port(port, findings.get(port.device)) for port in ports]})


def _told(finding: Finding | None) -> str:
    return "" if finding is None else f"\n    {sentence(finding)}"


def sentence(finding: Finding) -> str:
    if finding.problem is not None:
        return finding.problem
    board = finding.board
    if board is None:
        return _NO_BOARD[finding.impression.kind].format(finding.impression.sample)
    if board.version != PROTOCOL_VERSION:
        return (
            f"A board that speaks version {board.version} of the protocol, deltaviz speaks "
            f"{PROTOCOL_VERSION}: update the older of the two."
        )
    robot = f"{board.joints} joints" if board.joints else "not configured yet"
    homed = ", homed" if board.homed else ""
    return f"Board '{board.board}', firmware {board.build}, {robot}{homed}."


_NO_BOARD = {
    Kind.NOTHING: "Nothing answers; a board there has no power, or another baud rate.",
    Kind.BOARD: "A board is heard, but it does not answer: does it hear this computer?",
    Kind.ECHO: "It sends back what it hears: no board.",
    Kind.TEXT: "It says '{}': no board. It was not written to.",
    Kind.NOISE: "It sends bytes that make no sense: another device, or another baud rate.",
}


def _port(port: Port, finding: Finding | None) -> dict[str, Any]:
    told: dict[str, Any] = {"id": port.id, "device": port.device, "what": port.description}
    if finding is None:
        return told
    board = finding.board
    return told | {
        "board": None
        if board is None
        else {
            "name": board.board,
            "build": board.build,
            "version": board.version,
            "joints": board.joints,
            "homed": board.homed,
        },
        "told": sentence(finding),
    }
