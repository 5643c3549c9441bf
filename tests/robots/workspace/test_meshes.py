"""Meshes cut, made finer and measured, by areas and distances that are known."""

from __future__ import annotations

import numpy as np
import pytest

from deltaviz.robots.workspace.meshes import clipped, distance, halved

SQUARE = np.array([(0.0, 0.0, 1.0), (4.0, 0.0, 1.0), (4.0, 4.0, 1.0), (0.0, 4.0, 1.0)])
HALVES = np.array([(0, 1, 2), (0, 2, 3)])


def area(vertices: np.ndarray, faces: np.ndarray) -> float:
    a, b, c = np.moveaxis(vertices[faces], 1, 0)
    upward = np.cross(b - a, c - a)
    assert (upward[:, 2] > 0).all()  # all turned as they were
    return float(np.linalg.norm(upward, axis=1).sum()) / 2


@pytest.mark.parametrize(
    ("value", "left"),
    [
        (SQUARE[:, 0] - 1.0, 12.0),
        (1.0 - SQUARE[:, 0], 4.0),
        (SQUARE[:, 0] + SQUARE[:, 1] - 6.0, 2.0),
        (np.ones(4), 16.0),
    ],
)
def test_what_is_left_of_a_square(value: np.ndarray, left: float) -> None:
    vertices, faces = clipped(SQUARE, HALVES, value)
    assert area(vertices, faces) == pytest.approx(left)
    assert set(faces.ravel()) == set(range(len(vertices)))


def test_nothing_is_left_where_nothing_is_wanted() -> None:
    vertices, faces = clipped(SQUARE, HALVES, -np.ones(4))
    assert len(vertices) == len(faces) == 0


def test_a_line_is_cut_between_its_points() -> None:
    line = np.array([(0.0, 0.0), (2.0, 0.0), (2.0, 8.0)])
    vertices, faces = clipped(line, np.array([(0, 1), (1, 2)]), 6.0 - line.sum(axis=1))
    ends = vertices[faces]
    assert np.abs(ends[:, 1] - ends[:, 0]).sum() == pytest.approx(6.0)


def test_halves_cover_what_they_are_halves_of() -> None:
    vertices, faces = halved(SQUARE, HALVES)
    assert (len(vertices), len(faces)) == (9, 8)
    assert area(vertices, faces) == pytest.approx(16.0)
    points, segments = halved(SQUARE[:2, :2], np.array([(0, 1)]))
    assert sorted(points[segments].reshape(-1, 2)[:, 0]) == [0.0, 2.0, 2.0, 4.0]


@pytest.mark.parametrize(
    ("point", "expected"),
    [
        ((1.0, 2.0, 4.0), 3.0),  # above the inside
        ((-3.0, 2.0, 5.0), 5.0),  # beyond an edge
        ((-2.0, -3.0, 7.0), 7.0),  # beyond a corner
        ((2.0, 2.0, 1.0), 0.0),
    ],
)
def test_the_distance_from_a_square(point: tuple[float, ...], expected: float) -> None:
    """Also where a triangle without area, which a mesh may have, lies in the same plane."""
    faces = np.concatenate((HALVES, [(0, 1, 1)]))
    assert distance(np.array([point]), SQUARE, faces) == pytest.approx(expected)
