"""One number of a source beside ours, and a table of them."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

MINUS = "−"


@dataclass(frozen=True, slots=True)
class Row:
    """`tolerance`: how far from `theirs` ours may be and still be the same number, which is half
    a unit of the last digit they give unless a row says otherwise. `why` explains a difference
    beyond it."""

    what: str
    theirs: float
    ours: float
    tolerance: float
    unit: str = ""
    why: str = ""

    @property
    def same(self) -> bool:
        return abs(self.ours - self.theirs) <= self.tolerance


def table(rows: Iterable[Row]) -> str:
    lines = ["| | theirs | ours | difference | |", "| --- | ---: | ---: | ---: | --- |"]
    for row in rows:
        digits = _digits(row.tolerance)
        ours = f"{row.ours:.{digits}f}"
        difference = row.ours - row.theirs
        shown = f"{difference:+.{digits}f}" if not row.same else _small(difference)
        lines.append(
            _signs(f"| {row.what} | {_plain(row.theirs)}{row.unit} | {ours}{row.unit} | {shown} | ")
            + f"{row.why} |"
        )
    return "\n".join(lines)


def _digits(tolerance: float) -> int:
    """As many decimals as show what the tolerance allows."""
    digits = 0
    while tolerance < 0.999 and digits < 12:
        tolerance, digits = tolerance * 10, digits + 1
    return digits


def _plain(value: float) -> str:
    return f"{value:.12g}"


def _small(difference: float) -> str:
    return "0" if difference == 0 else f"{difference:+.0e}"


def _signs(text: str) -> str:
    """Minus signs for the hyphens that numbers are written with."""
    return text.replace(" -", f" {MINUS}").replace("(-", f"({MINUS}").replace("e-", f"e{MINUS}")
