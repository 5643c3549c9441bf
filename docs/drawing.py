"""A small drawing of lines, circles and words in mm, written as SVG."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from html import escape

Point = Sequence[float]

INK, SOFT, PALE, FILL = "#1f2937", "#6b7280", "#d1d5db", "#e5e7eb"
BLUE, ORANGE, GREEN, RED = "#1d4ed8", "#c2410c", "#15803d", "#b91c1c"
MARGIN = 14  # px
OVERLAP = 0.3  # px of one bar over the next, so that no seam shows


class Drawing:
    """Shows x from `left` to `right` and y (upwards) from `bottom` to `top`, in `width` px."""

    def __init__(
        self, left: float, right: float, bottom: float, top: float, *, width: int = 560
    ) -> None:
        self._left, self._top = left, top
        self._scale = (width - 2 * MARGIN) / (right - left)
        self._size = width, round((top - bottom) * self._scale + 2 * MARGIN)
        self._parts: list[str] = []

    def line(self, *points: Point, colour: str = INK, width: float = 1.5, dash: str = "") -> None:
        way = " ".join(f"{x:.1f},{y:.1f}" for x, y in map(self._px, points))
        self._add("polyline", points=way, fill="none", **_stroke(colour, width, dash))

    def area(self, *points: Point, fill: str = FILL, colour: str = SOFT) -> None:
        way = " ".join(f"{x:.1f},{y:.1f}" for x, y in map(self._px, points))
        self._add("polygon", points=way, fill=fill, **_stroke(colour, 1))

    def circle(
        self, centre: Point, radius: float, *, colour: str = SOFT, width: float = 1, dash: str = ""
    ) -> None:
        x, y = self._px(centre)
        size = f"{radius * self._scale:.1f}"
        self._add(
            "circle", cx=f"{x:.1f}", cy=f"{y:.1f}", r=size, fill="none",
            **_stroke(colour, width, dash),
        )  # fmt: skip

    def arc(
        self, centre: Point, radius: float, start_deg: float, end_deg: float, *, colour: str = SOFT
    ) -> None:
        """Counter-clockwise where the end is greater than the start."""
        steps = [start_deg + (end_deg - start_deg) * i / 32 for i in range(33)]
        turns = [math.radians(step) for step in steps]
        at = [(centre[0] + radius * math.cos(t), centre[1] + radius * math.sin(t)) for t in turns]
        self.line(*at, colour=colour, width=1.2)

    def dot(self, at: Point, *, colour: str = INK, size: float = 3.5) -> None:
        x, y = self._px(at)
        self._add("circle", cx=f"{x:.1f}", cy=f"{y:.1f}", r=f"{size:g}", fill=colour)

    def arrow(self, start: Point, end: Point, *, colour: str = INK, width: float = 1.2) -> None:
        self.line(start, end, colour=colour, width=width)
        (ax, ay), (bx, by) = self._px(start), self._px(end)
        way = math.atan2(by - ay, bx - ax)
        sides = [(bx - 8 * math.cos(way + t), by - 8 * math.sin(way + t)) for t in (0.35, -0.35)]
        head = " ".join(f"{x:.1f},{y:.1f}" for x, y in [(bx, by), *sides])
        self._add("polygon", points=head, fill=colour)

    def word(
        self, at: Point, text: str, *, dx: float = 0, dy: float = 0, colour: str = INK,
        size: int = 15, anchor: str = "start",
    ) -> None:  # fmt: skip
        """`dx` to the right and `dy` up, in px."""
        x, y = self._px(at)
        self._add(
            "text", escape(text), x=f"{x + dx:.1f}", y=f"{y - dy:.1f}", fill=colour,
            font_size=str(size), text_anchor=anchor,
        )  # fmt: skip

    def runs(self, runs: Iterable[tuple[float, float, float]], height: float, fill: str) -> None:
        """Many (x from, x to, y) bars of one height, as one shape."""
        way: list[str] = []
        for start, end, y in runs:
            x, top = self._px((start, y + height / 2))
            wide, high = (end - start) * self._scale, height * self._scale + OVERLAP
            way.append(f"M{x:.1f},{top:.1f}h{wide:.1f}v{high:.1f}h{-wide:.1f}z")
        self._add("path", d="".join(way), fill=fill)

    def svg(self) -> str:
        width, height = self._size
        return (
            f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}" '
            f'viewBox="0 0 {width} {height}" font-family="DejaVu Serif, Georgia, serif">\n'
            f'<rect width="{width}" height="{height}" rx="6" fill="#ffffff"/>\n'
            + "\n".join(self._parts)
            + "\n</svg>\n"
        )

    def _px(self, point: Point) -> tuple[float, float]:
        x, y = point
        return MARGIN + (x - self._left) * self._scale, MARGIN + (self._top - y) * self._scale

    def _add(self, tag: str, text: str = "", **attributes: str) -> None:
        given = " ".join(f'{k.replace("_", "-")}="{v}"' for k, v in attributes.items() if v)
        self._parts.append(f"<{tag} {given}>{text}</{tag}>" if text else f"<{tag} {given}/>")


def _stroke(colour: str, width: float, dash: str = "") -> dict[str, str]:
    return {
        "stroke": colour,
        "stroke_width": f"{width:g}",
        "stroke_dasharray": dash,
        "stroke_linejoin": "round",
        "stroke_linecap": "round",
    }
