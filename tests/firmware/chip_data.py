"""What others have published of the STM32F407: registers and fields from the SVD file of its near
relative STM32F429 (in pyocd), those of the processor's core from that of another chip with a
Cortex-M4F, interrupts, memories and pins' functions from modm-devices.
"""

from __future__ import annotations

import xml.etree.ElementTree as ET
import zipfile
from functools import cache
from importlib.resources import files


@cache
def _svd(name: str) -> dict[str, ET.Element]:
    """Peripherals by name."""
    path = files("pyocd") / "debug" / "svd" / "svd_data.zip"
    with path.open("rb") as packed, zipfile.ZipFile(packed) as archive:
        root = ET.fromstring(archive.read(name))
    return {p.findtext("name", ""): p for p in root.iterfind("peripherals/peripheral")}


def _number(element: ET.Element, name: str) -> int:
    return int(element.findtext(name, ""), 0)


@cache
def registers(peripheral: str) -> dict[str, tuple[int, dict[str, int]]]:
    """Of one peripheral, by name: the address, and a mask for each field."""
    if peripheral == "SCB":
        peripherals, peripheral = _svd("MK64F12.svd"), "SystemControl"
    else:
        peripherals = _svd("STM32F429x.svd")
    element = peripherals[peripheral]
    template = peripherals[element.get("derivedFrom", peripheral)]
    base = _number(element, "baseAddress")
    return {
        register.findtext("name", "").removesuffix("_Output"): (
            base + _number(register, "addressOffset"),
            {
                field.findtext("name", ""): (1 << _number(field, "bitWidth")) - 1
                << _number(field, "bitOffset")
                for field in register.iterfind("fields/field")
            },
        )
        for register in template.iterfind("registers/register")
    }


@cache
def _modm() -> ET.Element:
    devices = files("modm_devices") / "resources" / "devices" / "stm32"
    return ET.fromstring((devices / "stm32f4-05_07_15_17.xml").read_bytes())


def _is_ours(element: ET.Element) -> bool:
    """What is said of some devices only, of the STM32F407 (with 100 pins: V)."""
    names, pins = element.get("device-name", "07"), element.get("device-pin", "v")
    return "07" in names.split("|") and "v" in pins.split("|")


@cache
def interrupts() -> dict[str, int]:
    return {
        vector.get("name", ""): int(vector.get("position", ""))
        for vector in _modm().iter("vector")
        if _is_ours(vector)
    }


@cache
def pin_functions(pin: str) -> dict[str, int]:
    """What a pin ("A2") can be connected to ("usart2 tx"), and the number of that function."""
    functions: dict[str, int] = {}
    for gpio in _modm().iter("gpio"):
        if f"{gpio.get('port', '')}{gpio.get('pin', '')}" == pin.lower() and _is_ours(gpio):
            for signal in filter(_is_ours, gpio.iterfind("signal[@af]")):
                name = f"{signal.get('driver')}{signal.get('instance', '')} {signal.get('name')}"
                functions[name] = int(signal.get("af", ""))
    return functions


@cache
def memories() -> dict[str, tuple[int, int]]:
    """Start and size of each, for the smallest flash (E)."""
    return {
        memory.get("name", ""): (int(memory.get("start", ""), 0), int(memory.get("size", "")))
        for memory in _modm().iter("memory")
        if "e" in memory.get("device-size", "e").split("|")
    }
