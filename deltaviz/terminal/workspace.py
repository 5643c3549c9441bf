"""`deltaviz workspace`: what a robot reaches, how well, and what fits inside."""

from __future__ import annotations

import argparse
import json
import math
import os
import sys
from typing import TYPE_CHECKING

from deltaviz.terminal.files import first_unwritable
from deltaviz.terminal.numbers import finite, not_negative, positive
from deltaviz.terminal.status import BAD_USAGE, FAILED, OK
from deltaviz.terminal.workspace_answers import Answer, answers

if TYPE_CHECKING:  # the command line starts before the layers it needs are known
    from deltaviz.robots import Robot
    from deltaviz.robots.workspace import Inscribed, Limit, Workspace
    from deltaviz.robots.workspace.report import Report

LIMITS = ("reach", "joints", "ball-joints", "singularities", "collisions", "zone")
MACHINE = LIMITS[:-1]
FINEST = 20_000  # resolutions in a forearm
CSV_SPACING = 10.0  # times the boundary's tolerance


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "--limits", type=_limits, default=MACHINE, metavar="LIST",
        help=f"what ends the workspace, of {','.join(LIMITS)} (all but zone; reach always counts)",
    )  # fmt: skip
    parser.add_argument(
        "--resolution", type=positive, metavar="MM",
        help="how near the boundary is to the true one (1, for small robots 1/150 of the forearm); "
        "spacing of the CSV's points (10 times that)",
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
        "--offset",
        type=finite,
        metavar="MM",
        help="where the belt's middle runs beside the axis (0)",
    )
    parser.add_argument(
        "--stretch", type=positive, metavar="MM", help="how much of the belt must be reached (any)"
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
    wrong = _wrong(options, planar=planar) or _too_fine(options.resolution, robot)
    if wrong is not None:
        print(f"deltaviz: {wrong}", file=sys.stderr)
        return BAD_USAGE
    files = {"--plot": options.plot, "--csv": options.csv, "--stl": options.stl}
    wrong = first_unwritable(files)  # asked before what takes seconds
    if wrong is not None:
        print(f"deltaviz: {wrong}", file=sys.stderr)
        return FAILED
    workspace = robot.workspace(
        _flags(options.limits), tolerance=options.resolution, threads=os.cpu_count() or 1
    )
    if workspace.empty:
        if options.json:
            print(json.dumps({"robot": robot.name, "empty": True, "reason": workspace.reason}))
        print(f"deltaviz: the workspace is empty. {workspace.reason}", file=sys.stderr)
        return FAILED
    asked = answers(workspace, options)
    if asked:
        _print_answers(workspace, asked, as_json=options.json)
    else:
        _print_found(workspace, options)
    written = _write(workspace, options)
    return OK if written and all(answer.fits for answer in asked) else FAILED


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
    if not options.belt and (options.offset is not None or options.stretch is not None):
        return f"{'--stretch' if options.offset is None else '--offset'} needs --belt"
    if planar and options.offset:
        return "--offset: this robot moves in the plane of x and z"
    if planar and options.belt and options.along == "y":
        return "--along y: this robot moves in the plane of x and z"
    if planar and options.stl:
        return "--stl: a workspace in a plane has no surface"
    if options.colour and not options.plot:
        return "--colour needs --plot FILE"
    return _unknown_colour(options.colour)


def _too_fine(resolution: float | None, robot: Robot) -> str | None:
    finest = max(robot.mechanism.forearm) / FINEST
    if resolution is None or resolution >= finest:
        return None
    return (
        f"--resolution {resolution:g}: at least {finest:.2g} mm, 1/{FINEST} of the forearm: "
        "finer takes more memory and time than there is"
    )


def _unknown_colour(colour: str | None) -> str | None:
    if colour is None:
        return None
    from deltaviz.robots.workspace.quality import Quality

    known = Quality.measures()
    return None if colour in known else f"--colour {colour}: use one of {', '.join(known)}"


def _print_answers(workspace: Workspace, asked: list[Answer], *, as_json: bool) -> None:
    """Questions are answered alone: the rest takes longer."""
    from deltaviz.robots.workspace.report import limits_json

    if as_json:
        head = {"robot": workspace.robot.name, **limits_json(workspace), "empty": False}
        print(json.dumps(head | {answer.key: answer.data for answer in asked}, allow_nan=False))
        return
    for answer in asked:
        print(answer.text)
    _print_not_considered(workspace)


def _print_not_considered(workspace: Workspace) -> None:
    from deltaviz.robots.workspace.report import limit_name

    for limit, why in workspace.not_considered.items():
        print(f"Not considered: {limit_name(limit)}; {why}.")


def _print_found(workspace: Workspace, options: argparse.Namespace) -> None:
    from deltaviz.robots.workspace.report import as_json, report

    found = report(workspace, floor=options.at, anywhere=options.anywhere, payload=options.payload)
    if options.json:
        print(json.dumps(as_json(found), allow_nan=False))
    else:
        _print_report(found)


def _print_report(found: Report) -> None:
    from deltaviz.robots.workspace.report import limit_names
    from deltaviz.robots.workspace.size_text import size_text

    workspace = found.workspace
    planar = workspace.margins.dimensions == 2
    print(
        f"{workspace.robot.name}: tool tip, limits {', '.join(limit_names(workspace.considered))}"
    )
    _print_not_considered(workspace)
    size = size_text(workspace.volume, dimensions=workspace.margins.dimensions)
    digits = _digits(workspace.tolerance)
    sides = zip(
        workspace.robot.axes, found.extents.low.tolist(), found.extents.high.tolist(), strict=True
    )
    print(f"{'Area' if planar else 'Volume'} {size}; boundary within "
          f"{workspace.boundary.deviation:.{digits + 1}f} mm, thinner than "
          f"{workspace.boundary.cell:.{digits}f} mm "
          "may be missing")  # fmt: skip
    spans = (f"{axis} {lo:.{digits}f} to {hi:.{digits}f}" for axis, lo, hi in sides)
    print("; ".join(spans), "mm")
    print(f"Of its zone {100 * found.zone_reached:.1f} % is reached", end="")
    if found.parts is None:
        print()
    else:
        one, other = found.parts.parts
        gap = f"{found.parts.gap:.{digits}f} mm"
        print(f"; there its parts come no nearer than {gap} ({one}, {other})")
    _print_reach(found)
    _print_inscribed(found.cylinder)
    _print_inscribed(found.box)
    _print_quality(found)
    _print_torques(found)


def _print_reach(found: Report) -> None:
    digits = _digits(found.workspace.tolerance)
    print("\n  Z mm   farthest  all around   nearest   (mm from the vertical axis)")
    for row in found.reach:
        farthest, nearest = (
            "      none" if v is None else f"{v:10.{digits}f}" for v in (row.farthest, row.nearest)
        )
        print(f"{row.z:6.6g} {farthest} {row.all_around:11.{digits}f} {nearest}")
    print()


def _digits(tolerance: float) -> int:
    """Behind the point, of lengths that are within a tolerance."""
    return max(1, math.ceil(-math.log10(tolerance)))


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
    if found.crossing is None:
        print(f"Not crossing its zone: {found.not_crossed}")
        return
    moved, fastest = found.crossing, math.degrees(found.crossing.fastest.max())
    print(
        f"Crossing its zone in {moved.duration:.2f} s, as its limits allow: peak "
        f"{moved.peak.max():.3g}, rms {moved.rms.max():.3g} N m, {fastest:.3g} °/s"
    )


def _write(workspace: Workspace, options: argparse.Namespace) -> bool:
    """The files asked for; False, with the reason on stderr, if one could not be written."""
    from deltaviz.robots.workspace.export import write_csv, write_stl
    from deltaviz.robots.workspace.field import TooFine
    from deltaviz.robots.workspace.plot import PlotsMissing

    try:
        if options.csv:
            write_csv(
                workspace, options.csv, options.resolution or CSV_SPACING * workspace.tolerance
            )
        if options.stl:
            write_stl(workspace, options.stl)
        if options.plot:
            workspace.plot(options.plot, colour=options.colour)
    except TooFine as error:
        print(f"deltaviz: --resolution: {error}", file=sys.stderr)
        return False
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
