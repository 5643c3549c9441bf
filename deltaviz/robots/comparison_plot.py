"""Two robots' workspaces in one picture, to one scale, coloured alike."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from deltaviz.mechanism.arrays import Array
from deltaviz.robots.workspace.plot import PlotsMissing
from deltaviz.robots.workspace.quality import UNITS
from deltaviz.robots.workspace.workspace import Workspace

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from deltaviz.robots.comparison import Comparison
    from deltaviz.robots.workspace.report import Report

NODES = 260  # along the longest side of both
COLOURS = "#1d4ed8", "#c2410c"
ENDS = 2.0, 98.0  # percentiles between which colours are told apart
MEASURES = "condition", "resolution"


def plot(comparison: Comparison, path: str) -> Figure:
    """Outlines over each other, and below them each robot's section, coloured by conditioning and
    by resolution. Raises PlotsMissing, and what writing the file raises."""
    try:
        from matplotlib.figure import Figure
    except ImportError as error:
        raise PlotsMissing(
            "pictures need matplotlib: install it with `pip install 'deltaviz[plot]'`"
        ) from error
    figure = Figure(figsize=(11.0, 12.5), layout="constrained")
    axes = figure.subplots(3, 2)
    both = [found.workspace for found in comparison.reports]
    grid = _grid(both, up=True)
    _outlines(axes[0][0], comparison, grid, "section at Y = 0")
    spatial = [workspace.margins.dimensions == 3 for workspace in both]
    if all(spatial):
        _outlines(axes[0][1], comparison, _grid(both, up=False), "from above, where it is widest")
    else:
        axes[0][1].set_axis_off()
    for row, measure in zip(axes[1:], MEASURES, strict=True):
        _coloured(figure, row, both, grid, measure)
    figure.suptitle(f"{comparison.names[0]} and {comparison.names[1]}")
    figure.savefig(path, dpi=120)
    return figure


def _grid(both: list[Workspace], *, up: bool) -> tuple[Array, Array]:
    """(x, z) nodes that hold both, or (x, y) ones."""
    second = -1 if up else 1
    low = np.min([w.extents.low[[0, second]] for w in both], axis=0)
    high = np.max([w.extents.high[[0, second]] for w in both], axis=0)
    step = float((high - low).max()) / NODES
    first, other = (
        np.arange(a - 3 * step, b + 4 * step, step) for a, b in zip(low, high, strict=True)
    )
    return first, other


def _points(workspace: Workspace, grid: tuple[Array, Array], level: float | None) -> Array:
    """(m, n, d): at y = 0, or from above at the height `level`."""
    first, second = np.meshgrid(*grid)
    zero = np.zeros_like(first)
    if workspace.margins.dimensions == 2:
        return np.stack((first, second), axis=-1)
    if level is None:
        return np.stack((first, zero, second), axis=-1)
    return np.stack((first, second, zero + level), axis=-1)


def _outlines(axes: Any, comparison: Comparison, grid: tuple[Array, Array], title: str) -> None:
    from matplotlib.lines import Line2D

    above = title.startswith("from above")
    handles: list[Line2D] = []
    for found, colour in zip(comparison.reports, COLOURS, strict=True):
        level = _widest(found) if above else None
        margin = found.workspace.margins.least(_points(found.workspace, grid, level))
        axes.contourf(*grid, margin, levels=[0.0, np.inf], colors=[colour], alpha=0.12)
        axes.contour(*grid, margin, levels=[0.0], colors=colour, linewidths=1.4)
        name = found.workspace.robot.name + (f", Z {level:g} mm" if level is not None else "")
        handles.append(Line2D([], [], color=colour, label=name))
    axes.legend(handles=handles, loc="best", fontsize=8)
    _frame(axes, title, "Y" if above else "Z")


def _widest(found: Report) -> float:
    """The height (z, mm) at which it reaches furthest all around."""
    rows = [(row.all_around, row.farthest or 0.0, row.z) for row in found.reach]
    middle = float(found.extents.low[-1] + found.extents.high[-1]) / 2
    return max(rows, default=(0.0, 0.0, middle))[-1]


def _coloured(
    figure: Figure, row: Any, both: list[Workspace], grid: tuple[Array, Array], measure: str
) -> None:
    values: list[Array] = []
    for workspace in both:
        points = _points(workspace, grid, None)
        value = getattr(workspace.quality(points), measure)
        values.append(np.where(workspace.margins.least(points) >= 0, value, np.nan))
    low, high = np.nanpercentile(np.concatenate([value.ravel() for value in values]), ENDS)
    pictures = [
        axes.pcolormesh(*grid, value, cmap="viridis_r", vmin=low, vmax=high, rasterized=True)
        for axes, value in zip(row, values, strict=True)
    ]
    for axes, workspace in zip(row, both, strict=True):
        _frame(axes, f"{workspace.robot.name}: {measure}", "Z")
    figure.colorbar(pictures[0], ax=row, shrink=0.85, label=UNITS[measure])


def _frame(axes: Any, title: str, up: str) -> None:
    axes.set_aspect("equal")
    axes.set(title=title, xlabel="X mm", ylabel=f"{up} mm")
    axes.grid(alpha=0.25)
