"""The compiled loops for very many poses are the mechanism's own inverse and forward."""

import math
import subprocess
import sys

import numpy as np
import pytest

from deltaviz.mechanism import RotaryDelta, rotary_delta
from deltaviz.mechanism import rotary_delta_batch_compiled as compiled


def columns(rows: np.ndarray) -> list[np.ndarray]:
    return [np.ascontiguousarray(rows[:, i]) for i in range(3)]


def inverse_both_ways(mechanism: RotaryDelta, xyz: np.ndarray, threads: int = 1) -> np.ndarray:
    rows = mechanism.batch.inverse_rows(xyz, threads=threads)
    apart = np.stack(mechanism.batch.inverse(*columns(xyz), threads=threads), axis=-1)
    np.testing.assert_array_equal(rows, apart)
    return rows


def forward_both_ways(mechanism: RotaryDelta, theta: np.ndarray, threads: int = 1) -> np.ndarray:
    rows = mechanism.batch.forward_rows(theta, threads=threads)
    apart = np.stack(mechanism.batch.forward(*columns(theta), threads=threads), axis=-1)
    np.testing.assert_array_equal(rows, apart)
    return rows


def same(batch: np.ndarray, numpy: np.ndarray, tolerance: float) -> None:
    np.testing.assert_array_equal(np.isnan(batch), np.isnan(numpy))
    np.testing.assert_allclose(batch, numpy, rtol=0, atol=tolerance)


class TestReference:
    """Against poses solved at 50 digits, with the bounds of `test_reference`."""

    def test_inverse(self, reference):
        theta = inverse_both_ways(reference.mechanism, reference.column("ik", "xyz"))
        assert np.abs(theta - reference.angles("ik")).max() < 1.5e-13

    def test_forward(self, reference):
        xyz = forward_both_ways(reference.mechanism, reference.angles("fk"))
        assert np.abs(xyz - reference.column("fk", "xyz")).max() < 8e-13

    def test_a_nanometre_either_side_of_the_edge(self, reference):
        for case in reference.cases["singular_type1"]:
            points = np.array([case["xyz"], *(near["xyz"] for near in case["near"])])
            theta = inverse_both_ways(reference.mechanism, points)
            error = np.abs(theta[0] - np.radians(case["theta_deg"]))
            assert error[case["leg"]] < 4e-8
            solved = np.isfinite(theta[1:]).all(axis=-1)
            assert solved.tolist() == [near["leg_reachable"] for near in case["near"]]

    def test_forearms_in_one_plane(self, reference):
        theta = reference.angles("singular_type2")
        xyz = forward_both_ways(reference.mechanism, theta)
        assert np.abs(xyz - reference.column("singular_type2", "xyz")).max() < 1e-4

    def test_forearms_that_cannot_meet_or_meet_everywhere(self, reference):
        for cases in ("fk_no_solution", "fk_indeterminate"):
            xyz = forward_both_ways(reference.mechanism, reference.angles(cases))
            assert np.isnan(xyz).all()


def test_inverse_in_beside_and_out_of_reach(stm32, uneven):
    points = np.random.default_rng(1).uniform([-450, -450, -480], [450, 450, 480], (20_001, 3))
    for mechanism in (stm32, uneven):
        expected = mechanism.inverse(points)
        assert 0.1 < np.isnan(expected[:, 0]).mean() < 0.9
        # A tenth of a micrometre from the edge, two roundings may differ by the root of theirs.
        far, near = mechanism.misses(points)
        assert np.abs(np.maximum(far, near)).min() > 1e-5
        same(inverse_both_ways(mechanism, points), expected, 1e-12)


def test_forward_of_any_angles(stm32, uneven):
    theta = np.random.default_rng(2).uniform(-9.0, 9.0, (20_001, 3))
    for mechanism in (stm32, uneven):
        expected = mechanism.forward(theta)
        assert 0.001 < np.isnan(expected[:, 0]).mean() < 0.9
        firm = np.abs(mechanism.det_jx(expected, theta)) > 1e-3 * 338**3
        xyz = forward_both_ways(mechanism, theta)
        np.testing.assert_array_equal(np.isnan(xyz), np.isnan(expected))
        assert np.abs(xyz - expected)[firm].max() < 1e-9


@pytest.mark.parametrize("threads", [2, 3])
def test_threads_change_nothing(stm32, threads):
    points = np.random.default_rng(3).uniform([-250, -250, -460], [250, 250, -150], (50_000, 3))
    theta = inverse_both_ways(stm32, points)
    np.testing.assert_array_equal(inverse_both_ways(stm32, points, threads), theta)
    xyz = forward_both_ways(stm32, theta)
    np.testing.assert_array_equal(forward_both_ways(stm32, theta, threads), xyz)


def test_one_bad_row_spoils_no_other(stm32):
    rows = np.array([[0, 0, -300], [np.nan, 0, -300], [np.inf, 0, 0], [1e300, 0, 0], [0, 0, -900]])
    rows = np.repeat(rows, 7, axis=0)
    theta = inverse_both_ways(stm32, rows)
    same(theta, stm32.inverse(rows), 1e-15)
    xyz = forward_both_ways(stm32, rows)
    np.testing.assert_array_equal(np.isnan(xyz), np.isnan(stm32.forward(rows)))


def test_angles_of_very_many_turns(stm32):
    turns = np.array([[1e4, 0.1, 0.2], [9e4, -9e4, 1e5], [1e6, 1e12, -1e9], [0.1, 1e15, 0.3]])
    same(forward_both_ways(stm32, turns), stm32.forward(turns), 1e-9)


def test_whatever_the_length(stm32):
    for count in (0, 1, 2, 3, 5, compiled.BLOCK - 1, compiled.BLOCK, compiled.BLOCK + 1):
        theta = np.random.default_rng(count).uniform(-0.5, 1.5, (count, 3))
        xyz = forward_both_ways(stm32, theta)
        assert xyz.shape == (count, 3)
        same(xyz, stm32.forward(theta), 1e-11)
        same(inverse_both_ways(stm32, xyz), stm32.inverse(xyz), 1e-11)


def test_the_public_calls_use_it_for_many_poses(stm32, monkeypatch):
    points = np.random.default_rng(4).uniform([-250, -250, -460], [250, 250, -150], (2, 500, 3))
    theta = stm32.inverse(points)
    xyz = stm32.forward(theta)
    monkeypatch.setattr(rotary_delta, "MANY", 1000)
    calls: list[str] = []
    for name in ("inverse_rows", "forward_rows"):
        whole = getattr(compiled, name)
        monkeypatch.setattr(
            compiled, name, lambda *a, whole=whole, name=name: (calls.append(name), whole(*a))
        )
    same(stm32.inverse(points), theta, 1e-12)
    same(stm32.forward(theta), xyz, 1e-10)
    same(stm32.inverse(points[:, ::-1])[:, ::-1], theta, 1e-12)
    stm32.inverse(points[:1])
    assert calls == ["inverse_rows", "forward_rows", "inverse_rows"]


def test_few_poses_import_nothing():
    code = (
        "import sys; from deltaviz import load_robot; import numpy as np;"
        "m = load_robot('stm32').mechanism; m.forward(m.inverse(np.full((1000, 3), -250.0)));"
        "print('numba' in sys.modules)"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout == "False\n"


def test_arctangent():
    """Of half an angle, doubled: to two roundings, over the half plane and the fold's borders."""
    halves = np.append(np.linspace(-math.pi / 2, math.pi / 2, 20_001), [-math.pi / 6, math.pi / 6])
    for scale in (1e-12, 1.0, 1e12):
        for half in halves:
            rise, run = scale * math.sin(half), scale * math.cos(half)
            up, along = compiled._folded(rise, run)
            found = compiled._unfolded(2.0 * (up / along), rise, run)
            assert found == pytest.approx(2.0 * math.atan2(rise, run), rel=4.5e-16, abs=0)


def test_elbow():
    """To two roundings while the arm points outwards, and four where it points back."""
    for a in np.linspace(-math.pi, math.pi, 40_001):
        x, y, z = compiled._elbow(a, a * a, (1.0, -0.5, 1.0, 0.0))
        tolerance = 4.5e-16 if abs(a) < math.pi / 2 else 9e-16
        assert x == pytest.approx(math.cos(a), abs=tolerance)
        assert y == 0.0
        assert z == pytest.approx(-math.sin(a), abs=tolerance)


def test_half_a_turn_either_way(stm32):
    """The last angles that the loop itself does, and the first done with care."""
    half = math.pi * np.array([1.0, np.nextafter(1.0, 2.0), np.nextafter(1.0, 0.0), 1.001, 0.999])
    theta = np.stack([np.concatenate([half, -half]), np.full(10, 0.3), np.full(10, 0.4)], axis=-1)
    same(forward_both_ways(stm32, theta), stm32.forward(theta), 1e-11)


def test_level_with_the_base_and_above(stm32):
    heights = (-200.0, -1e-12, -0.0, 0.0, 1e-12, 200.0)
    points = np.array([[x, y, z] for x in (0.0, 300.0) for y in (0.0, 150.0) for z in heights])
    expected = stm32.inverse(points)
    assert np.isfinite(expected).all(axis=-1).sum() > 3
    same(inverse_both_ways(stm32, points), expected, 1e-12)
