"""The firmware takes the configurations that the simulated board takes, and survives the rest."""

from __future__ import annotations

import random
import subprocess
from dataclasses import fields, replace
from math import inf, nan
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from deltaviz import load_robot
from deltaviz.link.board.parameters import parameters_from
from deltaviz.link.configuration import configure_from
from deltaviz.link.messages import Configure
from tests.firmware import c_library
from tests.firmware.two_judges import TICK_HZ, gantry

PRESETS = ["stm32", "trossen", "zheng2023", "deltadraw"]
TOOL_AXIS = Path(__file__).parents[2] / "docs" / "examples" / "stm32-tool.toml"
STM32 = configure_from(load_robot("stm32"))

TOP_VELOCITY = TICK_HZ * 65536 // 2004  # a step in 2.004 ticks

# What a field may be made of, by the type of its values. No geometry that only doubles can hold.
I8 = st.sampled_from([-1, 0, 1])
I32 = st.sampled_from([-(1 << 31), -(1 << 20), -1, 0, 1, 1 << 20, (1 << 31) - 1])
U32 = st.sampled_from([0, 1, 255, 256, TOP_VELOCITY, TOP_VELOCITY + 1, 1 << 20, (1 << 32) - 1])
F32 = st.sampled_from([nan, inf, -inf, 0.0, -1.0, 0.5, 100.0, 509.25])
SIGNED = {"joint_min", "joint_max", "homing_switch", "ready"}


def numbers(name: str, value: Any) -> st.SearchStrategy[Any]:
    if isinstance(value, float):
        return F32
    return (I32 if name in SIGNED else U32) | st.integers(0, 2 * abs(value) + 1)


@st.composite
def changes(draw: st.DrawFn, configure: Configure) -> dict[str, Any]:
    """Up to three fields, each with one entry that is another number."""
    changed: dict[str, Any] = {}
    # Not the azimuths: the simulated board has no forward kinematics for clockwise arms.
    same = ("kind", "options", "azimuth")
    names = [field.name for field in fields(configure) if field.name not in same]
    for name in draw(st.lists(st.sampled_from(names), min_size=1, max_size=3, unique=True)):
        value = getattr(configure, name)
        if name == "homing_direction":
            changed[name] = draw(I8)
        elif not isinstance(value, tuple):
            changed[name] = draw(F32)
        elif not isinstance(value[0], bool):
            place = draw(st.integers(0, len(value) - 1))
            other = draw(numbers(name, value[place]))
            changed[name] = (*value[:place], other, *value[place + 1 :])
    return changed


@pytest.mark.parametrize("name", [*PRESETS, "fivebar", TOOL_AXIS])
def test_what_follows_from_a_configuration(name):
    robot = load_robot(name)
    configure = configure_from(robot)
    theirs = parameters_from(configure, tick_hz=TICK_HZ)
    ours = c_library.parameters_from(configure, tick_hz=TICK_HZ)
    assert theirs is not None
    assert ours is not None
    assert tuple(ours.accelerations[: robot.joint_count]) == theirs.accelerations
    for i in range(robot.joint_count):
        assert ours.acceleration[i] == pytest.approx(configure.acceleration[i] * 1e6 / 2**24)
        assert ours.velocity[i] == pytest.approx(configure.velocity[i] * 1000 / 65536)
        assert ours.unhomed_velocity[i] <= ours.velocity[i]
    assert ours.arms == robot.mechanism.joints
    assert ours.handedness == 1 or name == "fivebar"


def test_before_homing_no_joint_is_faster_than_after():
    fast = replace(STM32, unhomed_velocity=(1 << 31,) * 3)
    ours = c_library.parameters_from(fast, tick_hz=TICK_HZ)
    assert ours is not None
    assert list(ours.unhomed_velocity) == list(ours.velocity)


def test_without_a_geometry():
    ours = c_library.parameters_from(gantry(4).configure, tick_hz=TICK_HZ)
    assert ours is not None
    assert ours.arms == 0
    assert all(ours.accelerations)


@pytest.mark.parametrize(
    "changed",
    [
        {"joint_min": (STM32.joint_max[0], *STM32.joint_min[1:])},
        {"velocity": (TOP_VELOCITY + 1, *STM32.velocity[1:])},  # more than a step every other tick
        {"acceleration": (255, *STM32.acceleration[1:])},
        {"acceleration": (STM32.velocity[0] * 256 // 1000 - 1,) * 3},  # brakes for over a second
        {"microsteps_per_rad": (inf, 509.0, 509.0)},
        {"ready": (900, 0, 0)},  # beyond the joint's limit
        {"homing_direction": 0},
        {"homing_fast": (0, 1, 1)},
        {"homing_fast": tuple(v + 1 for v in STM32.velocity)},
        {"homing_slow": (1, 1, 1)},  # would take longer than ten minutes
        {"homing_max_travel": ((1 << 20) + 1,) * 3},
        {"tool_offset": (nan, 0.0, 0.0)},
        {"workspace_radius": 0.0},
        {"workspace_z": (-225.0, -440.0)},
        {"upper_arm": (-125.0, 125.0, 125.0)},
        {"forearm": (100.0, 100.0, 100.0)},  # no tip at the ready pose
    ],
    ids=lambda changed: next(iter(changed)),
)
def test_what_makes_no_sense_is_refused_by_both(changed):
    configure = replace(STM32, **changed)
    assert parameters_from(configure, tick_hz=TICK_HZ) is None
    assert c_library.parameters_from(configure, tick_hz=TICK_HZ) is None


@pytest.mark.parametrize("tick_hz", [0, 10_000, 19_000, 200_001, 501_000, (1 << 32) - 1])
def test_a_tick_that_is_out_of_bounds(tick_hz):
    assert c_library.parameters_from(STM32, tick_hz=tick_hz) is None


@pytest.mark.parametrize(("tick_hz", "moves"), [(19_000, False), (20_000, True)])
def test_a_board_that_is_too_slow_takes_none(tick_hz, moves):
    assert (parameters_from(STM32, tick_hz=tick_hz) is not None) == moves
    assert (c_library.parameters_from(STM32, tick_hz=tick_hz) is not None) == moves


@pytest.mark.parametrize("configure", [STM32, gantry(2).configure], ids=["delta", "gantry"])
@settings(deadline=None, max_examples=500)
@given(data=st.data())
def test_any_numbers_are_judged_alike(configure, data):
    changed = replace(configure, **data.draw(changes(configure)))
    theirs = parameters_from(changed, tick_hz=TICK_HZ)
    ours = c_library.parameters_from(changed, tick_hz=TICK_HZ)
    assert (ours is None) == (theirs is None)


def wild(chance: random.Random) -> c_library.CCase:
    """A configuration of which most is well, and motions and poses of any numbers."""
    joints = chance.choice([1, 2, 3, 3, 3, 4, 4])
    configure = STM32 if joints == 3 else gantry(joints).configure
    case = c_library.CCase()
    case.configure = c_library.c_configure(configure)
    for _ in range(chance.choice([0, 0, 1, 2, 4])):
        name = chance.choice(c_library.CConfigure._fields_)[0]
        if name in ("inverted", "joints"):
            continue  # the decoder lets only 0 and 1, and 0 to 4, into these
        value = chance.choice([nan, inf, -inf, 3e38, -3e38, 1e-38, 0.0, chance.uniform(-1e4, 1e4)])
        whole = chance.choice([0, 1, -1, (1 << 31) - 1, -(1 << 31), chance.getrandbits(32)])
        old = getattr(case.configure, name)
        if hasattr(old, "_length_"):
            real = isinstance(old[0], float)
            old[chance.randrange(len(old))] = value if real else whole
        else:
            setattr(case.configure, name, value if isinstance(old, float) else whole)
    case.tick_hz = chance.choice([200_000, 40_000, 20_000, 500_000, chance.getrandbits(32)])
    case.ticks = chance.choice([160, 800, 10_000, chance.getrandbits(32)])
    size = chance.choice([1 << 10, 1 << 20, (1 << 31) - 1])
    for array in (case.start.p, case.start.v, case.end.p, case.end.v):
        for joint in range(4):
            array[joint] = chance.randint(-size, size)
    for i in range(3):
        case.pose[i] = chance.choice([nan, inf, 3e38, chance.uniform(-500, 500)])
    return case


def test_no_numbers_make_it_stumble(tmp_path):
    """Out of bounds, undefined, or for ever: none of it, in many thousand cases of bad numbers."""
    judge = tmp_path / "judge"
    sanitizers = "-fsanitize=address,undefined,float-cast-overflow"
    driver = Path(__file__).with_name("judge_cases.c")
    options = ("-g", sanitizers, "-fno-sanitize-recover=all")
    c_library.compile_c(judge, [*c_library.SOURCES, driver], *options)
    chance = random.Random(5)
    cases = b"".join(bytes(wild(chance)) for _ in range(20_000))
    done = subprocess.run([judge], input=cases, capture_output=True, timeout=120, check=False)
    assert done.returncode == 0, done.stderr.decode()
    judged, taken, accepted = map(int, done.stdout.split())
    assert judged == 20_000
    assert taken > 5000
    assert accepted > 100
