"""That `verify` trusts what is right, and finds what is wrong."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from deltaviz.mechanism import FiveBar, RotaryDelta
from deltaviz.robots import Robot, load_robot
from deltaviz.robots.load import parse_robot
from deltaviz.robots.verification import verify

POSES = 500


def disagreeing(robot: Robot) -> set[str]:
    return {c.what for c in verify(robot, poses=POSES).checks if not c.agrees}


def test_every_preset_agrees(preset: Robot) -> None:
    found = verify(preset, poses=POSES)
    assert found.poses == POSES
    assert found.agrees
    assert all(check.not_for is None for check in found.checks)
    assert len({check.method for check in found.checks}) >= 7


def test_a_tool_that_turns_and_stands_out(tool_robot: Robot) -> None:
    assert verify(replace(tool_robot, tool_offset=(0.0, 0.0, -30.0)), poses=POSES).agrees


def test_the_same_seed_draws_the_same_poses(stm32: Robot) -> None:
    one, again, other = (verify(stm32, poses=POSES, seed=seed) for seed in (1, 1, 2))
    assert one == again
    assert one.checks != other.checks


def test_lengths_that_differ_per_arm(stm32_text: str) -> None:
    text = stm32_text.replace("forearm = 338.0", "forearm = [338.0, 337.0, 339.0]")
    found = verify(parse_robot(text), poses=POSES)
    assert found.agrees
    left_out = [check for check in found.checks if check.not_for is not None]
    assert [check.method.split()[0] for check in left_out] == ["tetrahedron"]


@pytest.mark.parametrize(
    ("kind", "name"), [(RotaryDelta, "trossen"), (FiveBar, "fivebar")], ids=["delta", "five-bar"]
)
class TestWrongKinematics:
    def test_forward(self, monkeypatch, kind, name) -> None:
        right = kind.forward
        monkeypatch.setattr(kind, "forward", lambda self, theta: right(self, theta) + 2e-9)
        assert {"forward", "forward(inverse(p)) - p"} & disagreeing(load_robot(name))

    def test_inverse(self, monkeypatch, kind, name) -> None:
        right = kind.inverse
        monkeypatch.setattr(kind, "inverse", lambda self, xyz: right(self, xyz) + 1e-10)
        assert {"inverse", "inverse(forward(θ)) - θ"} <= disagreeing(load_robot(name))

    def test_both_with_the_same_mistake(self, monkeypatch, kind, name) -> None:
        """The round trip cannot see it: the other methods do."""
        forward, inverse = kind.forward, kind.inverse
        monkeypatch.setattr(kind, "forward", lambda self, theta: forward(self, theta - 1e-8))
        monkeypatch.setattr(kind, "inverse", lambda self, xyz: inverse(self, xyz) + 1e-8)
        assert {"inverse", "forward"} <= disagreeing(load_robot(name))

    def test_jacobian(self, monkeypatch, kind, name) -> None:
        right = kind.jacobian
        monkeypatch.setattr(kind, "jacobian", lambda self, theta: right(self, theta) * 1.00001)
        assert disagreeing(load_robot(name)) == {"Jacobian"}

    def test_a_hole(self, monkeypatch, kind, name) -> None:
        """One pose in hundreds without a solution is a disagreement, not an exception."""
        right = kind.inverse

        def holed(self, xyz):
            theta = right(self, xyz)
            return np.where(xyz[..., :1] == xyz[..., 0].max(), np.nan, theta)

        monkeypatch.setattr(kind, "inverse", holed)
        assert "inverse" in disagreeing(load_robot(name))


def test_angles_with_an_elbow_inside_do_not_close() -> None:
    """2.2 % of [-45°, 90°]³ for the tutorial's geometry (SOURCES: its readers asked why)."""
    robot = load_robot("trossen")
    low, high = (np.radians(bound) for bound in (-45.0, 90.0))
    wide = replace(robot, joints=replace(robot.joints, min=(low,) * 3, max=(high,) * 3))
    branches = verify(wide, poses=20_000).branches
    assert branches.elbow_inside == pytest.approx(0.022, abs=0.002)
    assert branches.apart == 0
    assert branches.closes + branches.elbow_inside == pytest.approx(1)


def test_a_robot_without_a_legal_pose_is_not_verified(stm32: Robot) -> None:
    never = replace(stm32, joints=replace(stm32.joints, ball_joint_max=1e-9))
    found = verify(never, poses=10)
    assert (found.poses, found.checks, found.agrees) == (0, (), False)


def test_tolerances_are_the_contracts(stm32: Robot) -> None:
    """forward(inverse(p)) within 1e-9 mm of p."""
    check = verify(stm32, poses=POSES).checks[0]
    assert (check.unit, check.tolerance) == ("mm", 1e-9)
    assert not replace(check, worst=1.1e-9).agrees
    assert replace(check, worst=0.9e-9).agrees
    assert not replace(check, worst=float("nan")).agrees
