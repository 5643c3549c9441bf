from __future__ import annotations

import dataclasses

import numpy as np
import pytest
import trimesh

from deltaviz.scene.workspace.hits import Surfaces
from deltaviz.scene.workspace.pictures import Section, Skin

RADIUS = 0.3


def ball() -> Skin:
    mesh = trimesh.creation.icosphere(subdivisions=4, radius=RADIUS)
    return Skin(
        vertices=mesh.vertices.astype(np.float32),
        faces=mesh.faces.astype(np.uint32),
        edges=np.empty((0, 2, 3), np.float32),
        size=1.0,
        deviation=0.0,
        reason=None,
    )


def plate(level: float, *, hole: bool = False) -> Section:
    """0.4 m by 0.2 m across z; the hole is the quarter towards +x and +y."""
    image = np.full((10, 20, 4), 255, np.uint8)
    if hole:
        image[5:, 10:, 3] = 0
    low, high = np.array((-0.2, -0.1, level)), np.array((0.2, 0.1, level))
    return Section(2, 1000 * level, image, low, high, (-1.0, 1.0), None)


def test_a_ray_meets_a_ball_where_a_ball_is_met(steady: np.random.Generator) -> None:
    surfaces = Surfaces(skin=ball())
    for _ in range(60):
        origin = steady.normal(size=3)
        origin *= 0.9 / np.linalg.norm(origin)
        direction = steady.normal(0, 0.25, 3) - origin
        direction /= np.linalg.norm(direction)
        nearest = -origin @ direction  # on the ray, to the centre
        depth = RADIUS**2 - (origin @ origin - nearest**2)
        if abs(depth) < 0.02:
            continue  # a ball of triangles is a little smaller
        hit = surfaces.hit(origin, direction)
        assert (hit is None) == (depth < 0)
        if hit is not None:
            there = origin + (nearest - np.sqrt(depth)) * direction
            assert np.allclose(hit, there, atol=0.006)


def test_behind_the_eye_there_is_nothing() -> None:
    away = np.array((1.0, 0.2, 0.1))
    assert Surfaces(skin=ball()).hit(np.array((0.6, 0.0, 0.0)), away) is None
    above, up = np.array((0.05, 0.05, 0.5)), np.array((0.0, 0.0, 1.0))
    assert Surfaces(flat={"plate": plate(0.1)}).hit(above, up) is None


def test_the_boundary_is_seen_through() -> None:
    surfaces = Surfaces(skin=ball(), flat={"low": plate(-0.1), "high": plate(0.1)})
    down = np.array((0.0, 0.0, -1.0))
    inside, beside = np.array((0.05, 0.02, 1.0)), np.array((0.0, 0.15, 1.0))
    assert surfaces.hit(inside, down) == pytest.approx((0.05, 0.02, 0.1))
    beside_hit = surfaces.hit(beside, down)
    assert beside_hit is not None
    assert beside_hit[2] == pytest.approx(np.sqrt(RADIUS**2 - 0.15**2), abs=0.003)


def test_what_is_cut_out_of_a_picture_is_not_there() -> None:
    surfaces = Surfaces(flat={"low": plate(-0.1), "high": plate(0.1, hole=True)})
    down = np.array((0.0, 0.0, -1.0))
    for x, y, z in ((0.1, 0.05, -0.1), (-0.1, 0.05, 0.1), (0.1, -0.05, 0.1)):
        assert surfaces.hit(np.array((x, y, 1.0)), down) == pytest.approx((x, y, z))
    assert surfaces.hit(np.array((0.21, 0.0, 1.0)), down) is None
    sideways = np.array((1.0, 0.0, 0.0))
    assert surfaces.hit(np.array((-1.0, 0.0, 0.05)), sideways) is None


def test_an_upright_picture_is_hit_in_its_own_rows_and_columns() -> None:
    upright = dataclasses.replace(
        plate(0.0, hole=True),
        axis=0,
        low=np.array((0.05, -0.2, -0.1)),
        high=np.array((0.05, 0.2, 0.1)),
    )
    surfaces, towards = Surfaces(flat={"x": upright}), np.array((-2.0, 0.0, 0.0))
    assert surfaces.hit(np.array((1.0, 0.1, -0.05)), towards) == pytest.approx((0.05, 0.1, -0.05))
    assert surfaces.hit(np.array((1.0, 0.1, 0.05)), towards) is None
