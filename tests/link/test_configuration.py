"""What a board is told, and the number that names it."""

from __future__ import annotations

import subprocess
import sys
from dataclasses import fields, replace
from math import inf
from pathlib import Path

import numpy as np
import pytest

from deltaviz import load_robot
from deltaviz.link.board import SimulatedBoard
from deltaviz.link.board.parameters import parameters_from
from deltaviz.link.configuration import check_configurable, configuration_hash, configure_from
from deltaviz.link.messages import BoardState, Configured, Options, RobotKind
from deltaviz.link.wire.codec import decode_host, encode
from deltaviz.robots import RobotFileError
from deltaviz.robots.coordinates import in_space
from deltaviz.robots.load import parse_robot
from deltaviz.robots.presets import preset_text

PRESETS = ["stm32", "trossen", "zheng2023", "deltadraw", "fivebar"]
TOOL_AXIS = Path(__file__).parents[2] / "docs" / "examples" / "stm32-tool.toml"
ROBOTS = [*PRESETS, TOOL_AXIS]


@pytest.mark.parametrize("name", ROBOTS)
def test_every_robot_is_a_configuration_that_the_board_takes(name):
    configure = configure_from(load_robot(name))
    board = SimulatedBoard(start_homed=True)
    board.receive(configure)
    assert Configured(configuration_hash(configure)) in board.take()
    assert board.state is BoardState.HALTED
    assert board.homed


@pytest.mark.parametrize(
    ("name", "kind"), [*((name, None) for name in ROBOTS), ("fivebar", RobotKind.FIVE_BAR)]
)
def test_the_board_places_the_tip_where_the_robot_does(name, kind):
    """By kinematics of its own, from the numbers that it was given."""
    robot = load_robot(name)
    robot = replace(robot, tool_offset=(*robot.tool_offset[:-1], -12.5))
    configure = configure_from(robot)
    assert configure.kind is (kind or configure.kind)
    assert configure.kind is not RobotKind.JOINTS_ONLY
    parameters = parameters_from(configure, tick_hz=200_000)
    assert parameters is not None
    assert parameters.kinematics is not None
    theta = [ready + 0.05 * (i + 1) for i, ready in enumerate(robot.homing.ready)]
    tip = parameters.kinematics.tip(theta[: robot.mechanism.joints])
    assert tip == pytest.approx(in_space(robot.forward(theta).tolist()), abs=1e-3)


def test_the_fastest_that_a_robot_file_may_ask_for_is_taken():
    text = preset_text("stm32").replace("acceleration_deg_s2 = 4500", "acceleration_deg_s2 = 90000")
    most = 360 * 99_800 / 3200
    robot = parse_robot(text.replace("velocity_deg_s = 340", f"velocity_deg_s = {most}"))
    assert parameters_from(configure_from(robot), tick_hz=200_000) is not None
    with pytest.raises(RobotFileError):
        parse_robot(text.replace("velocity_deg_s = 340", f"velocity_deg_s = {most * 1.0001}"))


def test_what_a_plane_has_not_is_unbounded():
    configure = configure_from(load_robot("fivebar"))
    assert configure.workspace_x == (-100, 100)
    assert configure.workspace_z == (-240, -130)
    assert configure.workspace_y == (-inf, inf)
    assert configure.workspace_radius == inf


def test_a_turning_tool_is_the_fourth_joint_and_no_arm():
    robot = load_robot(TOOL_AXIS)
    configure = configure_from(robot)
    per_rad = robot.drive.microsteps_per_rad[3]
    assert configure.kind is RobotKind.ROTARY_DELTA
    assert len(configure.joint_min) == len(configure.upper_arm) == 4
    assert configure.upper_arm == (125, 125, 125, 0)
    assert configure.joint_max[3] / 1024 / per_rad == pytest.approx(np.radians(175), abs=1e-6)
    assert configure.homing_switch[3] / per_rad == pytest.approx(np.radians(-180), abs=1e-3)
    assert configure.homing_max_travel[3] / per_rad == pytest.approx(np.radians(370), abs=1e-3)
    assert configure.homing_fast[3] / 65.536 / per_rad == pytest.approx(np.radians(60), rel=1e-3)
    assert configure.homing_fast[0] != configure.homing_fast[3]


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
    assert configure.workspace_radius == robot.zone.radius
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


@pytest.mark.parametrize("name", ROBOTS)
def test_every_robot_of_ours_can_be_told_to_a_board(name: str) -> None:
    check_configurable(load_robot(name))


@pytest.mark.parametrize(
    ("field", "value", "named"),
    [
        ("acceleration_deg_s2", "1e9", "acceleration"),
        ("acceleration_deg_s2", "1e300", "acceleration"),
        ("acceleration_deg_s2", "1e308", "a limit"),
        ("max_travel_deg", "1e9", "homing max travel"),
    ],
)
def test_a_robot_whose_numbers_no_message_carries_is_refused_with_their_name(
    field: str, value: str, named: str
) -> None:
    lines = preset_text("stm32").splitlines()
    text = "\n".join(f"{field} = {value}" if line.startswith(field) else line for line in lines)
    robot = parse_robot(text)
    with pytest.raises(RobotFileError, match=named):
        check_configurable(robot)
