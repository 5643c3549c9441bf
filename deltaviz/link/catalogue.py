"""All that can be wrong with a link, each with the sentence that a person is told: for the docs."""

from __future__ import annotations

import errno
import os
from dataclasses import replace
from typing import Any

from deltaviz.link import problems
from deltaviz.link.configuration import configure_from
from deltaviz.link.impression import Impression, Kind
from deltaviz.link.messages import PROTOCOL_VERSION
from deltaviz.link.objections import objection
from deltaviz.link.port_trouble import trouble
from deltaviz.link.rules import TICK_HZ
from deltaviz.link.serial_link import broke

_PORT = "/dev/ttyBOARD"


def _port(number: int) -> str:
    return trouble(_PORT, OSError(number, os.strerror(number)))


def _refused(*, tick_hz: int = TICK_HZ, **changes: Any) -> str:
    from deltaviz.robots import load_robot

    return objection(replace(configure_from(load_robot("stm32")), **changes), tick_hz=tick_hz)


def catalogue() -> tuple[tuple[str, str], ...]:
    """Case and sentence."""
    return (
        ("the port is not there", _port(errno.ENOENT)),
        ("it is in use", _port(errno.EBUSY)),
        ("permission is missing", trouble(_PORT, OSError(errno.EACCES, ""), group="dialout")),
        ("it is no serial port", _port(errno.ENOTTY)),
        ("it fails", _port(errno.EIO)),
        ("nothing answers", problems.no_answer(Impression())),
        ("a device that prints text", problems.strange(Impression(Kind.TEXT, "Grbl 1.1h")) or ""),
        ("a device that echoes", problems.strange(Impression(Kind.ECHO)) or ""),
        ("another baud rate", problems.strange(Impression(Kind.NOISE)) or ""),
        ("a board that does not hear us", problems.no_answer(Impression(Kind.BOARD))),
        ("a newer board", problems.other_version(PROTOCOL_VERSION + 1)),
        ("an older board", problems.other_version(PROTOCOL_VERSION - 1)),
        ("a board for another number of joints", problems.other_joints(2, 3)),
        ("a board that is on, for another robot", problems.set_up_for_another("trossen")),
        ("the same, of a robot nobody knows", problems.set_up_for_another(None)),
        ("another configuration came back", problems.other_configuration()),
        ("a command is not answered", problems.unanswered("enable")),
        ("the board restarts", problems.restarted()),
        ("the board falls silent", problems.silent()),
        ("the cable is pulled", broke(_PORT, "it was unplugged, or has lost its power")),
        ("a robot file that the board cannot follow", _refused(velocity=(10_000_000,) * 3)),
        ("a board whose clock does not come up", _refused(tick_hz=10_000)),
    )
