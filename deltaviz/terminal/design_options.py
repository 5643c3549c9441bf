"""The options of `deltaviz design`: what is wished, and within which sizes."""

from __future__ import annotations

import argparse
import math
from pathlib import Path
from typing import TYPE_CHECKING

from deltaviz.terminal.numbers import finite, not_negative, positive

if TYPE_CHECKING:
    from deltaviz.robots import Robot
    from deltaviz.robots.design import Ranges, Wish

PAPERS = {  # mm
    "letter": (215.9, 279.4),
    "legal": (215.9, 355.6),
    "a3": (297.0, 420.0),
    "a4": (210.0, 297.0),
    "a5": (148.0, 210.0),
}
# Without a wish, the largest lengths in spans (largest sides) of what is to be reached.
MOST_BASE, MOST_UPPER_ARM, MOST_FOREARM = 1.0, 1.0, 2.5
LEAST_UPPER_ARM, LEAST_FOREARM = 0.1, 0.3


class WrongWish(Exception):
    """Options that ask for what this kind of robot cannot have; says what would be right."""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    what = parser.add_argument_group("what it must reach, about the vertical axis")
    one = what.add_mutually_exclusive_group(required=True)
    one.add_argument(
        "--cylinder", nargs=2, type=positive, metavar=("D", "H"), help="diameter and height, mm"
    )
    one.add_argument(
        "--box",
        nargs="+",
        type=positive,
        metavar="MM",
        help="sides along x and y, and height; for a planar robot x, height",
    )
    one.add_argument(
        "--belt",
        nargs=3,
        type=positive,
        metavar=("W", "H", "S"),
        help="a stretch S along x of a belt W wide, and H above it",
    )
    one.add_argument("--paper", choices=sorted(PAPERS), help="a sheet, with room to lift the pen")
    what.add_argument(
        "--lift",
        type=positive,
        default=10.0,
        metavar="MM",
        help="how far the pen is lifted off the paper (10)",
    )
    what.add_argument(
        "--at",
        type=finite,
        metavar="Z",
        help="height of the floor that it stands on (wherever it is best)",
    )
    sizes = parser.add_argument_group("size limits, mm (by default from what it must reach)")
    sizes.add_argument("--max-base", type=positive, metavar="MM", help="base radius; half the base")
    sizes.add_argument("--max-upper-arm", type=positive, metavar="MM")
    sizes.add_argument("--max-forearm", type=positive, metavar="MM")
    sizes.add_argument(
        "--max-depth", type=positive, metavar="MM", help="from the motors down to the lowest place"
    )
    how = parser.add_argument_group("how")
    how.add_argument(
        "--prefer",
        choices=("both", "conditioning", "resolution"),
        default="both",
        help="what its worst place is judged by (both)",
    )
    how.add_argument(
        "--grain",
        type=positive,
        default=0.5,
        metavar="MM",
        help="lengths are whole multiples of this (0.5)",
    )
    how.add_argument(
        "--reserve",
        type=not_negative,
        default=0.0,
        metavar="MM",
        help="distance to keep from every limit (0)",
    )
    how.add_argument(
        "--generations", type=_whole, default=80, metavar="N", help="of the search, at most (80)"
    )
    how.add_argument(
        "--seed",
        type=_seed,
        default=0,
        metavar="N",
        help="the same seed finds the same lengths (0)",
    )
    how.add_argument("--workers", type=_whole, metavar="N", help="processes (one for each core)")
    how.add_argument(
        "--scheduler",
        metavar="ADDRESS",
        help="of a Dask cluster that searches instead, as tcp://HOST:8786",
    )
    how.add_argument("--out", type=Path, metavar="FILE", help="the robot file (designed.toml)")
    how.add_argument("--overwrite", action="store_true", help="write over a file that is there")


def wish(template: Robot, options: argparse.Namespace) -> Wish:
    from deltaviz.robots.design import Wish
    from deltaviz.robots.workspace.shapes import Cuboid, Cylinder

    planar = len(template.tool_offset) == 2
    if planar and not options.box:
        raise WrongWish(f"{template.name} moves in a plane: ask for --box W H")
    if options.cylinder:
        diameter, height = options.cylinder
        return Wish(Cylinder(diameter, height, 0.0), options.at)
    if options.box:
        *sides, height = options.box
        if len(sides) != (1 if planar else 2):
            raise WrongWish(f"--box takes {'2' if planar else '3'} lengths for {template.name}")
    elif options.belt:
        width, height, stretch = options.belt
        sides = [stretch, width]
    else:
        sides, height = list(PAPERS[options.paper]), options.lift
    return Wish(Cuboid(tuple(sides), height, 0.0, (0.0,) * len(sides)), options.at)


def ranges(template: Robot, wished: Wish, options: argparse.Namespace) -> Ranges:
    from deltaviz.mechanism import RotaryDelta
    from deltaviz.robots.design import Ranges

    mechanism, span, grain = template.mechanism, wished.span, options.grain
    least = max(mechanism.effector_radius) if isinstance(mechanism, RotaryDelta) else 0.0
    _check_most(options, template.name, least_base=least)
    most_upper = options.max_upper_arm or MOST_UPPER_ARM * span
    most_fore = options.max_forearm or MOST_FOREARM * span
    depth = options.max_depth or most_upper + most_fore
    floor = _whole_grains(-depth, -wished.body.height, grain)
    if options.at is not None:
        floor = (options.at, options.at)
    if options.at is not None and -options.at > depth:
        raise WrongWish(f"--at {options.at:g} lies deeper than {depth:g} mm")
    return Ranges(
        base=_whole_grains(least, options.max_base or least + MOST_BASE * span, grain),
        upper_arm=_whole_grains(
            max(grain, min(LEAST_UPPER_ARM * span, most_upper)), most_upper, grain
        ),
        forearm=_whole_grains(max(grain, min(LEAST_FOREARM * span, most_fore)), most_fore, grain),
        floor=floor,
    )


def _check_most(options: argparse.Namespace, name: str, *, least_base: float) -> None:
    """Raises WrongWish for a size limit below what any design has."""
    grain = options.grain
    base = _whole_grains(least_base, math.inf, grain)[0]
    if options.max_base is not None and options.max_base < base:
        raise WrongWish(
            f"--max-base {options.max_base:g}: must be at least {base:g}: the effector is that of "
            f"{name}, {least_base:g} mm in radius, and no base is smaller than its effector"
        )
    for option in ("max_upper_arm", "max_forearm"):
        most = getattr(options, option)
        if most is not None and most < grain:
            raise WrongWish(
                f"--{option.replace('_', '-')} {most:g}: must be at least {grain:g}, one --grain"
            )


def _whole_grains(low: float, high: float, grain: float) -> tuple[float, float]:
    """The multiples of `grain` between them, so that a rounded length stays within its limits."""
    most = high if math.isinf(high) else math.floor(high / grain) * grain
    return math.ceil(low / grain) * grain, most


def _whole(text: str) -> int:
    if not text.strip().isdecimal() or not 1 <= int(text) <= 100_000:
        raise argparse.ArgumentTypeError(f"{text!r}: use a whole number from 1 to 100000")
    return int(text)


def _seed(text: str) -> int:
    if not text.strip().isdecimal():
        raise argparse.ArgumentTypeError(f"{text!r}: use a whole number from 0")
    return int(text)
