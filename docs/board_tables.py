"""Tables of the firmware's pins and times, from the headers that it is built from itself."""

from __future__ import annotations

import re
from pathlib import Path

PORT = Path(__file__).parents[1] / "firmware" / "port" / "stm32f407"

PURPOSES = {
    "STEP": "STEP of joint {}",
    "DIR": "DIR of joint {}",
    "SWITCH": "end stop of joint {}",
    "ENABLE": "ENABLE of all drivers",
    "ESTOP": "e-stop input",
    "TOOL": "tool, on at the high level",
    "SERVO": "servo's pulses",
    "SERIAL_TX": "link, from the board (to the adapter's RX)",
    "SERIAL_RX": "link, to the board (from the adapter's TX)",
    "LED": "light",
}


def defined(header: str) -> dict[str, str]:
    """Names and bodies, comments taken off, of a header's definitions."""
    text = re.sub(r"/\*.*?\*/", "", (PORT / header).read_text(), flags=re.DOTALL)
    return {n: b.strip() for n, b in re.findall(r"^#define (\w+) (.+)$", text, re.MULTILINE)}


def pin(body: str) -> str:
    """(PORT_E | 8u): PE8."""
    match = re.fullmatch(r"\(PORT_(\w) \| (\d+)u\)", body)
    assert match is not None, body
    return f"P{match[1]}{match[2]}"


def pins() -> str:
    rows = ["| pin | what for |", "| --- | --- |"]
    for name, body in defined("boards/pins.h").items():
        if name.startswith("PIN_") and not name.endswith("_FUNCTION"):
            what, _, number = name.removeprefix("PIN_").partition("_")
            purpose = PURPOSES.get(name.removeprefix("PIN_")) or PURPOSES[what].format(number)
            rows.append(f"| {pin(body)} | {purpose} |")
    return "\n".join(rows)


def boards() -> str:
    rows = ["| board | image | light |", "| --- | --- | --- |"]
    for image in ("disc1", "f407vet6"):
        header = defined(f"boards/{image}.h")
        lit = "high" if header["LED_LIT_BY"] == "1u" else "low"
        rows.append(
            f"| {header['BOARD_NAME'].strip(chr(34))} | `firmware/build/{image}.bin` | "
            f"{pin(header['PIN_LED'])}, lit by a {lit} level |"
        )
    return "\n".join(rows)


def step_timing() -> str:
    tick_hz = int(defined("boards/silicon.h")["TICK_HZ"].rstrip("u"))
    needs = defined("step_timing.h")
    rows = [
        "| ns | the firmware gives | DRV8825 needs | TMC2209 needs |",
        "| --- | --- | --- | --- |",
    ]
    for what, name in (
        ("STEP high", "STEP_HIGH"),
        ("STEP low", "STEP_LOW"),
        ("DIR before STEP rises", "DIR_SETUP"),
        ("DIR after STEP rose", "DIR_HOLD"),
    ):
        numbers = (needs[f"{driver}_{name}_NS"] for driver in ("DRV8825", "TMC2209"))
        rows.append(f"| {what} | {1_000_000_000 // tick_hz} | {' | '.join(numbers)} |")
    return "\n".join(rows)
