"""The links that can be chosen, by ids that are safe in a URL."""

from __future__ import annotations

import re
from pathlib import Path
from types import SimpleNamespace

import pytest

from deltaviz.link.links import Links
from deltaviz.link.ports import list_ports
from deltaviz.link.transport import LinkError

FOUND = [
    SimpleNamespace(device="/dev/ttyUSB1", description="n/a"),
    SimpleNamespace(device="/dev/ttyUSB0", description="CP2102 USB to UART"),
    SimpleNamespace(device="/dev/ttyusb0", description=None),
    SimpleNamespace(device="/dev/sim", description="?"),
    SimpleNamespace(device="/dev/" + "x" * 200, description="long"),
    SimpleNamespace(device="/dev/…", description="no letters"),
]


BUILT_IN = [("sim", "sim://"), ("emulate", "emulate://")]


@pytest.fixture
def plugged_in(monkeypatch):
    found = list(FOUND)
    monkeypatch.setattr("serial.tools.list_ports.comports", lambda: found)
    return found


def test_ports_have_ids_that_are_safe_in_a_url(plugged_in):
    ports = list_ports(["sim"])
    ids = [port.id for port in ports]
    assert len(set(ids)) == len(FOUND)
    assert all(re.fullmatch(r"[a-z0-9][a-z0-9_-]{0,63}", id_) for id_ in ids)
    assert "sim" not in ids
    by_device = {port.device: port for port in ports}
    assert by_device["/dev/ttyUSB0"].description == "CP2102 USB to UART (ttyUSB0)"
    assert by_device["/dev/ttyUSB1"].description == "Serial port ttyUSB1"


def test_the_boards_without_a_port_come_first_and_a_plugged_in_port_is_listed(plugged_in):
    links = Links("sim://").list()
    assert [(link.id, link.url) for link in links[:2]] == BUILT_IN
    assert len(links) == len(BUILT_IN) + len(FOUND)
    assert Links("sim://").url("ttyusb1") == "/dev/ttyUSB1"


def test_a_port_that_was_unplugged_is_no_choice_any_more(plugged_in):
    links = Links("sim://")
    plugged_in.clear()
    with pytest.raises(LinkError, match=r"no link 'ttyusb1' .*there is: sim, emulate\. Plug"):
        links.url("ttyusb1")


def test_what_the_command_line_gave_stays_a_choice_with_its_options(plugged_in):
    url = "serial:///dev/ttyUSB1?baud=115200"
    links = Links(url)
    assert links.given.id == "ttyusb1"
    assert links.url("ttyusb1") == url
    assert len(links.list()) == len(BUILT_IN) + len(FOUND), "it is not there twice"
    plugged_in.clear()
    assert [(x.id, x.url) for x in links.list()] == [*BUILT_IN, ("ttyusb1", url)]


def test_a_port_by_another_name_is_the_same_port(plugged_in, tmp_path: Path):
    device = tmp_path / "device"
    device.touch()
    name = tmp_path / "by-id"
    name.symlink_to(device)
    plugged_in[:] = [SimpleNamespace(device=str(device), description="A board")]
    links = Links(str(name))
    assert [link.description for link in links.list()[2:]] == ["A board (device)"]
    assert links.url(links.given.id) == str(name)


@pytest.mark.parametrize(
    ("url", "id_"),
    [
        ("/dev/ttyACM3", "ttyacm3"),
        ("/dev/pts/7", "pts-7"),
        ("/dev/serial/by-id/usb-1a86_CH340-if00", "usb-1a86-ch340-if00"),
        ("./here/ttyBOARD", "ttyboard"),
        ("COM7", "com7"),
    ],
)
def test_a_port_goes_by_the_end_of_its_name(plugged_in, url, id_):
    assert Links(url).given.id == id_


@pytest.mark.parametrize(
    ("url", "id_"),
    [("sim://?homed=0", "sim"), ("socket://h:1", "socket"), ("rfc2217://h:1", "rfc2217")],
)
def test_other_links_go_by_what_they_are(plugged_in, url, id_):
    links = Links(url)
    assert links.given.id == id_
    assert links.url(id_) == url
    assert len({link.id for link in links.list()}) == len(links.list())


def test_an_id_is_no_way_to_a_url(plugged_in):
    for id_ in ("/dev/ttyUSB0", "spy:///dev/ttyUSB0?file=/tmp/x", "../../etc", "serial", ""):
        with pytest.raises(LinkError):
            Links("sim://").url(id_)
