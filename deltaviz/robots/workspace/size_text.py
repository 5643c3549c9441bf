"""How large a workspace is, in words of a fitting unit."""

from __future__ import annotations


def size_text(size: float, *, dimensions: int) -> str:
    """Of mm³, or of mm² in a plane: of 2 `dimensions`."""
    return _area(size) if dimensions == 2 else _volume(size)


def _volume(volume: float) -> str:
    if volume >= 1e5:
        return f"{_four_digits(volume / 1e6)} l"
    return f"{volume / 1e3:.4g} cm³" if volume >= 100 else f"{volume:.4g} mm³"


def _area(area: float) -> str:
    return f"{_four_digits(area / 100)} cm²" if area >= 1e3 else f"{area:.4g} mm²"


def _four_digits(size: float) -> str:
    """Or all before the point."""
    return f"{size:.4g}" if size < 1e4 else f"{size:.0f}"
