"""One number of a source beside ours, and a table of them."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass

MINUS = "−"
ROUNDING = 0.1  # of half a unit: theirs may be cut off or rounded from a rounded number


@dataclass(frozen=True, slots=True)
class Row:
    """`tolerance`: how far from `theirs` ours may be and still be the same number: half a unit of
    the last digit they give. `why` explains a difference beyond it."""

    what: str
    theirs: float
    ours: float
    tolerance: float
    unit: str = ""
    why: str = ""

    @property
    def same(self) -> bool:
        return abs(self.ours - self.theirs) <= self.tolerance * (1 + ROUNDING)


def agreement(rows: Iterable[tuple[str, float, float, str]]) -> str:
    """(what, largest difference, at most, unit): rounding makes the difference, so that its digits
    are not the same on every machine, and only the verdict is shown."""
    lines = ["| | differ by at most | |", "| --- | ---: | --- |"]
    for what, worst, most, unit in rows:
        verdict = "yes" if worst <= most else f"**no: {worst:.1e}{unit}**"
        shown = f"{most:.1e}".replace(".0e", "e").replace("e-", f"e{MINUS}")
        lines.append(f"| {what} | {shown}{unit} | {verdict} |")
    return "\n".join(lines)


def table(rows: Iterable[Row]) -> str:
    lines = ["| | theirs | ours | difference | |", "| --- | ---: | ---: | ---: | --- |"]
    for row in rows:
        digits = max(0, round(-math.log10(2 * row.tolerance)))
        theirs, ours = (f"{value:.{digits}f}" for value in (row.theirs, row.ours))
        difference = row.ours - row.theirs
        shown = "0" if row.same else f"{difference:+.{digits}f}"
        lines.append(
            _signs(f"| {row.what} | {theirs}{row.unit} | {ours}{row.unit} | {shown} | ")
            + f"{row.why} |"
        )
    return "\n".join(lines)


def _signs(text: str) -> str:
    """Minus signs for the hyphens that numbers are written with."""
    return text.replace(" -", f" {MINUS}").replace("(-", f"({MINUS}")
