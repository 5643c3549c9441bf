"""Against poses solved at 50 digits: tests/data/reference/README.md."""

import numpy as np


def turned_apart(a, b):
    """Difference of angles, however they wrap."""
    return np.abs(np.remainder(a - b + np.pi, 2 * np.pi) - np.pi)


def test_inverse(reference):
    theta = reference.mechanism.inverse(reference.column("ik", "xyz"))
    assert np.abs(theta - reference.angles("ik")).max() < 1.5e-13


def test_forward(reference):
    xyz = reference.mechanism.forward(reference.angles("fk"))
    assert np.abs(xyz - reference.column("fk", "xyz")).max() < 8e-13


def test_forward_takes_the_assembly_below_the_elbows(reference):
    xyz = reference.mechanism.forward(reference.angles("fk"))
    other = reference.column("fk", "xyz_other_assembly")
    assert np.linalg.norm(xyz - other, axis=-1).min() > 1.0


def test_jacobian(reference):
    for cases in ("ik", "fk"):
        expected = reference.column(cases, "J")
        error = np.abs(reference.mechanism.jacobian(reference.angles(cases)) - expected)
        relative = error.max(axis=(1, 2)) / np.abs(expected).max(axis=(1, 2))
        assert (relative < 1e-15 * (10 + reference.column(cases, "cond"))).all()


def test_singular_values_of_the_jacobian(reference):
    sigma = np.linalg.svd(reference.mechanism.jacobian(reference.angles("ik")), compute_uv=False)
    expected = reference.column("ik", "sigma")
    assert np.abs(sigma - expected).max() < 1e-12 * expected.max()


def test_velocity_through_the_jacobian(reference):
    for case in reference.cases["ik"] + reference.cases["fk"]:
        given = case["velocity_case"]
        velocity = reference.mechanism.jacobian(np.radians(case["theta_deg"])) @ given["theta_dot"]
        np.testing.assert_allclose(velocity, given["v"], rtol=1e-12, atol=1e-12 * case["sigma"][0])


def test_discriminants(reference):
    mechanism = reference.mechanism
    for cases in ("ik", "fk"):
        xyz, theta = reference.column(cases, "xyz"), reference.angles(cases)
        jq, det = reference.column(cases, "jq"), reference.column(cases, "det_Jx")
        np.testing.assert_allclose(mechanism.det_jx(xyz, theta), det, rtol=1e-13)
        error = np.abs(mechanism.jq(xyz, theta) - jq)
        assert (error < 2e-14 * np.abs(jq).max(axis=-1, keepdims=True)).all()


def test_parallelograms_and_ball_joints(reference):
    mechanism = reference.mechanism
    for cases in ("ik", "fk"):
        xyz, theta = reference.column(cases, "xyz"), reference.angles(cases)
        couples = mechanism.couples(xyz, theta)
        couples = couples / np.linalg.norm(couples, axis=-1, keepdims=True)
        expected = reference.column(cases, "constraint_det")
        assert np.abs(np.linalg.det(couples) - expected).max() < 2e-15
        ball_joint = np.arcsin(mechanism.sideways(xyz) / np.array(mechanism.forearm))
        expected = np.radians(reference.column(cases, "forearm_lateral_deg"))
        assert np.abs(ball_joint - expected).max() < 2e-15


def test_inverse_returns_elbow_outside_only(reference):
    theta = reference.angles("fk")
    outside = reference.column("fk", "elbow_out")
    apart = turned_apart(reference.mechanism.inverse(reference.column("fk", "xyz")), theta)
    assert (apart[outside] < 1e-13).all()
    assert (apart[~outside] > 1e-3).all()


def test_inverse_takes_the_root_with_positive_jq(reference):
    for case in reference.cases["ik"]:
        xyz = np.array(case["xyz"])
        chosen = reference.mechanism.inverse(xyz)
        assert (reference.mechanism.jq(xyz, chosen) > 0).all()
        for arm, roots in enumerate(case["theta_all_deg"]):
            apart = sorted(float(turned_apart(chosen[arm], np.radians(root))) for root in roots)
            assert apart[0] < 1e-13


def test_out_of_reach(reference):
    xyz = reference.column("unreachable", "xyz")
    assert np.isnan(reference.mechanism.inverse(xyz)).all()
    far, near = reference.mechanism.misses(xyz)
    missed = np.maximum(far, near)
    assert np.abs(missed - reference.column("unreachable", "margin_mm")).max() < 1e-12
    assert ((missed <= 0) == reference.column("unreachable", "reachable_legs")).all()


def test_at_the_edge_of_reach(reference):
    for case in reference.cases["singular_type1"]:
        theta = reference.mechanism.inverse(case["xyz"])
        error = np.abs(theta - np.radians(case["theta_deg"]))
        assert error[case["leg"]] < 4e-8
        assert (np.delete(error, case["leg"]) < 1e-13).all()


def test_a_nanometre_either_side_of_the_edge(reference):
    for case in reference.cases["singular_type1"]:
        for near in case["near"]:
            far, close = reference.mechanism.misses(near["xyz"])
            missed = max(far[case["leg"]], close[case["leg"]])
            assert abs(missed - near["margin_mm"]) < 1e-12
            # These points lie well within the other two arms' reach.
            solved = bool(np.isfinite(reference.mechanism.inverse(near["xyz"])).all())
            assert solved == near["leg_reachable"]


def test_forearms_in_one_plane(reference):
    for case in reference.cases["singular_type2"]:
        theta = np.radians(case["theta_deg"])
        xyz = reference.mechanism.forward(theta)
        # The height over the elbows is the root of a difference that is all rounding.
        assert np.abs(xyz - case["xyz"]).max() < 1e-4
        det = reference.mechanism.det_jx(case["xyz"], theta)
        assert abs(det) < 1e-15 * reference.mechanism.forearm[0] ** 3


def test_forearms_that_cannot_meet_or_meet_everywhere(reference):
    for cases in ("fk_no_solution", "fk_indeterminate"):
        theta = reference.angles(cases)
        assert np.isnan(reference.mechanism.forward(theta)).all()
        assert np.isnan(reference.mechanism.jacobian(theta)).all()
