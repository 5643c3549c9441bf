"""Draws the figures of kinematics.md from the kinematics itself.

python docs/figures.py          write docs/figures/*.svg
python docs/figures.py --check  status 1 and the names of the figures that are not today's
"""

from __future__ import annotations

import math
import sys
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
from drawing import BLUE, FILL, GREEN, INK, ORANGE, PALE, RED, SOFT, Drawing

from deltaviz import load_robot
from deltaviz.mechanism import FiveBar, RotaryDelta
from deltaviz.mechanism.published import elbow_centres, legs_of

FOLDER = Path(__file__).parent / "figures"
STM32 = RotaryDelta(base_radius=115, effector_radius=75, upper_arm=125, forearm=338)
DASH = "5 4"
OBTUSE_DEG = (42.0, 42.0, 105.0)


def plan() -> Drawing:
    """From above: what moving the elbows inward by the effector's radius does."""
    at = np.array([35.0, -25.0, -300.0])
    theta = STM32.inverse(at)
    d = Drawing(-265, 300, -245, 235, width=620)
    d.circle((0, 0), 115, colour=PALE)
    d.circle(at[:2], 75, colour=PALE)
    d.arrow((0, 0), (290, 0), colour=SOFT)
    d.arrow((0, 0), (0, 225), colour=SOFT)
    d.word((290, 0), "x", dy=7, dx=-4, colour=SOFT)
    d.word((0, 225), "y", dx=7, dy=-8, colour=SOFT)
    moved = STM32.elbows(theta)
    for i, arm in enumerate(STM32.arms):
        out, side = np.array([arm.cos, arm.sin]), np.array([-arm.sin, arm.cos])
        motor, joint = 115 * out, at[:2] + 75 * out
        elbow = motor + 125 * math.cos(theta[i]) * out
        d.line(motor - 24 * side, motor + 24 * side, width=6)
        d.line(motor, elbow, width=4)
        d.line(at[:2], joint, colour=SOFT, width=3)
        for half in (-18, 18):
            d.line(elbow + half * side, joint + half * side, colour=BLUE, width=2)
        d.line(elbow - 18 * side, elbow + 18 * side, colour=BLUE, width=2)
        d.line(joint - 18 * side, joint + 18 * side, colour=BLUE, width=2)
        d.line(moved[i, :2], at[:2], colour=ORANGE, dash=DASH, width=2)
        d.arrow(elbow, moved[i, :2], colour=ORANGE)
        d.dot(moved[i, :2], colour=ORANGE)
        d.word(moved[i, :2], f"D{'₁₂₃'[i]}", dx=5, dy=-18, colour=ORANGE)
    one = STM32.arms[1]
    d.arc((0, 0), 42, 0, 120)
    d.word((22, 40), "ψ₂", colour=SOFT)
    d.line((0, 0), (115 * one.cos, 115 * one.sin), colour=SOFT, dash="2 4")
    d.word((60 * one.cos, 60 * one.sin), "R", dx=-16, colour=SOFT)
    d.word(at[:2] + 40 * np.array([math.cos(4.19), math.sin(4.19)]), "r", dx=8, colour=SOFT)
    d.dot(at[:2], colour=INK)
    d.word(at[:2], "P", dx=8, dy=5)
    return d


def arm() -> Drawing:
    """One arm in its own plane: two circles that meet in two elbows."""
    upper, fore, side = 125.0, 338.0, 90.0
    p, z = 160.0, -285.0
    seen = math.sqrt(fore**2 - side**2)
    k = (p * p + side * side + z * z + upper**2 - fore**2) / (2 * upper)
    rho = math.hypot(p, z)
    q = math.sqrt(rho**2 - k * k)
    turns = [math.atan2(-z * k - s * p * q, p * k - s * z * q) for s in (1, -1)]
    outside, inside = [(upper * math.cos(t), -upper * math.sin(t)) for t in turns]
    foot = (p / rho * upper * k / rho, z / rho * upper * k / rho)
    d = Drawing(-190, 390, -315, 150, width=660)
    d.arrow((-150, 0), (370, 0), colour=PALE)
    d.arrow((0, -300), (0, 145), colour=PALE)
    d.word((370, 0), "outward", dx=-58, dy=6, colour=SOFT, size=13)
    d.word((0, 145), "z", dx=6, dy=-8, colour=SOFT)
    d.circle((0, 0), upper)
    towards = math.degrees(math.atan2(outside[1] - z, outside[0] - p))
    back = math.degrees(math.atan2(inside[1] - z, inside[0] - p))
    d.arc((p, z), seen, towards - 14, back + 12)
    d.line((0, 0), (p, z), colour=SOFT, dash="2 4")
    d.line(outside, inside, colour=SOFT, dash="2 4")
    for elbow, colour, dash in ((outside, BLUE, ""), (inside, ORANGE, DASH)):
        d.line((0, 0), elbow, colour=colour, width=3.5, dash=dash)
        d.line(elbow, (p, z), colour=colour, width=2, dash=dash)
        d.dot(elbow, colour=colour)
    d.arc((0, 0), 52, 0, -math.degrees(turns[0]), colour=BLUE)
    half = -turns[0] / 2
    d.word((56 * math.cos(half), 56 * math.sin(half)), "θ", dx=3, dy=-6, colour=BLUE)
    d.dot((0, 0))
    d.dot((p, z))
    d.word((0, 0), "motor", dx=-48, dy=8, size=13)
    d.word((p, z), "P", dx=9, dy=-4)
    d.word((p, z), "(p, z), and v out of the picture", dx=26, dy=-4, size=13, colour=SOFT)
    d.word(_middle((0, 0), outside), "L", dx=-4, dy=9, colour=BLUE)
    d.word(_middle(outside, (p, z)), "√(l² − v²)", dx=8, dy=0, colour=BLUE)
    d.word(outside, "elbow outside", dx=10, dy=-16, colour=BLUE, size=13)
    d.word(inside, "elbow inside", dx=-30, dy=-22, colour=ORANGE, size=13)
    d.dot(foot, colour=SOFT, size=2.5)
    d.word(_middle((0, 0), foot), "LK/ρ", dx=6, dy=-14, colour=SOFT, size=13)
    d.word(_middle(foot, outside), "Lq/ρ", dx=-2, dy=-16, colour=SOFT, size=13)
    d.word(_middle((p, z), foot), "ρ", dx=8, dy=0, colour=SOFT, size=13)
    return d


def elbows() -> Drawing:
    """The triangle of elbow centres in its own plane, obtuse at D3."""
    centres = elbow_centres(legs_of(STM32), np.radians(OBTUSE_DEG))
    along = centres[1] - centres[0]
    along /= np.linalg.norm(along)
    across = centres[2] - centres[0]
    across -= across @ along * along
    across /= np.linalg.norm(across)
    one, two, three = [
        np.array([(c - centres[0]) @ along, (c - centres[0]) @ across]) for c in centres
    ]
    middle = (one + two) / 2
    x, y = three
    from_middle = (x * x + y * y - two[0] * x) / (2 * y)  # |EF|, signed: E is as far from all
    offset = np.array([0.0, from_middle])
    true, false = middle + offset, middle - offset
    radius = float(np.linalg.norm(one - true))
    d = Drawing(-30, two[0] + 30, from_middle - 25, max(y, -from_middle) + 25, width=560)
    d.area(one, two, three, fill=FILL)
    d.arc(true, radius, 10, 170, colour=SOFT)
    d.line(middle, true, colour=BLUE, width=2)
    d.line(middle, false, colour=RED, width=2, dash=DASH)
    for corner in (one, two, three):
        d.line(true, corner, colour=BLUE, width=1, dash="2 4")
    for at, name, dx, dy in ((one, "D₁", -24, -12), (two, "D₂", 6, -12), (three, "D₃", -8, 9)):
        d.dot(at)
        d.word(at, name, dx=dx, dy=dy)
    d.dot(middle, colour=SOFT)
    d.word(middle, "F", dx=8, dy=5, colour=SOFT)
    d.dot(true, colour=BLUE)
    d.word(true, "E, the circumcentre", dx=9, dy=-5, colour=BLUE)
    d.dot(false, colour=RED)
    d.word(false, "E with |FE| taken as positive", dx=9, dy=-8, colour=RED)
    return d


def singular() -> Drawing:
    """A five-bar at type 1, straight and folded, and at type 2."""
    robot = FiveBar(base_half=60, platform_half=0, upper_arm=100, forearm=130)
    d = Drawing(-150, 810, -300, 105, width=860)
    reach = math.asin(60 / 230)
    cases = [
        ("type 1, straight: no further out", (0.0, -230 * math.cos(reach)), None),
        ("type 1, folded: no nearer", (60.0, -30.0), None),
        ("type 2: held in line only", None, math.acos(0.7)),
    ]
    for i, (title, place, angle) in enumerate(cases):
        shift = np.array([330.0 * i, 0.0])
        if place is not None:
            theta = robot.nearest_angles(place)
            if i == 1:
                theta[1] = math.pi / 2
            at = np.array(place)
        else:
            theta = np.array([angle, angle])
            at = np.array([0.0, -100 * math.sin(angle or 0.0)])
        both = robot.elbows(theta)
        for side, elbow in zip((-60.0, 60.0), both, strict=True):
            d.line(np.array([side, 0]) + shift, elbow + shift, width=4)
            d.line(elbow + shift, at + shift, colour=BLUE, width=2.5)
            d.dot(np.array([side, 0]) + shift)
            d.dot(elbow + shift, colour=BLUE)
        d.line(np.array([-60, 0]) + shift, np.array([60, 0]) + shift, colour=PALE, width=3)
        d.dot(at + shift, colour=ORANGE, size=5)
        for way in [(-60,), (60,), (55, -55)][i]:
            d.arrow(at + shift, at + shift + [0, way], colour=RED, width=2)
        d.word(np.array([0, 80]) + shift, title, size=13, anchor="middle")
    return d


def five_bar() -> Drawing:
    """The planar delta: frame, platform, both working modes, both assemblies."""
    robot = FiveBar(base_half=80, platform_half=20, upper_arm=100, forearm=200)
    at, half = np.array([35.0, -190.0]), np.array([20.0, 0.0])
    outside, inside = robot.solutions(at)
    d = Drawing(-240, 260, -235, 200, width=620)
    d.arrow((-230, 0), (250, 0), colour=PALE)
    d.arrow((0, -225), (0, 190), colour=PALE)
    d.word((250, 0), "x", dx=-8, dy=7, colour=SOFT)
    d.word((0, 190), "z", dx=7, dy=-8, colour=SOFT)
    other = robot.assemblies(outside)[1]
    for i, sign in enumerate((-1.0, 1.0)):
        motor, joint = np.array([80 * sign, 0]), at + sign * half
        for theta, colour, dash in ((inside, ORANGE, DASH), (outside, BLUE, "")):
            elbow = motor + 100 * np.array([sign * math.cos(theta[i]), -math.sin(theta[i])])
            d.line(motor, elbow, colour=colour, width=4, dash=dash)
            d.line(elbow, joint, colour=colour, width=2.2, dash=dash)
            d.dot(elbow, colour=colour)
        d.line(elbow, other + sign * half, colour=SOFT, dash="2 4")
        d.dot(motor, size=5)
    d.line(other - half, other + half, colour=SOFT, width=3)
    d.line(at - half, at + half, width=5)
    d.dot(at, colour=INK)
    d.word(at, "P", dx=-5, dy=-20)
    d.word(other, "the other assembly", dx=-10, dy=9, colour=SOFT, size=13)
    d.arrow((0, 24), (-80, 24), colour=SOFT)
    d.arrow((0, 24), (80, 24), colour=SOFT)
    d.word((0, 24), "2f", dx=6, dy=6, colour=SOFT)
    d.word(at + half, "platform 2p wide", dx=10, dy=-4, size=13)
    d.arc((80, 0), 34, 0, -math.degrees(outside[1]), colour=BLUE)
    d.word((118, -16), "θ", colour=BLUE)
    d.arc((-80, 0), 34, 180, 180 + math.degrees(outside[0]), colour=BLUE)
    d.word((-128, -16), "θ", colour=BLUE)
    return d


def section() -> Drawing:
    """The stm32 robot's reach at y = 0, and what a scan capped at 250 mm sees of it."""
    robot = load_robot("stm32")
    x, z = np.arange(-430.0, 431.0, 2.0), np.arange(-470.0, 471.0, 2.0)
    points = np.stack(np.meshgrid(x, [0.0], z, indexing="ij"), axis=-1)[:, 0]
    theta = robot.inverse(points)
    reached = np.isfinite(theta).all(axis=-1)
    inside = (theta >= robot.joints.min) & (theta <= robot.joints.max)
    d = Drawing(-440, 440, -480, 130, width=660)
    d.runs(_runs(x, z, reached), 2.0, "#dbe4f8")
    d.runs(_runs(x, z, reached & inside.all(axis=-1)), 2.0, "#93aee8")
    d.line((-250, -460), (-250, -100), (250, -100), (250, -460), colour=RED, dash=DASH)
    d.line((-250, -460), (250, -460), colour=RED, dash=DASH)
    d.arrow((-430, 0), (435, 0), colour=SOFT)
    d.word((435, 0), "x", dx=-8, dy=8, colour=SOFT)
    d.line((-115, 0), (115, 0), width=5)
    low, high = -461.3, -209.2
    d.line((0, low), (0, high), colour=GREEN, width=3)
    d.word((0, high), "−209.2", dx=6, dy=4, colour=GREEN, size=13)
    d.word((0, low), "−461.3", dx=8, dy=-12, colour=GREEN, size=13)
    d.word((250, -100), "the scan's own bounds", dx=-150, dy=6, colour=RED, size=13)
    d.word((0, 70), "all that the links reach", anchor="middle", colour=SOFT, size=13)
    d.word((0, -330), "with joints", dx=12, size=13, colour=BLUE)
    d.word((0, -330), "−45° to 90°", dx=12, dy=-17, size=13, colour=BLUE)
    return d


def branches() -> Drawing:
    """Of the tutorial's geometry, with θ3 = 60°: angles that do not come back."""
    robot = RotaryDelta.from_sides(f=457.3, e=115, upper_arm=112, forearm=232)
    turn = np.arange(-45.0, 90.1, 0.5)
    grid = np.stack(np.meshgrid(turn, turn, [BRANCH_DEG], indexing="ij"), axis=-1)[:, :, 0]
    theta = np.radians(grid)
    apart = np.abs(robot.inverse(robot.forward(theta)) - theta).max(axis=-1)
    d = Drawing(-62, 104, -62, 98, width=480)
    d.area((-45, -45), (90, -45), (90, 90), (-45, 90), fill="#dcefe0", colour=SOFT)
    d.runs(_runs(turn, turn, apart > 1e-6), 0.5, "#f0a58a")
    for mark in (-45, 0, 45, 90):
        d.word((mark, -45), f"{mark}°".replace("-", "−"), dy=-18, size=13, anchor="middle")
        d.word((-45, mark), f"{mark}°".replace("-", "−"), dx=-6, dy=-4, size=13, anchor="end")
    d.word((22, -60), "θ₁", size=14)
    d.word((-60, 22), "θ₂", size=14)
    d.word((10, 20), "come back", size=14, colour=GREEN)
    return d


BRANCH_DEG = -45.0


def _runs(x: np.ndarray, y: np.ndarray, marked: np.ndarray) -> Iterator[tuple[float, float, float]]:
    """(x from, x to, y) of every run of marked cells, [x, y], in each row."""
    half = (x[1] - x[0]) / 2
    for j, height in enumerate(y.tolist()):
        edges = np.flatnonzero(np.diff(np.concatenate(([False], marked[:, j], [False]))))
        for start, end in zip(edges[::2].tolist(), edges[1::2].tolist(), strict=True):
            yield x[start] - half, x[end - 1] + half, height


def _middle(a: tuple[float, float], b: tuple[float, float]) -> tuple[float, float]:
    return (a[0] + b[0]) / 2, (a[1] + b[1]) / 2


FIGURES: dict[str, Callable[[], Drawing]] = {
    "plan": plan,
    "arm": arm,
    "elbows": elbows,
    "singular": singular,
    "five-bar": five_bar,
    "section": section,
    "branches": branches,
}


def main() -> int:
    drawn = {FOLDER / f"{name}.svg": draw().svg() for name, draw in FIGURES.items()}
    stale = [path for path, svg in drawn.items() if not path.exists() or path.read_text() != svg]
    if "--check" in sys.argv:
        for path in stale:
            print(f"{path} is not today's; run: python docs/figures.py")
        return 1 if stale else 0
    FOLDER.mkdir(exist_ok=True)
    for path in stale:
        path.write_text(drawn[path])
    return 0


if __name__ == "__main__":
    sys.exit(main())
