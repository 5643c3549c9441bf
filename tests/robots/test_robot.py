from dataclasses import replace

import numpy as np
import pytest

from deltaviz.mechanism import Margin, MarginKind


def test_the_tool_offset_is_applied_once(stm32):
    tool = (5.0, -6.0, -40.0)
    longer = replace(stm32, tool_offset=tool)
    theta = np.radians([[10, 20, 30], [0, 0, 0]])
    tip = longer.forward(theta)
    assert tip == pytest.approx(stm32.forward(theta) + tool)
    assert longer.inverse(tip) == pytest.approx(theta)
    assert longer.kernel.forward(theta) == pytest.approx(tip)
    assert longer.kernel.inverse(np.ascontiguousarray(tip)) == pytest.approx(theta)
    assert longer.jacobian(theta) == pytest.approx(stm32.jacobian(theta))


def test_margin_names_and_columns(stm32):
    names = stm32.margin_names
    kinds = [name.kind for name in names]
    assert len(set(names)) == len(names)
    for kind in (
        MarginKind.TYPE_1,
        MarginKind.BALL_JOINT,
        MarginKind.JOINT_MIN,
        MarginKind.JOINT_MAX,
    ):
        assert kinds.count(kind) == 3
    for kind in (MarginKind.TYPE_2, MarginKind.PARALLELOGRAM, MarginKind.RADIUS, MarginKind.Z_MIN):
        assert kinds.count(kind) == 1
    assert stm32.margins([0, 0, -300], [0, 0, 0]).shape == (len(names),)
    assert str(names[0]) == "arm 1 type 1 singularity"


@pytest.mark.parametrize("arm", [0, 1, 2])
def test_a_pose_exactly_at_a_limit_is_legal(stm32, arm):
    theta = np.radians([60.0, 60.0, 60.0])
    theta[arm] = stm32.joints.max[arm]
    tip = stm32.forward(theta)
    column = stm32.margin_names.index(Margin(MarginKind.JOINT_MAX, arm))
    assert stm32.margins(tip, theta)[column] >= 0
    assert stm32.margins(tip, stm32.inverse(tip))[column] >= 0
    theta[arm] += 1e-6
    assert stm32.margins(stm32.forward(theta), theta)[column] < 0


def test_each_margin_falls_by_about_one_per_mm(preset):
    """Walk outward until a limit is met; there its slope along the way is about 1, so that one
    step size fits all. Going askew to a limit gives less."""
    rng = np.random.default_rng(5)
    start = preset.forward(preset.homing.ready)
    slopes = []
    for _ in range(60):
        direction = rng.normal(size=len(start))
        direction /= np.linalg.norm(direction)
        way = start + np.linspace(0, 1500, 3001)[:, None] * direction
        margins = preset.kernel.margins(way, preset.kernel.inverse(way))
        first = int(np.argmax((margins < 0).any(axis=-1)))
        column = int(np.argmin(margins[first]))
        slopes.append((margins[first - 1, column] - margins[first, column]) / 0.5)
        assert np.isfinite(margins[: first + 40]).all()
        assert (margins[first : first + 40].min(axis=-1) < 0).all()
    assert min(slopes) > 0.05
    assert max(slopes) < 4.0
    assert 0.4 < float(np.median(slopes)) < 1.6


def test_values_do_not_change(stm32):
    with pytest.raises(AttributeError):
        stm32.name = "other"
    with pytest.raises(AttributeError):
        stm32.joints.min = (0.0, 0.0, 0.0)
