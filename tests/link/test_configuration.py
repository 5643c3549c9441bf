"""What a board is told, and the number that names it."""

from __future__ import annotations

import subprocess
import sys
from dataclasses import fields, replace
from math import inf

import numpy as np
import pytest

from deltaviz import load_robot
from deltaviz.link.board import SimulatedBoard
from deltaviz.link.configuration import configuration_hash, configure_from
from deltaviz.link.messages import BoardState, Configured, Options, RobotKind
from deltaviz.link.wire.codec import decode_host, encode

PRESETS = ["stm32", "trossen", "zheng2023", "deltadraw", "fivebar"]


@pytest.mark.parametrize("name", PRESETS)
def test_every_preset_is_a_configuration_that_the_board_takes(name):
    configure = configure_from(load_robot(name))
    board = SimulatedBoard(start_homed=True)
    board.receive(configure)
    assert Configured(configuration_hash(configure)) in board.take()
    assert board.state is BoardState.HALTED
    assert board.homed


def test_the_hash_is_the_same_in_another_process():
    code = (
        "from deltaviz import load_robot\n"
        "from deltaviz.link.configuration import configuration_hash, configure_from\n"
        "print(configuration_hash(configure_from(load_robot('stm32'))))"
    )
    out = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert int(out.stdout) == configuration_hash(configure_from(load_robot("stm32")))


def test_each_field_counts():
    configure = configure_from(load_robot("stm32"))
    hashes = {configuration_hash(configure)}
    changed = {
        "kind": RobotKind.JOINTS_ONLY,
        "options": Options.NONE,
        "inverted": (True, False, False),
        "workspace_radius": inf,
    }
    for field in fields(configure):
        value = getattr(configure, field.name)
        if field.name in changed:
            other = changed[field.name]
        elif isinstance(value, tuple):
            other = (_next(value[0]), *value[1:])
        else:
            other = _next(value)
        hashes.add(configuration_hash(replace(configure, **{field.name: other})))
    assert len(hashes) == 1 + len(fields(configure))


def _next(value):
    """The nearest other value that the wire can carry."""
    if isinstance(value, int):
        return value + 1
    return float(np.nextafter(np.float32(value), np.float32(inf)))


def test_both_zeros_are_one():
    """A robot file may say -0.0."""
    robot = load_robot("stm32")
    assert robot.tool_offset[0] == 0.0
    minus = replace(robot, tool_offset=(-0.0, 0.0, 0.0))
    assert configuration_hash(configure_from(minus)) == configuration_hash(configure_from(robot))


@pytest.mark.parametrize("name", PRESETS)
def test_a_configuration_arrives_as_it_was_sent(name):
    configure = configure_from(load_robot(name))
    assert decode_host(*encode(configure)) == configure


@pytest.mark.parametrize("name", PRESETS)
def test_every_presets_brake_from_top_velocity_is_short(name):
    """A tenth of the second at which a board refuses."""
    configure = configure_from(load_robot(name))
    for velocity, acceleration in zip(configure.velocity, configure.acceleration, strict=True):
        assert velocity * 256 / acceleration < 100  # ms


def test_it_says_what_the_robot_file_says():
    robot = load_robot("stm32")
    configure = configure_from(robot)
    per_rad = robot.drive.microsteps_per_rad[0]
    assert configure.joint_max[0] / 1024 / per_rad == pytest.approx(robot.joints.max[0], abs=1e-5)
    assert configure.velocity[0] / 65.536 / per_rad == pytest.approx(
        robot.limits.joint.velocity[0], rel=1e-4
    )
    assert configure.velocity[0] / 65.536 / per_rad <= robot.limits.joint.velocity[0]
    assert configure.acceleration[0] * 1e6 / 2**24 / per_rad == pytest.approx(
        robot.limits.joint.acceleration[0], rel=1e-4
    )
    assert configure.homing_fast[0] / 65.536 / per_rad == pytest.approx(
        robot.homing.fast[0], rel=1e-3
    )
    assert configure.options == Options.HOMING_TOGETHER | Options.SWITCH_ACTIVE_OPEN
    assert configure.workspace_radius == robot.workspace.radius
    assert configure.workspace_x == (-inf, inf)
    high = replace(robot, drive=replace(robot.drive, enable_active="high"))
    assert Options.ENABLE_ACTIVE_HIGH in configure_from(high).options


def test_a_ready_pose_at_the_joint_limit_is_inside_it():
    """Both are rounded, the pose to whole microsteps, the limit more finely."""
    robot = load_robot("stm32")
    for bound in (robot.joints.min, robot.joints.max):
        homing = replace(robot.homing, ready=bound)
        configure = configure_from(replace(robot, homing=homing))
        for low, ready, high in zip(
            configure.joint_min, configure.ready, configure.joint_max, strict=True
        ):
            assert low <= ready * 1024 <= high


def test_presets_differ():
    assert len({configuration_hash(configure_from(load_robot(name))) for name in PRESETS}) == len(
        PRESETS
    )
