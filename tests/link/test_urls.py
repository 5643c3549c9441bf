"""Links by URL, and the list of ports."""

from __future__ import annotations

import re
from types import SimpleNamespace

import pytest

from deltaviz import load_robot
from deltaviz.link import sim, urls
from deltaviz.link.ports import list_links, list_ports
from deltaviz.link.urls import LinkError, check_link, open_link


@pytest.fixture
def started(monkeypatch):
    starts: list[bool] = []
    monkeypatch.setattr(sim.SimTransport, "start", lambda *, homed: starts.append(homed))
    return starts


@pytest.mark.parametrize(
    ("url", "homed"),
    [("sim://", True), ("sim://?homed=0", False), ("sim://?homed=1", True), ("SIM://", True)],
)
def test_the_simulated_board(started, url, homed):
    open_link(url, load_robot("stm32"))
    assert started == [homed]


@pytest.mark.parametrize(
    ("url", "says"),
    [
        ("sim://?homed=2", "may be 0 or 1"),
        ("sim://?homed=", "may be 0 or 1"),
        ("sim://?home=0", "no option 'home'"),
        ("sim://elsewhere", "nothing may stand"),
        ("sim:///path", "nothing may stand"),
        ("emulate://", "not available yet"),
        ("serial:///dev/ttyUSB0?baud=921600", "not available yet"),
        ("socket://localhost:1234", "not available yet"),
        ("spy:///dev/ttyUSB0?file=/tmp/written", "not available yet"),
        ("/dev/ttyUSB0", "not available yet"),
        ("", "not a link"),
        ("sim://[", "not a link"),
    ],
)
def test_what_is_not_there_is_refused_and_says_what_is(started, url, says):
    for attempt in (check_link, lambda url: open_link(url, load_robot("stm32"))):
        with pytest.raises(LinkError, match=re.escape(says)) as refused:
            attempt(url)
        assert "sim://" in str(refused.value)
    assert started == []


def test_ports_by_ids_that_are_safe_in_a_url(monkeypatch):
    found = [
        SimpleNamespace(device="/dev/ttyUSB1", description="n/a"),
        SimpleNamespace(device="/dev/ttyUSB0", description="CP2102 USB to UART"),
        SimpleNamespace(device="/dev/ttyusb0", description=None),
        SimpleNamespace(device="/dev/sim", description="?"),
        SimpleNamespace(device="/dev/" + "x" * 200, description="long"),
        SimpleNamespace(device="/dev/…", description="no letters"),
    ]
    monkeypatch.setattr("serial.tools.list_ports.comports", lambda: found)
    ports = list_ports()
    ids = [port.id for port in ports]
    assert len(set(ids)) == len(found)
    assert all(re.fullmatch(r"[a-z0-9][a-z0-9_-]{0,63}", id_) for id_ in ids)
    assert "sim" not in ids
    by_device = {port.device: port for port in ports}
    assert by_device["/dev/ttyUSB0"].description == "CP2102 USB to UART"
    assert by_device["/dev/ttyUSB1"].description == "Serial port ttyUSB1"


def test_the_simulated_board_is_the_first_of_the_links(monkeypatch):
    monkeypatch.setattr("serial.tools.list_ports.comports", list)
    (only,) = list_links()
    assert (only.id, only.device) == ("sim", "sim://")
    check_link(only.device)
    assert urls.LinkError is LinkError
