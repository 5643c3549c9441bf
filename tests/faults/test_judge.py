"""The judge of these tests sees what is wrong with a ride, however little."""

from __future__ import annotations

from collections.abc import Callable
from copy import deepcopy
from dataclasses import replace
from functools import cache

import pytest

from deltaviz.machine import intent as i
from tests.faults.breaks import judge
from tests.faults.executed import Executed, Sample
from tests.faults.phases import ME, jogging, quick_robot
from tests.faults.wire_bench import WireBench

ONE = 1 << 32  # a microstep
Spoil = Callable[[Executed, int], None]


@cache
def a_ride() -> Executed:
    """A jog, stopped, and some rest."""
    bench = WireBench(quick_robot(), seed=1)
    jogging(bench)
    bench.do(i.Stop(ME, "Stop pressed"))
    bench.run(0.2)
    return bench.executed[0]


def moved(sample: Sample, steps: int, share: int = 1) -> Sample:
    """Further on by so many microsteps, or that share of one, arms and all."""
    first, *others = sample.positions
    position = first + steps * ONE // share
    count = (position + ONE // 2) >> 32
    per_step = 2 * 3.141592653589793 / 3200
    arm = sample.arms[0] + (count - sample.counts[0]) * per_step
    return replace(
        sample,
        positions=(position, *others),
        counts=(count, *sample.counts[1:]),
        arms=(arm, *sample.arms[1:]),
    )


def a_fraction_of_a_step_astray(ride: Executed, at: int) -> None:
    ride.samples[at] = moved(ride.samples[at], 1, share=20)


def on_by_a_step_at_rest(ride: Executed, _at: int) -> None:
    for k in range(len(ride.samples) - 20, len(ride.samples)):
        ride.samples[k] = moved(ride.samples[k], 1)


def a_step_lost_on_the_way_to_the_arms(ride: Executed, at: int) -> None:
    for k in range(at, len(ride.samples)):
        arms = ride.samples[k].arms
        ride.samples[k] = replace(ride.samples[k], arms=(arms[0] + 0.00196, *arms[1:]))


def a_count_that_is_off(ride: Executed, at: int) -> None:
    counts = ride.samples[at].counts
    ride.samples[at] = replace(ride.samples[at], counts=(counts[0] + 1, *counts[1:]))


def never_commanded(ride: Executed, _at: int) -> None:
    ride.arms.clear()


def another_segment(ride: Executed, _at: int) -> None:
    key = max(ride.segments) if len(ride.segments) < 9 else (1, 8)
    segment = ride.segments[key]
    ride.segments[key] = replace(segment, p=(segment.p[0] + 1024, *segment.p[1:]))


def a_millisecond_too_long(ride: Executed, at: int) -> None:
    ride.samples.insert(at, replace(ride.samples[at]))
    for k in range(at + 1, len(ride.samples)):
        ride.samples[k] = replace(ride.samples[k], tick=(ride.samples[k].tick + 200) % 2**32)


def later_than_a_stop(ride: Executed, at: int) -> None:
    ride.stops.append(ride.samples[at + 20].tick)


def without_a_host(ride: Executed, at: int) -> None:
    ride.samples[at] = replace(ride.samples[at], unheard=150 * 200 + 1)


def still_moving(ride: Executed, _at: int) -> None:
    ride.samples[-1] = replace(ride.samples[-1], moving=True)


SPOILT: list[Spoil] = [
    a_fraction_of_a_step_astray,
    on_by_a_step_at_rest,
    a_step_lost_on_the_way_to_the_arms,
    a_count_that_is_off,
    never_commanded,
    another_segment,
    a_millisecond_too_long,
    later_than_a_stop,
    without_a_host,
    still_moving,
]


def fastest(ride: Executed) -> int:
    """A sample in the midst of the jog."""
    counts = [sample.counts for sample in ride.samples if sample.counts]
    offset = len(ride.samples) - len(counts)
    return offset + max(range(1, len(counts)), key=lambda k: abs(counts[k][0] - counts[k - 1][0]))


def test_a_ride_is_right() -> None:
    verdict = judge()(a_ride())
    assert verdict.wrong == []
    assert verdict.brakes == 1
    assert 0.9 < verdict.worst["joint acceleration"] <= 1.003, "the brake uses what it may"


@pytest.mark.parametrize("spoil", SPOILT, ids=lambda spoil: spoil.__name__)
def test_what_is_wrong_is_seen(spoil: Spoil) -> None:
    ride = deepcopy(a_ride())
    spoil(ride, fastest(ride))
    assert judge()(ride).wrong != []


@pytest.mark.parametrize("limit", ["joint velocity", "joint acceleration", "joint range"])
def test_each_limit_is_its_robots(limit: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """A ride that is right becomes wrong when the limit is a little lower."""
    verdict = judge()(a_ride())
    if limit == "joint range":
        low = {"min_deg": -1e-3, "max_deg": 1e-3}
        monkeypatch.setitem(judge()._robot.file, "joints", judge()._robot.file["joints"] | low)
    else:
        name = "_velocity" if limit == "joint velocity" else "_acceleration"
        share = verdict.worst[limit] * 0.99
        monkeypatch.setattr(judge(), name, getattr(judge(), name) * share)
    assert limit in judge()(a_ride()).excess
