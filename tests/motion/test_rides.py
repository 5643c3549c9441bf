"""Random targets on every preset: no limit is broken between the knots, and limits are reached."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest

from deltaviz.motion import check
from deltaviz.motion.check import Fault
from deltaviz.motion.follower import Follower

PRESETS = ("stm32", "trossen", "zheng2023", "deltadraw", "fivebar")
ROBOTS = (*PRESETS, "stm32-tool")
MODES = ("inside", "rim", "edge", "far", "angles", "jog", "turn", "mixed")
LIMITS = ("joint velocity", "joint acceleration", "tip velocity", "tip acceleration")

Judge = Callable[[str], Callable[[Any], Any]]
TakeRide = Callable[..., Any]


@pytest.mark.parametrize("name", ROBOTS)
@pytest.mark.parametrize("mode", MODES)
def test_no_limit_is_broken(judge: Judge, take_ride: TakeRide, name: str, mode: str) -> None:
    for seed in range(2):
        ride = take_ride(name, seed=seed, mode=mode, ticks=250)
        assert judge(name)(ride).broken == {}


@pytest.mark.parametrize("name", ROBOTS)
def test_no_limit_is_broken_when_the_target_jumps_at_every_tick(
    judge: Judge, take_ride: TakeRide, name: str
) -> None:
    for seed in range(2):
        ride = take_ride(name, seed=seed, mode="mixed", ticks=300, hold=(1, 2))
        assert ride.switches == 300
        assert judge(name)(ride).broken == {}


@pytest.mark.parametrize("name", PRESETS)
def test_limits_are_reached(judge: Judge, take_ride: TakeRide, name: str) -> None:
    """Not by being timid: each limit is met in a fifth of the rides."""
    modes = ("sprint", "jog", "mixed", "edge", "sprint", "jog", "mixed", "edge", "sprint", "jog")
    ticks = {"sprint": 1500}
    verdict = judge(name)
    findings = [
        verdict(take_ride(name, seed=seed, mode=mode, ticks=ticks.get(mode, 150)))
        for seed, mode in enumerate(modes)
    ]
    assert [f.broken for f in findings if f.broken] == []
    shares = {k: sum(f.peaks[k] >= 0.95 for f in findings) / len(findings) for k in LIMITS}
    assert all(share >= 0.2 for share in shares.values()), shares


def test_the_tip_accelerates_most_between_two_knots(judge: Judge, take_ride: TakeRide) -> None:
    """A motion of the joints on which that is half a per cent more than at either knot."""
    ride = take_ride("stm32-tool", seed=109, mode="mixed", ticks=100, hold=(1, 80))
    finding = judge("stm32-tool")(ride)
    assert finding.broken == {}
    assert finding.peaks["tip acceleration"] > 0.99


@pytest.mark.long
@pytest.mark.parametrize("name", ROBOTS)
@pytest.mark.parametrize("mode", MODES)
def test_soak(judge: Judge, take_ride: TakeRide, name: str, mode: str) -> None:
    """Minutes: `pytest -m long tests/motion`."""
    for seed in range(100, 140):
        ride = take_ride(name, seed=seed, mode=mode, ticks=2000, hold=(1, 80))
        assert judge(name)(ride).broken == {}, seed


# The judge sees what the checks prevent: with one check taken away it reports that limit.


def _broken_without(
    judge: Judge, take_ride: TakeRide, name: str, how: dict[str, Any], expected: tuple[str, ...]
) -> bool:
    """Whether rides on a preset break one of the limits `expected`."""
    verdict = judge(name)
    found = (verdict(take_ride(name, seed=seed, **how)).broken for seed in range(8))
    return any(name in expected for broken in found for name in broken)


@pytest.mark.parametrize(
    ("attribute", "mode", "expected"),
    [
        ("velocity", "sprint", "joint velocity"),
        ("acceleration", "sprint", "joint acceleration"),
        ("tip_velocity", "turn", "tip velocity"),
        ("tip_acceleration", "turn", "tip acceleration"),
    ],
)
def test_judge_sees_what_each_limit_prevents(
    judge: Judge, take_ride: TakeRide, attribute: str, mode: str, expected: str
) -> None:
    def loosen(follower: Follower) -> None:
        checker = follower._planner.check  # pyright: ignore[reportPrivateUsage]
        setattr(checker, attribute, getattr(checker, attribute) * 100)

    how = {"mode": mode, "ticks": 400, "prepare": loosen}
    assert _broken_without(judge, take_ride, "stm32", how, (expected,))


PLACES = ("z", "x", "radius", "joint range", "ball joint", "elbow outside")


@pytest.mark.parametrize("name", ["zheng2023", "fivebar", "stm32-tool"])
@pytest.mark.parametrize(("fault", "expected"), [(Fault.PATH, ""), (Fault.BRAKE, "brake: ")])
def test_judge_sees_what_each_check_of_place_prevents(
    judge: Judge,
    take_ride: TakeRide,
    monkeypatch: pytest.MonkeyPatch,
    name: str,
    fault: Fault,
    expected: str,
) -> None:
    real = check.judge

    def blind(margins: Any, *rest: Any) -> tuple[int, int]:
        found, column = real(margins, *rest)
        return (0, -1) if found == fault else (found, column)

    monkeypatch.setattr(check, "judge", blind)
    how = {"mode": "rim", "ticks": 300}
    broken = tuple(expected + place for place in PLACES)
    assert _broken_without(judge, take_ride, name, how, broken)
