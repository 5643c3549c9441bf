from __future__ import annotations

import math

import numpy as np
import pytest

from deltaviz.scene import rotations
from deltaviz.scene.pointer import Eye, Grip, along


def eye_at(position: tuple[float, float, float], look_at: tuple[float, float, float]) -> Eye:
    forward = np.subtract(look_at, position)
    forward = forward / np.linalg.norm(forward)
    right = np.cross(forward, (0.0, 0.0, 1.0))
    right = right / np.linalg.norm(right)
    axes = np.column_stack((right, np.cross(forward, right), forward))
    w = math.sqrt(max(1.0 + np.trace(axes), 1e-12)) / 2
    wxyz = np.array(
        (
            w,
            (axes[2, 1] - axes[1, 2]) / (4 * w),
            (axes[0, 2] - axes[2, 0]) / (4 * w),
            (axes[1, 0] - axes[0, 1]) / (4 * w),
        )
    )
    assert np.allclose(rotations.matrix(wxyz), axes)
    return Eye(position=np.array(position), wxyz=wxyz, fov=0.7, aspect=0.9)


EYE = eye_at((0.8, -1.0, 0.4), (0.0, 0.0, -0.2))
GRIP = Grip(grabbed=np.array((0.03, -0.02, -0.29)), tip=np.array((0.0, 0.0, -0.3)))


def test_the_middle_of_the_screen_is_what_the_camera_looks_at() -> None:
    assert EYE.project(np.array((0.0, 0.0, -0.2))) == pytest.approx((0.5, 0.5))
    ray = EYE.ray((0.5, 0.5))
    assert np.cross(ray, np.array((0.0, 0.0, -0.2)) - EYE.position) == pytest.approx(np.zeros(3))


@pytest.mark.parametrize("screen", [(0.1, 0.2), (0.5, 0.5), (0.9, 0.8), (1.2, 0.7)])
def test_a_drag_keeps_the_grabbed_place_under_the_pointer(screen: tuple[float, float]) -> None:
    tip = GRIP.over_plane(EYE, screen)
    assert tip is not None
    assert tip[2] == pytest.approx(GRIP.tip[2])
    assert EYE.project(GRIP.grabbed + tip - GRIP.tip) == pytest.approx(screen)


def test_a_grab_does_not_jump() -> None:
    tip = GRIP.over_plane(EYE, EYE.project(GRIP.grabbed))
    assert tip == pytest.approx(GRIP.tip)
    tip = GRIP.along_vertical(EYE, EYE.project(GRIP.grabbed))
    assert tip == pytest.approx(GRIP.tip)


def test_with_shift_only_the_height_follows() -> None:
    wanted = GRIP.grabbed + np.array((0.0, 0.0, 0.08))
    tip = GRIP.along_vertical(EYE, EYE.project(wanted))
    assert tip == pytest.approx(GRIP.tip + np.array((0.0, 0.0, 0.08)))


@pytest.mark.parametrize("screen", [(0.1, 0.2), (0.5, 0.5), (0.9, 0.8), (0.4, -0.3)])
def test_a_drag_in_the_plane_keeps_the_grabbed_place_under_the_pointer(
    screen: tuple[float, float],
) -> None:
    tip = GRIP.in_plane(EYE, screen)
    assert tip is not None
    assert tip[1] == GRIP.tip[1]
    assert EYE.project(GRIP.grabbed + tip - GRIP.tip) == pytest.approx(screen)


def test_seen_along_its_plane_a_robot_cannot_be_dragged_in_it() -> None:
    aside = eye_at((1.0, -0.02, -0.1), (0.0, -0.02, -0.2))
    assert GRIP.in_plane(aside, (0.5, 0.4)) is None
    assert GRIP.along_vertical(aside, (0.5, 0.4)) is not None


def test_above_the_horizon_there_is_no_place() -> None:
    level = eye_at((1.0, 0.0, -0.1), (0.0, 0.0, -0.1))
    assert GRIP.over_plane(level, (0.5, 0.2)) is None
    assert GRIP.over_plane(level, (0.5, 0.501)) is None  # grazing: a pixel would be metres
    assert GRIP.over_plane(level, (0.5, 0.9)) is not None


def test_looking_straight_down_there_is_no_height() -> None:
    above = eye_at((0.03001, -0.02, 1.0), (0.03, -0.02, -0.3))
    assert GRIP.along_vertical(above, (0.5, 0.4)) is None


@pytest.mark.parametrize(
    ("position", "yaw"),
    [((0, -1, 0.3), 0.0), ((1, 0, 0.3), math.pi / 2), ((-1, 0, 0.3), -math.pi / 2)],
)
def test_yaw_is_where_right_is(position: tuple[float, float, float], yaw: float) -> None:
    assert eye_at(position, (0.0, 0.0, 0.0)).yaw == pytest.approx(yaw)


@pytest.mark.parametrize("axis", [0, 1, 2])
def test_a_place_on_a_line_follows_the_pointer(axis: int) -> None:
    direction = np.eye(3)[axis]
    through = np.array((0.1, -0.05, -0.25))
    for way in (-0.07, 0.0, 0.12):
        wanted = EYE.project(through + way * direction)
        assert along(EYE, wanted, through, direction) == pytest.approx(way, abs=1e-9)
    beside = along(EYE, (0.4, 0.6), through, direction)
    assert beside is not None  # beside the line, too


def test_a_line_that_is_looked_along_tells_nothing() -> None:
    above = eye_at((0.0, -1e-4, 2.0), (0.0, 0.0, 0.0))
    assert along(above, (0.5, 0.4), np.zeros(3), np.array((0.0, 0.0, 1.0))) is None
