"""The sources' methods, corrected, against poses solved at 50 digits."""

from __future__ import annotations

import numpy as np
import pytest

from deltaviz.mechanism import RotaryDelta
from deltaviz.mechanism.published import (
    circles_eliminated,
    cosine_rule,
    elbow_line,
    half_angle,
    legs_of,
    newton,
    spheres_eliminated,
    tetrahedron,
)

INVERSES = [half_angle, elbow_line, cosine_rule]
FORWARDS = [tetrahedron, spheres_eliminated, newton]


def turned_apart(a, b):
    return np.abs(np.remainder(a - b + np.pi, 2 * np.pi) - np.pi)


@pytest.mark.parametrize("method", INVERSES)
def test_inverse(reference, method) -> None:
    xyz = reference.column("ik", "xyz")
    theta = method(legs_of(reference.mechanism), xyz)
    below = (xyz[:, 2] < 0) if method is elbow_line else np.full(len(xyz), True)
    assert below.sum() > 50
    assert turned_apart(theta, reference.angles("ik"))[below].max() < 2e-12
    assert np.isnan(theta[~below]).all()


@pytest.mark.parametrize("method", FORWARDS)
def test_forward(reference, method) -> None:
    xyz = method(legs_of(reference.mechanism), reference.angles("fk"))
    assert np.abs(xyz - reference.column("fk", "xyz")).max() < 2e-10


@pytest.mark.parametrize("method", INVERSES)
def test_planar_inverse(planar_reference, method) -> None:
    xz = planar_reference.column("ik", "xy")
    theta = method(legs_of(planar_reference.mechanism), xz)
    assert turned_apart(theta, planar_reference.angles("ik")).max() < 1e-12


@pytest.mark.parametrize("method", [circles_eliminated, newton])
def test_planar_forward(planar_reference, method) -> None:
    xz = method(legs_of(planar_reference.mechanism), planar_reference.angles("ik"))
    assert np.abs(xz - planar_reference.column("ik", "xy")).max() < 1e-11


@pytest.mark.parametrize("method", INVERSES)
def test_what_is_out_of_reach_has_no_angle(reference, method) -> None:
    theta = method(legs_of(reference.mechanism), reference.column("unreachable", "xyz"))
    assert np.isnan(theta)[~reference.column("unreachable", "reachable_legs")].all()


@pytest.mark.parametrize("method", FORWARDS)
def test_where_forearms_cannot_meet_there_is_no_place(reference, method) -> None:
    theta = reference.angles("fk_no_solution")
    assert np.isnan(method(legs_of(reference.mechanism), theta)).all()


@pytest.mark.parametrize("method", [spheres_eliminated, newton])
def test_every_length_different(uneven, method) -> None:
    theta = np.radians(np.random.default_rng(1).uniform(-30, 80, (200, 3)))
    assert np.abs(method(legs_of(uneven), theta) - uneven.forward(theta)).max() < 1e-11


def test_the_tetrahedron_needs_equal_forearms(uneven) -> None:
    with pytest.raises(ValueError, match="forearms of one length"):
        tetrahedron(legs_of(uneven), np.zeros((1, 3)))


@pytest.mark.parametrize("method", FORWARDS)
def test_arms_that_stand_clockwise(method) -> None:
    lengths = {"base_radius": 115, "effector_radius": 75, "upper_arm": 125, "forearm": 338}
    theta = np.radians([[10.0, 40.0, -20.0]])
    onward = RotaryDelta(**lengths, azimuths_deg=(0, 120, 240))
    mirrored = RotaryDelta(**lengths, azimuths_deg=(0, 240, 120))
    expected = method(legs_of(onward), theta) * [1, -1, 1]
    assert method(legs_of(mirrored), theta) == pytest.approx(expected, abs=1e-11)


def test_an_obtuse_triangle_of_elbows(stm32) -> None:
    """Where the paper's |FE| without its sign is 1.8 mm off."""
    theta = np.radians([[42.0, 42.0, 90.0]])
    assert tetrahedron(legs_of(stm32), theta) == pytest.approx(stm32.forward(theta), abs=1e-11)
