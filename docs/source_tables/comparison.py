"""One number of a source beside ours, and a table of them."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

MINUS = "−"


@dataclass(frozen=True, slots=True)
class Row:
    """`digits`: how many they give after the point. `why` explains a difference."""

    what: str
    theirs: float
    ours: float
    digits: int
    unit: str = ""
    why: str = ""


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
        theirs, ours = (f"{value:.{row.digits}f}" for value in (row.theirs, row.ours))
        difference = float(ours) - float(theirs)  # of what is shown
        shown = "0" if ours == theirs else f"{difference:+.{row.digits}f}"
        lines.append(
            _signs(f"| {row.what} | {theirs}{row.unit} | {ours}{row.unit} | {shown} | ")
            + f"{row.why} |"
        )
    return "\n".join(lines)


def _signs(text: str) -> str:
    """Minus signs for the hyphens that numbers are written with."""
    return text.replace(" -", f" {MINUS}").replace("(-", f"({MINUS}")
