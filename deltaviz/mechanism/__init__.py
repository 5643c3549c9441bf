"""The pure mathematics of each kind of robot: inverse, forward, Jacobian, margins."""

from deltaviz.mechanism.five_bar import FiveBar
from deltaviz.mechanism.geometry import GeometryError
from deltaviz.mechanism.kernel import Kernel
from deltaviz.mechanism.margin import Margin, MarginKind
from deltaviz.mechanism.mechanism import Mechanism
from deltaviz.mechanism.rotary_delta import RotaryDelta

__all__ = [
    "FiveBar",
    "GeometryError",
    "Kernel",
    "Margin",
    "MarginKind",
    "Mechanism",
    "RotaryDelta",
]
