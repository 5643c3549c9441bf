"""What is told beside the inputs, row by row, and how viser's panel writes it."""

from __future__ import annotations

import html
from collections.abc import Sequence
from dataclasses import dataclass
from typing import ClassVar

Rgb = tuple[int, int, int]


@dataclass(frozen=True)
class Row:
    """A row without a value is a sentence; `dot` is the colour that it speaks of."""

    kind: ClassVar[str] = "row"
    text: str
    value: str = ""
    dot: Rgb | None = None


@dataclass(frozen=True)
class ColourKey:
    """What the colours mean, from the first of `stops` to the last, in even steps."""

    kind: ClassVar[str] = "colours"
    name: str
    low: str
    high: str
    stops: tuple[Rgb, ...]


Rows = tuple[Row | ColourKey, ...]


def html_of(rows: Sequence[Row | ColourKey], *, lines: int = 0) -> str:
    """With room for so many lines at least; nothing, of no rows and no lines."""
    if not rows and not lines:
        return ""
    body = "".join(_key(row) if isinstance(row, ColourKey) else _row(row) for row in rows)
    return (
        "<div style='font-size:12px;line-height:1.4;padding:4px 8px;overflow-wrap:anywhere;"
        f"min-height:calc({lines} * 1.4em + 8px);font-variant-numeric:tabular-nums'>{body}</div>"
    )


def _row(row: Row) -> str:
    text = html.escape(row.text)
    if row.dot is not None:
        text = f"<span style='color:rgb{row.dot}'>■</span> {text}"
    if not row.value:
        return f"<div>{text}</div>"
    value = f"<span style='text-align:right'>{html.escape(row.value)}</span>"
    return (
        "<div style='display:flex;justify-content:space-between;gap:12px'>"
        f"<span>{text}</span>{value}</div>"
    )


def _key(key: ColourKey) -> str:
    colours = ", ".join(f"rgb{colour}" for colour in key.stops)
    return (
        f"<div style='margin-top:6px'>{html.escape(key.name)}</div>"
        "<div style='height:10px;border-radius:3px;"
        f"background:linear-gradient(90deg, {colours})'></div>"
        "<div style='display:flex;justify-content:space-between'>"
        f"<span>{html.escape(key.low)}</span><span>{html.escape(key.high)}</span></div>"
    )
