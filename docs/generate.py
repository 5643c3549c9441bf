"""Writes into the docs what the code says: each block between its two markers.

python docs/generate.py          write
python docs/generate.py --check  status 1 and the names of the pages that are not today's
"""

from __future__ import annotations

import importlib
import json
import re
import sys
from collections.abc import Callable
from pathlib import Path

DOCS = Path(__file__).parent


def machine_states() -> str:
    from deltaviz.machine.diagram import mermaid

    return f"```mermaid\n{mermaid()}\n```"


def protocol_general() -> str:
    from deltaviz.link.wire.reference import general

    return general()


def protocol_numbers() -> str:
    from deltaviz.link.wire.reference import numbers

    return numbers()


def host_messages() -> str:
    from deltaviz.link.wire.reference import message_tables

    return message_tables("host")


def board_messages() -> str:
    from deltaviz.link.wire.reference import message_tables

    return message_tables("board")


def protocol_enumerations() -> str:
    from deltaviz.link.wire.reference import enumerations

    return enumerations()


def board_states() -> str:
    from deltaviz.link.board.states import TRANSITIONS
    from deltaviz.link.messages import BoardState
    from deltaviz.link.state_diagram import mermaid

    drawn = mermaid(TRANSITIONS, first=BoardState.DISABLED, anywhere="any state")
    return f"```mermaid\n{drawn}\n```"


def session_phases() -> str:
    from deltaviz.link.session_states import PHASES, Phase
    from deltaviz.link.state_diagram import mermaid

    drawn = mermaid(PHASES, first=Phase.GREETING, anywhere="any phase")
    return f"```mermaid\n{drawn}\n```"


def session_motions() -> str:
    from deltaviz.link.session_states import MOTIONS, Motion
    from deltaviz.link.state_diagram import mermaid

    drawn = mermaid(MOTIONS, first=Motion.NONE, anywhere="any motion")
    return f"```mermaid\n{drawn}\n```"


def host_timing() -> str:
    from deltaviz.link.timing import TIMEOUTS

    rows = [f"| {1000 * t.seconds:g} ms | {t.after} | {t.then} |" for t in TIMEOUTS]
    return "\n".join(["| after | | |", "| ---: | --- | --- |", *rows])


def board_timing() -> str:
    from deltaviz.link import rules

    rows = [
        (rules.TELEMETRY_MS, "between two Telemetry"),
        (rules.LEASE_MS, "from the newest `seen` to the end of the lease"),
        (rules.SEGMENT_MIN_MS, "the shortest segment"),
        (rules.SEGMENT_MAX_MS, "the longest segment"),
        (rules.LATE_MS, "how old the start of a motion (or of an epoch) may be"),
        (rules.AHEAD_MS, "how far ahead it may lie"),
    ]
    shown = [f"| {ms} ms | {what} |" for ms, what in rows]
    return "\n".join(["| board time | |", "| ---: | --- |", *shown])


def protocol_example() -> str:
    """Frames that hold both codecs, in the order in which they would pass."""
    frames = json.loads((DOCS.parent / "tests" / "data" / "frames.json").read_text())["messages"]
    rows: list[str] = []
    for name in _EXAMPLE:
        message = next(x for x in frames if x["message"] == name)
        sender = "host" if message["type"] < 0x80 else "board"
        bytes_ = " ".join(re.findall("..", message["frame"]))
        shown = bytes_ if len(bytes_) <= 110 else f"{bytes_[:107]}…"
        rows.append(f"{sender:<5} {name:<10} {message['sequence']:>3}  {shown}")
    return "```text\n" + "\n".join(rows) + "\n```"


def link_problems() -> str:
    from deltaviz.link.catalogue import catalogue

    rows = [f"| {case} | {sentence} |" for case, sentence in catalogue()]
    return "\n".join(["| what is wrong | what the page says |", "| --- | --- |", *rows])


def capture_format() -> str:
    import inspect

    from deltaviz.link.capture import records

    text = inspect.cleandoc(records.__doc__ or "").split("\n\n", 1)[1]
    return f"{text}\n\nThis is format {records.FORMAT}."


def boards() -> str:
    import board_tables

    return board_tables.boards()


def pins() -> str:
    import board_tables

    return board_tables.pins()


def step_timing() -> str:
    import board_tables

    return board_tables.step_timing()


def firmware() -> str:
    """Builds it and runs it, so that it takes some seconds."""
    sys.path.insert(0, str(DOCS.parent))  # for what the tests measure with
    import firmware_tables

    return firmware_tables.measured()


def of_source(name: str, function: str = "tables") -> Callable[[], str]:
    def made() -> str:
        return getattr(importlib.import_module(f"source_tables.{name}"), function)()

    return made


_EXAMPLE = (
    "Hello", "HelloReply", "Configure", "Configured", "Telemetry", "Enable", "Done", "Arm",
    "Segment", "Keep", "Stop", "Stopped", "Refused",
)  # fmt: skip

BLOCKS: dict[str, Callable[[], str]] = {
    "machine-states": machine_states,
    "protocol-general": protocol_general,
    "protocol-numbers": protocol_numbers,
    "protocol-example": protocol_example,
    "host-messages": host_messages,
    "board-messages": board_messages,
    "protocol-enumerations": protocol_enumerations,
    "board-states": board_states,
    "board-timing": board_timing,
    "session-phases": session_phases,
    "session-motions": session_motions,
    "host-timing": host_timing,
    "link-problems": link_problems,
    "capture-format": capture_format,
    "boards": boards,
    "pins": pins,
    "step-timing": step_timing,
    "firmware": firmware,
    "corrections": of_source("corrections"),
    "corrections-elsewhere": of_source("corrections", "elsewhere"),
    "trossen": of_source("trossen"),
    "firestep": of_source("trossen", "firestep"),
    "zheng-chen": of_source("zheng_chen"),
    "zheng-chen-views": of_source("zheng_chen", "views"),
    "drawing-robot": of_source("drawing_robot"),
    "letter-paper": of_source("drawing_robot", "paper"),
    "stm32-scan": of_source("stm32"),
    "stm32-reach": of_source("stm32", "reach"),
    "solved-poses": of_source("reference"),
    "certificates": of_source("reference", "certificates"),
    "rods": of_source("models", "rods"),
    "calibration": of_source("models", "calibration"),
}


def fill(text: str) -> str:
    """`text` with the content of every marked block made anew."""

    def block(match: re.Match[str]) -> str:
        return f"{match[1]}\n{BLOCKS[match[2]]().strip()}\n{match[3]}"

    return re.sub(r"(<!-- made: ([\w-]+) -->).*?(<!-- end -->)", block, text, flags=re.DOTALL)


def main() -> int:
    stale = [
        page for page in sorted(DOCS.glob("*.md")) if fill(page.read_text()) != page.read_text()
    ]
    if "--check" in sys.argv:
        for page in stale:
            print(f"{page} is not today's; run: python docs/generate.py")
        return 1 if stale else 0
    for page in stale:
        page.write_text(fill(page.read_text()))
    return 0


if __name__ == "__main__":
    sys.exit(main())
