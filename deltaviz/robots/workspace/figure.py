"""A picture that a notebook shows."""

from __future__ import annotations

from io import BytesIO

from matplotlib.figure import Figure

DPI = 110


class ShownFigure(Figure):
    """It draws itself where it is the last value of a notebook's cell; a plain figure does so only
    if it was made by pyplot."""

    def _repr_png_(self) -> bytes:
        out = BytesIO()
        self.savefig(out, format="png", dpi=DPI, bbox_inches="tight")
        return out.getvalue()
