"""What a robot reaches, and how well.

`Robot.workspace()` gives a `Workspace`; `levels` its boundary, coarse at once and then finer.
"""

from deltaviz.robots.workspace.boundary import Boundary
from deltaviz.robots.workspace.extent import ReachAtHeight
from deltaviz.robots.workspace.fit import Fit
from deltaviz.robots.workspace.levels import levels
from deltaviz.robots.workspace.limits import Limit
from deltaviz.robots.workspace.margins import Margins
from deltaviz.robots.workspace.quality import Quality, quality
from deltaviz.robots.workspace.shapes import Belt, Cuboid, Cylinder
from deltaviz.robots.workspace.stretch import Stretch
from deltaviz.robots.workspace.workspace import Empty, Inscribed, Workspace, own_tolerance

__all__ = [
    "Belt",
    "Boundary",
    "Cuboid",
    "Cylinder",
    "Empty",
    "Fit",
    "Inscribed",
    "Limit",
    "Margins",
    "Quality",
    "ReachAtHeight",
    "Stretch",
    "Workspace",
    "levels",
    "own_tolerance",
    "quality",
]
