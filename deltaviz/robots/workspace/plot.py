"""Pictures of a workspace: in space, and looked at along each axis."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from deltaviz.mechanism.arrays import Array
from deltaviz.robots.workspace.quality import UNITS, WORSE_ABOVE, Quality
from deltaviz.robots.workspace.size_text import size_text
from deltaviz.robots.workspace.workspace import Empty, Workspace

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.cm import ScalarMappable
    from matplotlib.figure import Figure

SURFACE, EDGE, ZONE, ARMS = "#5b8db8", "#24506f", "#c26a1b", "#444444"
SECTION_NODES = 240  # along the longest side
VIEWS = (("XOZ", 0, 2), ("YOZ", 1, 2), ("XOY", 0, 1))
ENDS = 2.0, 98.0  # percentiles between which colours are told apart


class PlotsMissing(ImportError):
    """matplotlib is not installed."""


def plot(workspace: Workspace, path: str | None = None, *, colour: str | None = None) -> Figure:
    """See `Workspace.plot`. Raises PlotsMissing, Empty, and ValueError for an unknown measure."""
    try:
        import matplotlib.figure  # noqa: F401
    except ImportError as error:
        raise PlotsMissing(
            "pictures need matplotlib: install it with `pip install 'deltaviz[plot]'`"
        ) from error
    if colour is not None and colour not in Quality.measures():
        raise ValueError(f"no measure {colour!r}; there are {', '.join(Quality.measures())}")
    if workspace.empty:
        raise Empty(workspace.reason)
    from deltaviz.robots.workspace.figure import DPI, ShownFigure

    colours = None if colour is None else _Colours.of(workspace, colour)
    if workspace.margins.dimensions == 2:
        figure = ShownFigure(figsize=(7.0, 6.0), layout="constrained")
        _planar(workspace, figure.add_subplot(), colours)
    else:
        figure = ShownFigure(figsize=(11.0, 9.5), layout="constrained")
        _space(workspace, figure.add_subplot(2, 2, 1, projection="3d"), colours)
        for place, view in enumerate(VIEWS, start=2):
            _view(workspace, figure.add_subplot(2, 2, place), view, colours)
    if colours is not None:
        figure.colorbar(colours.key, ax=figure.axes, shrink=0.6)
    figure.suptitle(_title(workspace, colour))
    if path is not None:
        figure.savefig(path, dpi=DPI, bbox_inches="tight")
    return figure


@dataclass(frozen=True)
class _Colours:
    """One scale for all that is drawn; `key` maps the measure's values to colours."""

    measure: str
    key: ScalarMappable

    @classmethod
    def of(cls, workspace: Workspace, measure: str) -> _Colours:
        from matplotlib.cm import ScalarMappable
        from matplotlib.colors import Normalize

        values = getattr(workspace.quality(), measure)
        low, high = np.nanpercentile(values, ENDS).tolist()
        scheme = "viridis_r" if measure in WORSE_ABOVE else "viridis"
        return cls(measure, ScalarMappable(Normalize(low, high), scheme))

    def values(self, workspace: Workspace, points: Array) -> Array:
        return np.asarray(getattr(workspace.quality(points), self.measure))

    @property
    def style(self) -> dict[str, Any]:
        return {"cmap": self.key.cmap, "norm": self.key.norm}


def _title(workspace: Workspace, colour: str | None) -> str:
    size = size_text(workspace.volume, dimensions=workspace.margins.dimensions)
    name = f"{workspace.robot.name}: reached by the tool tip, {size}"
    if colour is None:
        return name
    unit = f" ({UNITS[colour]})" if UNITS[colour] else ""
    return f"{name}\ncolours: {colour.replace('_deg', '').replace('_', ' ')}{unit}"


def _space(workspace: Workspace, axes: Any, colours: _Colours | None) -> None:
    vertices, faces = workspace.boundary.vertices, workspace.boundary.faces
    style = {"color": SURFACE} if colours is None else colours.style
    surface = axes.plot_trisurf(
        *vertices.T, triangles=faces, edgecolor="none", linewidth=0, alpha=0.85, **style
    )
    if colours is not None:
        surface.set_array(_of_faces(colours.values(workspace, vertices)[faces]))
    theta = np.array(workspace.robot.homing.ready)
    for line in _arms(workspace, theta, workspace.robot.forward(theta)):
        axes.plot(*line.T, color=ARMS, linewidth=1.2)
    box = workspace.extents
    axes.set_box_aspect(np.maximum(box.size, 1.0))
    axes.locator_params(nbins=5)
    axes.set(title="3D")
    for letter in "xyz":
        getattr(axes, f"set_{letter}label")(f"{letter.upper()} mm", labelpad=12)
    axes.view_init(elev=18, azim=-60)


def _of_faces(corners: Array) -> Array:
    """The mean of (n, 3) corners, of those that have a value: some lie just out of reach."""
    known = np.isfinite(corners)
    total = np.where(known, corners, 0.0).sum(axis=1)
    return np.where(known.any(axis=1), total / np.maximum(known.sum(axis=1), 1), np.nan)


def _view(
    workspace: Workspace, axes: Axes, view: tuple[str, int, int], colours: _Colours | None
) -> None:
    name, across, up = view
    third = 3 - across - up
    level = _level(workspace, third)
    if colours is None:
        _silhouette(workspace, axes, across, up)
    _section(workspace, axes, (across, up), third, level, colours)
    _zone(workspace, axes, across, up)
    theta = np.array(workspace.robot.homing.ready)
    for line in _arms(workspace, theta, workspace.robot.forward(theta)):
        axes.plot(line[:, across], line[:, up], color=ARMS, linewidth=1.0, alpha=0.7)
    letters = "XYZ"
    axes.set_aspect("equal")
    axes.set(xlabel=f"{letters[across]} mm", ylabel=f"{letters[up]} mm")
    shown = "section" if colours else "outline, and section"
    axes.set_title(f"{name}: {shown} at {letters[third]} {level:.4g} mm")
    axes.grid(alpha=0.25)


def _level(workspace: Workspace, axis: int) -> float:
    """Where to cut: through the vertical line, or at the height that is widest."""
    if axis != workspace.margins.dimensions - 1:
        return 0.0
    rows = [row for row in workspace.reach() if row.farthest is not None]
    widest = max(rows, key=lambda row: (row.all_around, row.farthest or 0.0))
    return widest.z


def _silhouette(workspace: Workspace, axes: Axes, across: int, up: int) -> None:
    from matplotlib.collections import PolyCollection

    corners = workspace.boundary.vertices[workspace.boundary.faces][..., [across, up]]
    axes.add_collection(
        PolyCollection(list(corners), facecolors=SURFACE, edgecolors=SURFACE, lw=0.3)
    )
    axes.autoscale_view()


def _section(
    workspace: Workspace,
    axes: Axes,
    along: tuple[int, int],
    third: int | None,
    level: float,
    colours: _Colours | None,
) -> None:
    """The boundary in one plane; and with a measure its colours inside."""
    dimensions = workspace.margins.dimensions
    box = workspace.extents
    step = float(box.size.max()) / SECTION_NODES
    first, second = (
        np.arange(box.low[axis] - 2 * step, box.high[axis] + 3 * step, step) for axis in along
    )
    points = np.empty((len(second), len(first), dimensions))
    if third is not None:
        points[..., third] = level
    points[..., along[0]], points[..., along[1]] = first, second[:, None]
    margin = workspace.margins.least(points)
    axes.contour(first, second, margin, levels=[0.0], colors=EDGE, linewidths=1.2)
    if colours is None or not (margin >= 0).any():
        return
    value = np.where(margin >= 0, colours.values(workspace, points), np.nan)
    axes.pcolormesh(first, second, value, rasterized=True, **colours.style)


def _zone(workspace: Workspace, axes: Axes, across: int, up: int) -> None:
    """What the robot file allows, dashed."""
    from matplotlib.patches import Circle, Rectangle

    zone = workspace.robot.zone
    style = {"fill": False, "linestyle": "--", "edgecolor": ZONE, "linewidth": 1.0}
    radius = zone.radius
    ranges = {0: zone.x, 1: zone.y, 2: zone.z}
    for axis in (0, 1):
        if ranges[axis] is None and radius is not None:
            ranges[axis] = (-radius, radius)
    first, second = ranges[across], ranges[up]
    if radius is not None and up != 2:
        axes.add_patch(Circle((0.0, 0.0), radius, **style))
    elif first is not None and second is not None:
        width, height = first[1] - first[0], second[1] - second[0]
        axes.add_patch(Rectangle((first[0], second[0]), width, height, **style))


def _planar(workspace: Workspace, axes: Axes, colours: _Colours | None) -> None:
    boundary = workspace.boundary
    if colours is None:
        from matplotlib.collections import LineCollection

        lines = boundary.vertices[boundary.faces]
        axes.add_collection(LineCollection(list(lines), colors=EDGE, linewidths=1.5))
        axes.autoscale_view()
    _section(workspace, axes, (0, 1), None, 0.0, colours)
    zone, theta = workspace.robot.zone, np.array(workspace.robot.homing.ready)
    if zone.x is not None:
        from matplotlib.patches import Rectangle

        (x0, x1), (z0, z1) = zone.x, zone.z
        axes.add_patch(
            Rectangle((x0, z0), x1 - x0, z1 - z0, fill=False, linestyle="--", edgecolor=ZONE)
        )
    for line in _arms(workspace, theta, workspace.robot.forward(theta)):
        axes.plot(line[:, 0], line[:, 1], color=ARMS, linewidth=1.2)
    axes.set_aspect("equal")
    axes.set(xlabel="X mm", ylabel="Z mm")
    axes.grid(alpha=0.25)


def _arms(workspace: Workspace, theta: Array, tip: Array) -> list[Array]:
    """Each arm from its motor over its elbow to the effector's joint, and to the tool tip."""
    from deltaviz.mechanism import FiveBar

    mechanism = workspace.robot.mechanism
    offset = np.array(workspace.robot.tool_offset)
    centre, out = tip - offset, []
    planar = isinstance(mechanism, FiveBar)
    bases = mechanism.base_half if planar else mechanism.base_radius  # type: ignore[attr-defined]
    wrists = mechanism.platform_half if planar else mechanism.effector_radius  # type: ignore[attr-defined]
    elbows = mechanism.elbows(theta[: mechanism.joints])  # type: ignore[attr-defined]
    for i, arm in enumerate(mechanism.arms):  # type: ignore[attr-defined]
        outward = np.array((arm.cos, 0.0)) if planar else np.array((arm.cos, arm.sin, 0.0))
        wrist = centre + wrists[i] * outward
        out.append(
            np.stack((bases[i] * outward, elbows[i] + wrists[i] * outward, wrist, centre, tip))
        )
    return out
