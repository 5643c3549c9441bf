"""The preset trossen answers what C code in the tutorial's style answers."""

from __future__ import annotations

import numpy as np
import pytest

from benchmarks.kinematics import Tutorial


@pytest.fixture(scope="module")
def tutorial(tmp_path_factory: pytest.TempPathFactory) -> Tutorial:
    return Tutorial(tmp_path_factory.mktemp("tutorial"))


@pytest.fixture(scope="module")
def angles(trossen) -> np.ndarray:
    """Angles whose elbows all stand outside."""
    theta = np.random.default_rng(1).uniform(np.radians(-45), np.radians(90), (20_000, 3))
    xyz = trossen.forward(theta)
    return theta[(trossen.jq(xyz, theta) > 0).all(axis=-1)]


def test_forward(trossen, tutorial: Tutorial, angles: np.ndarray) -> None:
    assert np.abs(tutorial.forward(np.degrees(angles)) - trossen.forward(angles)).max() < 1e-9


def test_inverse(trossen, tutorial: Tutorial, angles: np.ndarray) -> None:
    xyz = np.ascontiguousarray(trossen.forward(angles))
    xyz = xyz[(trossen.jq(xyz, angles) > 1e3).all(axis=-1)]  # nearer to straight digits are lost
    assert len(xyz) > 15_000
    assert np.abs(np.radians(tutorial.inverse(xyz)) - trossen.inverse(xyz)).max() < 1e-11


def test_what_it_cannot_reach(trossen, tutorial: Tutorial) -> None:
    far = np.array([[0.0, 0.0, -400.0]])
    assert np.isnan(trossen.inverse(far)).all()
    with pytest.raises(ValueError, match="unreachable"):
        tutorial.inverse(far)


def test_zero(tutorial: Tutorial) -> None:
    xyz = tutorial.forward(np.zeros((1, 3)))
    assert xyz == pytest.approx(np.array([[0, 0, -96.859015171]]), abs=1e-9)
