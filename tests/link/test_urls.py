"""Links by URL: what each of them opens, and what is wrong with the others."""

from __future__ import annotations

import re

import pytest

from deltaviz import load_robot
from deltaviz.link import sim
from deltaviz.link.serial_link import BAUD, SerialAddress, serial_address
from deltaviz.link.urls import LinkError, check_link, open_link


@pytest.fixture
def started(monkeypatch):
    starts: list[bool] = []
    monkeypatch.setattr(sim.SimTransport, "start", lambda *, homed, tap: starts.append(homed))
    return starts


@pytest.mark.parametrize(
    ("url", "homed"),
    [("sim://", True), ("sim://?homed=0", False), ("sim://?homed=1", True), ("SIM://", True)],
)
def test_the_simulated_board(started, url, homed):
    open_link(url, load_robot("stm32"))
    assert started == [homed]


@pytest.mark.parametrize(
    ("url", "target", "baud"),
    [
        ("/dev/ttyUSB0", "/dev/ttyUSB0", BAUD),
        ("./linked/port", "./linked/port", BAUD),
        ("COM3", "COM3", BAUD),
        ("serial:///dev/ttyUSB0", "/dev/ttyUSB0", BAUD),
        ("serial:///dev/ttyUSB0?baud=115200", "/dev/ttyUSB0", 115200),
        ("serial://COM3?baud=115200", "COM3", 115200),
        ("socket://localhost:1234", "socket://localhost:1234", BAUD),
        ("rfc2217://host:2217?baud=115200", "rfc2217://host:2217", 115200),
        ("rfc2217://h:1?timeout=2&baud=9600&logging=info", "rfc2217://h:1?timeout=2&logging=info",
         9600),
        ("spy:///dev/ttyUSB0?file=/tmp/seen", "spy:///dev/ttyUSB0?file=/tmp/seen", BAUD),
        ("loop://", "loop://", BAUD),
        ("hwgrep://0483:5740", "hwgrep://0483:5740", BAUD),
    ],
)  # fmt: skip
def test_what_pyserial_opens(url, target, baud):
    assert serial_address(url) == SerialAddress(target, baud)
    check_link(url)


@pytest.mark.parametrize(
    ("url", "says"),
    [
        ("sim://?homed=2", "may be 0 or 1"),
        ("sim://?homed=", "may be 0 or 1"),
        ("sim://?home=0", "no option 'home'"),
        ("sim://elsewhere", "nothing may stand"),
        ("sim:///path", "nothing may stand"),
        ("serial:///dev/ttyUSB0?speed=9600", "no option 'speed'"),
        ("serial:///dev/ttyUSB0?baud=fast", "baud is 'fast'"),
        ("serial:///dev/ttyUSB0?baud=0", "a number from 1"),
        ("serial:///dev/ttyUSB0?baud=-9600", "a number from 1"),
        ("socket://h:1?baud=99999999999", "a number from 1"),
        ("serial://", "is not a link"),
        ("serial://ttyUSB0", "is not a link"),
        ("ttyUSB0", "is not a link"),
        ("gopher://x", "is not a link"),
        ("../x://y", "is not a link"),
        ("", "is not a link"),
        ("sim://[", "is not a link"),
    ],
)
def test_what_is_no_link_is_refused_and_says_what_is(started, url, says):
    for attempt in (check_link, lambda url: open_link(url, load_robot("stm32"))):
        with pytest.raises(LinkError, match=re.escape(says)):
            attempt(url)
    assert started == []
