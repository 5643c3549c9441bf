"""Whether what a person asks for lies within a workspace, in words and as JSON.

What is found is rounded down and a bound up, so that no sentence gainsays another.
"""

from __future__ import annotations

import argparse
import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:  # the command line starts before the layers it needs are known
    from deltaviz.mechanism.margin import Margin
    from deltaviz.robots.workspace import Belt, Cuboid, Cylinder, Fit, Inscribed, Stretch, Workspace

NEITHER = "Not found to fit, and not proved not to"
NEAR = 1.0  # mm
_ROUNDING = 1e-6  # of what is printed: 0.1 + 0.2 is no more than 0.3


@dataclass(frozen=True)
class Answer:
    """To one question whether something fits; None if neither was proved."""

    key: str
    fits: bool | None
    text: str
    data: dict[str, Any]


@dataclass(frozen=True)
class _Question:
    """Does a body of these sides and this height fit? `best` is the largest of its height and
    form."""

    key: str
    sides: tuple[float, ...]
    height: float
    best: Inscribed | None


def answers(workspace: Workspace, options: argparse.Namespace) -> list[Answer]:
    out: list[Answer] = []
    place: dict[str, Any] = {"floor": options.at}
    place["centre"] = None if options.anywhere else (0.0, 0.0)
    if options.cylinder:
        diameter, height = options.cylinder
        best = workspace.largest_cylinder(height=height, **place)
        question = _Question("cylinder", (diameter,), height, best)
        out.append(_whether(workspace, question, options.at))
    if options.box:
        *sides, height = options.box
        best = workspace.largest_box(height=height, aspect=sides[-1] / sides[0], **place)
        question = _Question("box", tuple(sides), height, best)
        out.append(_whether(workspace, question, options.at))
    if options.belt:
        out.append(_belt(workspace, options))
    return out


def _whether(workspace: Workspace, asked: _Question, floor: float | None) -> Answer:
    from deltaviz.robots.workspace.report import shape_json

    best, width = asked.best, asked.sides[0]
    shape = _placed(workspace, asked, floor)
    widest = 0.0 if best is None else _width(best)
    found = None if widest >= width else workspace.fit(shape)
    data: dict[str, Any] = {**shape_json(shape), "largest_width_mm": widest}
    data["none_above_mm"] = 0.0 if best is None else best.most
    if found is None or found.fits:
        return Answer(asked.key, True, f"Fits: {shape}.", {"fits": True, **data})
    denied = best is None or width > best.most
    fits, verdict = (False, "Does not fit") if denied else (None, NEITHER)
    lines = [f"{verdict}: {shape}.", *_by_how_much(found)]
    if best is not None:
        side = "diameter" if asked.key == "cylinder" else "first side"
        lines.append(f"  Of this height the {side} may be {_between(widest, best.most, width)}.")
    else:
        lines.append("  Nothing of this height and form was found to fit.")
    return Answer(asked.key, fits, "\n".join(lines), {"fits": fits, **data, **_fit_json(found)})


def _between(found: float, most: float, asked: float) -> str:
    """With the length asked for, and finer, where a tenth of a mm would not tell them apart."""
    if found + NEAR < asked and not most < asked < most + NEAR:
        return f"{down(found)} mm (none above {up(most)} fits)"
    return f"{down(found, 2)} mm (none above {up(most, 2)} fits); {asked:.10g} mm was asked for"


def _placed(workspace: Workspace, asked: _Question, floor: float | None) -> Cylinder | Cuboid:
    """What is asked for, where the largest of its height and form stands."""
    from deltaviz.robots.workspace import Cuboid, Cylinder

    best = asked.best
    centre = (0.0,) * (workspace.margins.dimensions - 1) if best is None else best.shape.centre
    if floor is None and best is not None:
        floor = best.shape.floor
    elif floor is None:
        low, high = float(workspace.extents.low[-1]), float(workspace.extents.high[-1])
        floor = (low + high - asked.height) / 2
    if asked.key == "cylinder":
        return Cylinder(asked.sides[0], asked.height, floor, centre)
    return Cuboid(asked.sides, asked.height, floor, centre)


def _width(best: Inscribed) -> float:
    from deltaviz.robots.workspace import Cylinder

    return best.shape.diameter if isinstance(best.shape, Cylinder) else best.shape.size[0]


def _by_how_much(found: Fit) -> list[str]:
    if found.clearance >= 0 or found.where is None:
        return ["  Nothing of it was found out of reach there."]
    share = f"{100 * found.unreached:.1f} %" if found.unreached > 5e-4 else "less than 0.1 %"
    place = ", ".join(f"{v:.1f}" for v in found.where.tolist())
    return [
        f"  It would have to shrink by {up(-found.clearance)} mm on all sides; {share} of it is "
        "out of reach.",
        f"  Worst at ({place}) mm: {_sentence(str(found.limit))}.",
    ]


def _fit_json(found: Fit) -> dict[str, Any]:
    return {
        "clearance_mm": found.clearance,
        "unreached": found.unreached,
        "where_mm": None if found.where is None else found.where.tolist(),
        "limit": _name(found.limit),
    }


def _belt(workspace: Workspace, options: argparse.Namespace) -> Answer:
    from deltaviz.robots.workspace import Belt

    width, height = [*options.belt, 0.0][:2]
    axis, offset = "xy".index(options.along), options.offset or 0.0
    belt = Belt(width, height, options.at, axis, offset, options.stretch or 0.0)
    found = workspace.serve(belt)
    fits = True if found.fits else (None if found.may_fit else False)
    data: dict[str, Any] = {
        "fits": fits,
        "from_mm": found.start,
        "to_mm": found.end,
        "stretch_mm": found.length,
        "widest_mm": _finite(found.widest),
        "none_wider_mm": _finite(found.none_wider),
        "widest_at_mm": found.widest_at,
        "limits": [_name(limit) for limit in found.limits],
    }
    return Answer("belt", fits, _belt_text(belt, found, options.along), data)


def _belt_text(belt: Belt, found: Stretch, along: str) -> str:
    if found.start is not None and found.end is not None:
        text = (
            f"{belt}, over its whole width from {along} {found.start:.1f} to {found.end:.1f} mm, "
            f"a stretch of {down(found.length)} mm"
        )
        verdict = "Served" if found.fits else "Not served for long enough"
        asked = "" if found.fits else f", of {belt.stretch:g} asked for"
        before, after = (_or_nothing(limit) for limit in found.limits)
        return f"{verdict}: {text}{asked}.\n  It ends at {before}, and at {after}."
    verdict = "Not found to be served" if found.may_fit else "Not served"
    text = f"{verdict} over its whole width: {belt}."
    if found.widest_at is None:
        return f"{text}\n  At that height nothing in its middle is within reach."
    across = "yx"["xy".index(along)]
    before, after = (_or_nothing(limit) for limit in found.limits)
    return (
        f"{text}\n  {down(found.widest)} mm are, at {along} {found.widest_at:.1f} mm (none above "
        f"{up(found.none_wider)} is): it is {up(belt.width - found.widest)} mm too wide."
        f"\n  Beyond, towards -{across}: {before}; towards +{across}: {after}."
    )


def _or_nothing(limit: Margin | None) -> str:
    return "no limit" if limit is None else f"the {limit}"


def _name(limit: Margin | None) -> str | None:
    return None if limit is None else str(limit)


def _finite(value: float) -> float | None:
    return value if math.isfinite(value) else None


def _sentence(text: str) -> str:
    return text[0].upper() + text[1:]


def down(length: float, digits: int = 1) -> str:
    """Rounded to what is certainly had."""
    unit = 10**digits
    return f"{math.floor(unit * length + _ROUNDING) / unit:.{digits}f}"


def up(length: float, digits: int = 1) -> str:
    """Rounded to what is certainly not exceeded."""
    unit = 10**digits
    return f"{math.ceil(unit * length - _ROUNDING) / unit:.{digits}f}"
