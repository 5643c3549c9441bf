"""`deltaviz compare`: two robots side by side, as a table, JSON and a picture."""

from __future__ import annotations

import argparse
import json
import sys
from typing import TYPE_CHECKING

from deltaviz.terminal.files import first_unwritable
from deltaviz.terminal.numbers import not_negative, positive
from deltaviz.terminal.status import FAILED, OK

if TYPE_CHECKING:
    from deltaviz.robots import Robot
    from deltaviz.robots.comparison import Comparison, Row


def add_arguments(parser: argparse.ArgumentParser) -> None:
    for which in ("first", "second"):
        parser.add_argument(which, metavar="NAME|FILE", help="preset or robot file")
    parser.add_argument(
        "--resolution", type=positive, metavar="MM",
        help="how near the boundaries are to the true ones (1/150 of the forearm)",
    )  # fmt: skip
    parser.add_argument(
        "--payload", type=not_negative, default=0.0, metavar="KG", help="for the torques (0)"
    )
    parser.add_argument("--plot", metavar="FILE", help="write a picture (.png, .svg, .pdf)")


def run(one: Robot, other: Robot, options: argparse.Namespace) -> int:
    """Status 1 if a workspace is empty or the picture cannot be written."""
    from deltaviz.robots.comparison import compare, measure
    from deltaviz.robots.workspace import Empty
    from deltaviz.robots.workspace.plot import PlotsMissing

    wrong = first_unwritable({"--plot": options.plot})  # asked before what takes seconds
    if wrong is not None:
        print(f"deltaviz: {wrong}", file=sys.stderr)
        return FAILED
    try:
        found = compare(
            *(
                measure(robot, tolerance=options.resolution, payload=options.payload)
                for robot in (one, other)
            )
        )
    except Empty as error:
        print(f"deltaviz: a workspace is empty. {error}", file=sys.stderr)
        return FAILED
    print(as_json(found) if options.json else text(found))
    if options.plot is None:
        return OK
    from deltaviz.robots.comparison_plot import plot

    try:
        plot(found, options.plot)
    except (OSError, PlotsMissing, ValueError) as error:
        print(f"deltaviz: {error}", file=sys.stderr)
        return FAILED
    return OK


def text(found: Comparison) -> str:
    names = [name if len(name) <= 14 else f"{name[:13]}…" for name in found.names]
    width = max(len(row.what) for row in found.rows)
    head = f"{'':<{width}}  {names[0]:>14}  {names[1]:>14}  second/first"
    lines = [_row(row, width) for row in found.rows]
    return "\n".join([head, *lines, "", *_notes(found)])


def as_json(found: Comparison) -> str:
    """Two keys for the robots' measures, by position: both may have one name."""
    sides = [
        {row.key: row.values[i] for row in found.rows if row.values[i] is not None}
        for i in range(2)
    ]
    return json.dumps(
        {
            "robots": list(found.names),
            "first": sides[0],
            "second": sides[1],
            "second_over_first": {
                row.key: row.ratio for row in found.rows if row.ratio is not None
            },
        },
        allow_nan=False,
    )


def _row(row: Row, width: int) -> str:
    one, other = ("-" if value is None else f"{value:.4g}" for value in row.values)
    ratio = "" if row.ratio is None else f"{row.ratio:.3g}"
    return f"{row.what:<{width}}  {one:>14}  {other:>14}  {ratio:>12}  {row.unit}".rstrip()


def _notes(found: Comparison) -> list[str]:
    notes = ["Resolution: what the tip moves for one microstep, in its worst direction."]
    lacking = [r.workspace.robot.name for r in found.reports if r.holding is None]
    if lacking:
        notes.append(f"No torques of {' and '.join(lacking)}: the robot file has no [masses].")
    return notes
