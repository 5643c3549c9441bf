"""`deltaviz workspace`: what a robot reaches, how well, and what fits inside."""

from __future__ import annotations

import argparse
import json
import math
import os
import sys
from typing import TYPE_CHECKING, Any

from deltaviz.terminal.numbers import finite, not_negative, positive
from deltaviz.terminal.status import BAD_USAGE, FAILED, OK

if TYPE_CHECKING:  # the command line starts before the layers it needs are known
    from deltaviz.robots import Robot
    from deltaviz.robots.workspace import Belt, Inscribed, Limit, Workspace
    from deltaviz.robots.workspace.report import Report

LIMITS = ("reach", "joints", "ball-joints", "singularities", "collisions", "zone")
MACHINE = LIMITS[:-1]
CSV_SPACING = 10.0  # mm


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "--limits", type=_limits, default=MACHINE, metavar="LIST",
        help=f"what ends the workspace, of {','.join(LIMITS)} (all but zone; reach always counts)",
    )  # fmt: skip
    parser.add_argument(
        "--resolution", type=positive, metavar="MM",
        help="how near the boundary is to the true one (1); spacing of the CSV's points (10)",
    )  # fmt: skip
    parser.add_argument(
        "--at", type=finite, metavar="Z", help="height of the floor that shapes stand on, mm"
    )
    parser.add_argument(
        "--anywhere", action="store_true", help="shapes need not stand about the vertical axis"
    )
    parser.add_argument(
        "--cylinder", nargs=2, type=positive, metavar=("D", "H"),
        help="does a cylinder of this diameter and height fit?",
    )  # fmt: skip
    parser.add_argument(
        "--box", nargs="+", type=positive, metavar="MM",
        help="does a box W D H fit? (W H in a plane) W lies along x",
    )  # fmt: skip
    parser.add_argument(
        "--belt", nargs="+", type=positive, metavar="MM",
        help="which stretch of a belt W wide is reached over all its width, and up to H above it?",
    )  # fmt: skip
    parser.add_argument(
        "--along", choices=("x", "y"), default="x", help="direction of the belt (x)"
    )
    parser.add_argument(
        "--payload", type=not_negative, default=0.0, metavar="KG", help="for the torques (0)"
    )
    parser.add_argument("--plot", metavar="FILE", help="write pictures (.png, .svg, .pdf)")
    parser.add_argument(
        "--colour", metavar="MEASURE", help="colour the pictures' sections, by condition for one"
    )
    parser.add_argument("--csv", metavar="FILE", help="write points within reach, and their angles")
    parser.add_argument("--stl", metavar="FILE", help="write the boundary as a surface")


def run(robot: Robot, options: argparse.Namespace) -> int:
    """Status 1 if the workspace is empty, a shape does not fit, or a file cannot be written."""
    planar = len(robot.tool_offset) == 2
    wrong = _wrong(options, planar=planar)
    if wrong is not None:
        print(f"deltaviz: {wrong}", file=sys.stderr)
        return BAD_USAGE
    workspace = robot.workspace(
        _flags(options.limits), tolerance=options.resolution or 1.0, threads=os.cpu_count() or 1
    )
    if workspace.empty:
        if options.json:
            print(json.dumps({"robot": robot.name, "empty": True, "reason": workspace.reason}))
        print(f"deltaviz: the workspace is empty. {workspace.reason}", file=sys.stderr)
        return FAILED
    answers = _answers(workspace, options)
    if answers:
        _print_answers(workspace, answers, as_json=options.json)
    else:
        _print_found(workspace, options)
    written = _write(workspace, options)
    return OK if written and all(answer.fits for answer in answers) else FAILED


def _wrong(options: argparse.Namespace, *, planar: bool) -> str | None:
    """What is wrong with the options for this robot."""
    sides = 2 if planar else 3
    if planar and options.cylinder:
        return "--cylinder: in a plane there are none; use --box W H"
    if options.box and len(options.box) != sides:
        return f"--box takes {sides} lengths for this robot; got {len(options.box)}"
    if options.belt and len(options.belt) > 2:
        return f"--belt takes its width, or width and height; got {len(options.belt)} lengths"
    if options.belt and options.at is None:
        return "--belt needs --at Z, the height at which it runs"
    if planar and options.belt and options.along == "y":
        return "--along y: this robot moves in the plane of x and z"
    if planar and options.stl:
        return "--stl: a workspace in a plane has no surface"
    if options.colour and not options.plot:
        return "--colour needs --plot FILE"
    return _unknown_colour(options.colour)


def _unknown_colour(colour: str | None) -> str | None:
    if colour is None:
        return None
    from deltaviz.robots.workspace.quality import Quality

    known = Quality.measures()
    return None if colour in known else f"--colour {colour}: use one of {', '.join(known)}"


class _Answer:
    """To one question whether something fits."""

    def __init__(self, key: str, fits: bool, text: str, data: dict[str, Any]) -> None:
        self.key, self.fits, self.text, self.data = key, fits, text, data


def _answers(workspace: Workspace, options: argparse.Namespace) -> list[_Answer]:
    out: list[_Answer] = []
    centre = None if options.anywhere else (0.0, 0.0)
    if options.cylinder:
        diameter, height = options.cylinder
        best = workspace.largest_cylinder(height=height, floor=options.at, centre=centre)
        out.append(_whether(workspace, "cylinder", (diameter,), height, best, options))
    if options.box:
        *sides, height = options.box
        aspect = sides[-1] / sides[0]
        best = workspace.largest_box(height=height, floor=options.at, centre=centre, aspect=aspect)
        out.append(_whether(workspace, "box", tuple(sides), height, best, options))
    if options.belt:
        out.append(_belt(workspace, options))
    return out


def _whether(
    workspace: Workspace,
    key: str,
    sides: tuple[float, ...],
    height: float,
    best: Inscribed | None,
    options: argparse.Namespace,
) -> _Answer:
    """`best` is the largest of the same height and form."""
    from deltaviz.robots.workspace import Cuboid, Cylinder
    from deltaviz.robots.workspace.report import shape_json

    flat = workspace.margins.dimensions - 1
    centre = (0.0,) * flat if best is None else best.shape.centre
    floor = _floor(workspace, height, best, options)
    shape = Cylinder(sides[0], height, floor, centre) if key == "cylinder" else Cuboid(
        sides, height, floor, centre
    )  # fmt: skip
    widest = 0.0 if best is None else _width(best)
    fits = widest >= sides[0]
    data: dict[str, Any] = {"fits": fits, **shape_json(shape), "largest_width_mm": widest}
    if fits:
        return _Answer(key, True, f"Fits: {shape}.", data)
    found = workspace.fit(shape)
    side = "diameter" if key == "cylinder" else "first side"
    lines = [
        f"Does not fit: {shape}.",
        f"  It would have to shrink by {-found.clearance:.1f} mm on all sides; "
        f"{100 * found.unreached:.1f} % of it is out of reach.",
    ]
    if found.where is not None and found.limit is not None:
        place = ", ".join(f"{v:.1f}" for v in found.where.tolist())
        lines.append(f"  Worst at ({place}) mm: {_sentence(found.limit)}.")
    most = 0.0 if best is None else best.most
    lines.append(
        f"  Of this height the {side} may be {widest:.1f} mm"
        + (f" (none above {most:.1f} fits)." if best is not None else ".")
    )
    data |= {"clearance_mm": found.clearance, "unreached": found.unreached}
    data["where_mm"] = None if found.where is None else found.where.tolist()
    data["limit"] = None if found.limit is None else str(found.limit)
    return _Answer(key, False, "\n".join(lines), data)


def _floor(
    workspace: Workspace, height: float, best: Inscribed | None, options: argparse.Namespace
) -> float:
    if options.at is not None:
        return options.at
    if best is not None:
        return best.shape.floor
    low, high = float(workspace.extents.low[-1]), float(workspace.extents.high[-1])
    return (low + high - height) / 2


def _width(best: Inscribed) -> float:
    from deltaviz.robots.workspace import Cylinder

    return best.shape.diameter if isinstance(best.shape, Cylinder) else best.shape.size[0]


def _belt(workspace: Workspace, options: argparse.Namespace) -> _Answer:
    from deltaviz.robots.workspace import Belt

    width, height = [*options.belt, 0.0][:2]
    belt = Belt(width, height, options.at, axis="xy".index(options.along))
    found = workspace.serve(belt)
    data: dict[str, Any] = {
        "fits": found.fits,
        "from_mm": found.start,
        "to_mm": found.end,
        "stretch_mm": found.length,
        "widest_mm": found.widest if math.isfinite(found.widest) else None,
    }
    if found.fits:
        text = (
            f"Served: {belt}, over its whole width from {options.along} {found.start:.1f} to "
            f"{found.end:.1f} mm, a stretch of {found.length:.1f} mm."
        )
        return _Answer("belt", True, text, data)
    return _Answer("belt", False, _too_wide(workspace, belt, found.widest), data)


def _too_wide(workspace: Workspace, belt: Belt, widest: float) -> str:
    text = f"Not served over its whole width: {belt}."
    if not math.isfinite(widest) or widest <= 0:
        return f"{text}\n  At that height nothing in its middle is within reach."
    return f"{text}\n  At most {widest:.1f} mm are: it is {belt.width - widest:.1f} mm too wide."


def _print_answers(workspace: Workspace, answers: list[_Answer], *, as_json: bool) -> None:
    """Questions are answered alone: the rest takes longer."""
    from deltaviz.robots.workspace.report import limit_names

    if as_json:
        head = {"robot": workspace.robot.name, "limits": limit_names(workspace.limits)}
        data = head | {"empty": False} | {answer.key: answer.data for answer in answers}
        print(json.dumps(data, allow_nan=False))
        return
    for answer in answers:
        print(answer.text)


def _print_found(workspace: Workspace, options: argparse.Namespace) -> None:
    from deltaviz.robots.workspace.report import as_json, report

    found = report(workspace, floor=options.at, anywhere=options.anywhere, payload=options.payload)
    if options.json:
        print(json.dumps(as_json(found), allow_nan=False))
    else:
        _print_report(found)


def _print_report(found: Report) -> None:
    from deltaviz.robots.workspace.report import limit_names

    workspace = found.workspace
    planar = workspace.margins.dimensions == 2
    print(f"{workspace.robot.name}: tool tip, limits {', '.join(limit_names(workspace.limits))}")
    size = f"{workspace.volume / 100:.1f} cm²" if planar else f"{workspace.volume / 1e6:.3f} l"
    sides = zip(
        workspace.robot.axes, found.extents.low.tolist(), found.extents.high.tolist(), strict=True
    )
    print(f"{'Area' if planar else 'Volume'} {size}; boundary within "
          f"{workspace.boundary.deviation:.2f} mm, thinner than {workspace.boundary.cell:.1f} mm "
          "may be missing")  # fmt: skip
    print("; ".join(f"{axis} {lo:.1f} to {hi:.1f}" for axis, lo, hi in sides), "mm")
    print(f"Of its zone {100 * found.zone_reached:.1f} % is reached", end="")
    if found.parts is None:
        print()
    else:
        one, other = found.parts.parts
        print(f"; there its parts come no nearer than {found.parts.gap:.1f} mm ({one}, {other})")
    _print_reach(found)
    _print_inscribed(found.cylinder)
    _print_inscribed(found.box)
    _print_quality(found)
    _print_torques(found)


def _print_reach(found: Report) -> None:
    print("\n  Z mm   farthest  all around   nearest   (mm from the vertical axis)")
    for row in found.reach:
        farthest, nearest = (
            "      none" if v is None else f"{v:10.1f}" for v in (row.farthest, row.nearest)
        )
        print(f"{row.z:6.6g} {farthest} {row.all_around:11.1f} {nearest}")
    print()


def _print_inscribed(found: Inscribed | None) -> None:
    if found is not None:
        more = 100 * (found.most / found.shape.volume - 1)
        print(f"Largest: {found.shape} (none has over {more:.1f} % more)")


def _print_quality(found: Report) -> None:
    from deltaviz.robots.workspace.quality import UNITS

    print(f"\n{'':18}{'worst':>10}{'median':>10}{'best':>10}")
    for name, spread in found.quality.items():
        values = "".join(f"{v:10.3g}" for v in (spread.worst, spread.median, spread.best))
        print(f"{name.removesuffix('_deg').replace('_', ' '):18}{values}  {UNITS[name]}".rstrip())


def _print_torques(found: Report) -> None:
    if found.holding is None:
        print("\nTorques: the robot file has no [masses]")
        return
    print(
        f"\nHolding {found.payload:g} kg anywhere takes up to {found.holding.max():.3g} N m a joint"
    )
    if found.crossing is not None:
        moved = found.crossing
        print(
            f"Crossing its zone in {moved.duration:.2f} s, as its limits allow: peak "
            f"{moved.peak.max():.3g}, rms {moved.rms.max():.3g} N m"
        )


def _sentence(limit: Any) -> str:
    text = str(limit)
    return text[0].upper() + text[1:]


def _write(workspace: Workspace, options: argparse.Namespace) -> bool:
    """The files asked for; False, with the reason on stderr, if one could not be written."""
    from deltaviz.robots.workspace.export import write_csv, write_stl
    from deltaviz.robots.workspace.plot import PlotsMissing

    try:
        if options.csv:
            write_csv(workspace, options.csv, options.resolution or CSV_SPACING)
        if options.stl:
            write_stl(workspace, options.stl)
        if options.plot:
            workspace.plot(options.plot, colour=options.colour)
    except (OSError, PlotsMissing, ValueError) as error:
        print(f"deltaviz: {error}", file=sys.stderr)
        return False
    return True


def _flags(names: tuple[str, ...]) -> Limit:
    from deltaviz.robots.workspace import Limit

    flags = Limit.REACH
    for name in names:
        flags |= Limit[name.upper().replace("-", "_")]
    return flags


def _limits(text: str) -> tuple[str, ...]:
    names = tuple(part.strip() for part in text.split(",") if part.strip())
    for name in names:
        if name not in LIMITS:
            raise argparse.ArgumentTypeError(f"{name!r} is none of {', '.join(LIMITS)}")
    return names
