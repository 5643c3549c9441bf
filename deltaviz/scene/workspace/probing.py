"""What there is to know of one point: computed in the computing processes, told in words."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from deltaviz.mechanism.margin import Margin, MarginKind
from deltaviz.robots import Robot
from deltaviz.robots.coordinates import in_robot, in_space
from deltaviz.robots.workspace import Limit, Margins, quality
from deltaviz.scene.rows import Row
from deltaviz.scene.workspace.pictures import Probed, Skill

Point = tuple[float, float, float]
NEAREST = 3  # limits that are told


@dataclass(frozen=True)
class Probe:
    """`xyz` in space, whatever coordinates the robot has."""

    robot: Robot
    xyz: Point

    def pictures(self) -> Iterator[Probed]:
        robot = self.robot
        xyz = in_robot(robot, self.xyz)
        found = robot.reach(xyz)
        margins = Margins.of(robot, Limit.ALL)
        touching = _touching(margins, xyz) if found.theta is not None else ()
        why_not = (*map(str, found.reasons), *touching)
        yield Probed(
            xyz=in_space(xyz),
            theta_deg=None if found.theta is None else _arms(robot, found.theta),
            why_not=why_not,
            nearest=() if why_not else _nearest(margins, xyz),
            skill=None if found.theta is None else _skill(robot, xyz),
        )


def _arms(robot: Robot, theta: tuple[float, ...]) -> tuple[float, ...]:
    return tuple(math.degrees(angle) for angle in theta[: robot.mechanism.joints])


def _touching(margins: Margins, xyz: tuple[float, ...]) -> tuple[str, ...]:
    gap, name = margins.gaps(np.array([xyz]))
    parts = margins.parts(int(name[0])) if gap[0] < 0 else None
    if parts is None:
        return ()
    return (f"{_begun(str(parts[0]))} and {parts[1]} would overlap by {-gap[0]:.2f} mm.",)


def _nearest(margins: Margins, xyz: tuple[float, ...]) -> tuple[tuple[str, float], ...]:
    every = np.arange(len(margins.names))
    values = margins.some(np.array([xyz]), every[None])[0]
    least: dict[str, float] = {}  # several pairs of parts have the same name
    for index in np.argsort(values, kind="stable").tolist():
        if math.isfinite(values[index]):
            least.setdefault(_name(margins.names[index]), float(values[index]))
    return tuple(least.items())[:NEAREST]


def _name(margin: Margin) -> str:
    return "gap between own parts" if margin.kind is MarginKind.COLLISION else str(margin)


def _skill(robot: Robot, xyz: tuple[float, ...]) -> Skill | None:
    found = quality(robot, xyz)
    skill = Skill(*(float(getattr(found, name)) for name in Skill.__dataclass_fields__))
    return skill if math.isfinite(skill.condition) else None


def _begun(text: str) -> str:
    return text[0].upper() + text[1:]


def told(probed: Probed) -> list[Row]:
    """In words, for a panel."""
    rows = [Row("Tip", "  ".join(f"{a} {v:z.1f}" for a, v in zip("XYZ", probed.xyz, strict=True)))]
    if probed.theta_deg is not None:
        names = (f"θ{arm + 1} {angle:.2f}°" for arm, angle in enumerate(probed.theta_deg))
        rows.append(Row("Angles", "  ".join(names)))
    sentences = probed.why_not or ("Within reach and all limits. The nearest:",)
    rows += [Row(sentence) for sentence in sentences]
    rows += [Row(_begun(name), f"{away:.1f} mm") for name, away in probed.nearest]
    if probed.skill is not None:
        skill = probed.skill
        rows += [
            Row("Conditioning", f"{skill.condition:.2f}"),
            Row("Resolution", f"{skill.resolution:.3f} mm per microstep"),
            Row("Speed", f"{skill.slowest:.0f} to {skill.fastest:.0f} mm/s per rad/s"),
        ]
    return rows
