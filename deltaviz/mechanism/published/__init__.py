"""The sources' own methods, corrected: a second opinion on ours.

They share no formula with `RotaryDelta` and `FiveBar`, and only `verify` and the tests use them:
each is slower, or fails somewhere that ours does not, as its docstring says.
docs/kinematics.md tells where the sources' own text differs.
"""

from deltaviz.mechanism.published.cosine_rule import cosine_rule
from deltaviz.mechanism.published.elbow_line import elbow_line
from deltaviz.mechanism.published.eliminated import circles_eliminated, spheres_eliminated
from deltaviz.mechanism.published.half_angle import half_angle
from deltaviz.mechanism.published.legs import Leg, elbow_centres, legs_of
from deltaviz.mechanism.published.newton import newton
from deltaviz.mechanism.published.tetrahedron import tetrahedron

__all__ = [
    "Leg",
    "circles_eliminated",
    "cosine_rule",
    "elbow_centres",
    "elbow_line",
    "half_angle",
    "legs_of",
    "newton",
    "spheres_eliminated",
    "tetrahedron",
]
