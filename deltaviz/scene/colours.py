"""Mid-tones that stand out from a white and from a black stage."""

from __future__ import annotations

Colour = tuple[int, int, int]

BASE: Colour = (122, 133, 147)
MOTOR: Colour = (84, 94, 108)
STEEL: Colour = (150, 160, 172)
UPPER_ARM: Colour = (232, 131, 48)
ROD: Colour = (158, 168, 180)
EFFECTOR: Colour = (46, 134, 214)
GHOST: Colour = (64, 156, 236)
TRAIL: Colour = (46, 160, 190)
REACH: Colour = (72, 148, 214)
DESIGN: Colour = (150, 112, 222)
FITTED: Colour = (236, 150, 62)
PROBE: Colour = (206, 40, 132)
SINGULAR: tuple[Colour, Colour] = ((152, 92, 214), (222, 66, 66))  # of type 1, of type 2
GRID: Colour = (128, 138, 148)
OUTLINE: Colour = (138, 148, 158)
_WARN: Colour = (245, 176, 20)
_LIMIT: Colour = (226, 52, 52)

_TINT_BELOW = 0.3  # the margin at which a joint begins to change its colour
_TINT_STEPS = 12  # so that a joint's colour is sent when it changes visibly, not every frame


def tint(neutral: Colour, margin: float) -> Colour:
    """A joint's colour: neutral in the open, amber on the way, red at its limit (margin 0)."""
    nearness = min(max(1.0 - margin / _TINT_BELOW, 0.0), 1.0)
    share = round(nearness * _TINT_STEPS) / _TINT_STEPS
    if share <= 0.5:
        return _mixed(neutral, _WARN, share * 2)
    return _mixed(_WARN, _LIMIT, share * 2 - 1)


def _mixed(a: Colour, b: Colour, share: float) -> Colour:
    r, g, bl = (round(x + (y - x) * share) for x, y in zip(a, b, strict=True))
    return (r, g, bl)
