"""Measures what comes of faults and writes it into docs/reliability.md; half a minute.

python docs/reliability.py

All is by seeds and on clocks that are turned by hand, so it comes out alike everywhere, but for
some frames where processors round differently. The tests in tests/faults measure the same, judge
it, and hold the page to it.
"""

from __future__ import annotations

import re
import sys
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any

ROOT = Path(__file__).parents[1]
PAGE = ROOT / "docs" / "reliability.md"
sys.path.insert(0, str(ROOT))  # for what the tests measure with


class Sentences:
    """Letters for what is told, which would not fit into tables."""

    def __init__(self) -> None:
        self._known: list[str] = []

    def letter(self, sentence: str) -> str:
        if sentence not in self._known:
            self._known.append(sentence)
        return chr(ord("A") + self._known.index(sentence))

    def legend(self) -> str:
        return "\n".join(f"- **{self.letter(s)}** {s}" for s in self._known)


def table(heads: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    lines = [heads, ["---"] * len(heads), *rows]
    return "\n".join(f"| {' | '.join(line)} |" for line in lines)


def wire(said: Sentences) -> str:
    from tests.faults.wire_faults import FAULTS

    heads = (
        "fault", "rate", "frames", "faults", "stops", "s of motion a stop", "told",
        "nearest to a limit", "beyond it", "end",
    )  # fmt: skip
    return table(heads, (_wire_row(fault, said) for fault in FAULTS))


def _wire_row(fault: Any, said: Sentences) -> list[str]:
    from tests.faults.measured import work

    done = work(fault)
    stops = done.day.count
    told = sorted((said.letter(text), count) for text, count in done.day.stops.items())
    return [
        str(fault),
        f"{fault.rate * 100:g} %",
        str(done.frames),
        str(done.injected),
        str(stops),
        f"{done.day.moved / stops:.1f}" if stops else f"none in {done.day.moved:.1f}",
        ", ".join(f"{count} {letter}" for letter, count in told) or "-",
        f"{100 * nearest(done.verdicts):.0f} %",
        "; ".join(beyond(done.verdicts)) or "none",
        f"{done.end}, at rest",
    ]


def nearest(verdicts: Iterable[Any]) -> float:
    """The largest share of a joint's velocity or acceleration limit that was used."""
    rates = ("joint velocity", "joint acceleration")
    return max(v.worst.get(name, 0.0) for v in verdicts for name in rates)


def beyond(verdicts: Iterable[Any]) -> list[str]:
    return [f"{name} {value:.3f}" for v in verdicts for name, value in v.excess.items()]


def breaks(said: Sentences) -> str:
    from tests.faults.breaks import BREAKS
    from tests.faults.phases import PHASES

    rows = [[how, *(_break_cell(phase, how, said) for phase in PHASES)] for how in BREAKS]
    return table(["", *PHASES], rows)


def _break_cell(phase: str, how: str, said: Sentences) -> str:
    from tests.faults.measured import outcome

    came = outcome(phase, how)
    rested = f"{1000 * came.rested:.0f} ms, " if came.stopped else ""
    if came.moving and not came.stopped:
        return "goes on"
    told = f"{said.letter(came.told)}, " if came.told else ""
    limits = "".join(f"{text}, " for text in beyond(came.verdicts))
    return f"{rested}{told}{limits}{came.end}"


def meeting(said: Sentences) -> str:
    from tests.faults.measured import meetings
    from tests.faults.wire_faults import FAULTS

    rows: list[list[str]] = []
    for fault in (f for f in FAULTS if f.rate == 0.01):
        tries = meetings(fault)
        failed = sorted({said.letter(told) for told in tries if told is not None})
        met = f"{tries.count(None)} of {len(tries)}"
        rows.append([str(fault), met, ", ".join(failed) or "-"])
    return table(["1 % of", "board met", "else told"], rows)


def todays() -> str:
    said = Sentences()
    blocks = {"wire": wire(said), "meeting": meeting(said), "breaks": breaks(said)}
    blocks["sentences"] = said.legend()

    def block(match: re.Match[str]) -> str:
        return f"{match[1]}\n{blocks[match[2]]}\n{match[3]}"

    marked = r"(<!-- measured: ([\w-]+) -->).*?(<!-- end -->)"
    return re.sub(marked, block, PAGE.read_text(), flags=re.DOTALL)


if __name__ == "__main__":
    PAGE.write_text(todays())
