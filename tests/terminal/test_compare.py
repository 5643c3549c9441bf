"""`deltaviz compare`, for people and for scripts."""

from __future__ import annotations

import json
import math
from argparse import Namespace
from dataclasses import replace
from pathlib import Path

import pytest

from deltaviz.cli import main
from deltaviz.mechanism import FiveBar
from deltaviz.robots import load_robot
from deltaviz.robots.presets import preset_text
from deltaviz.terminal.compare import run


@pytest.fixture
def bare_delta(tmp_path: Path) -> str:
    """A delta without thicknesses and masses, which is measured sooner."""
    path = tmp_path / "bare.toml"
    path.write_text(preset_text("trossen").split("[bodies]")[0].replace('"trossen"', '"bare"'))
    return str(path)


def test_a_planar_robot_beside_a_delta(capsys, bare_delta: str, tmp_path: Path) -> None:
    picture = tmp_path / "both.png"
    arguments = ["compare", "fivebar", bare_delta, "--resolution", "15", "--plot", str(picture)]
    assert main(arguments) == 0
    lines = capsys.readouterr().out.splitlines()
    assert lines[0].split() == ["fivebar", "bare", "second/first"]
    volume = next(line for line in lines if line.startswith("volume"))
    assert volume.split()[1] == "-"
    assert any(line.startswith("conditioning, worst") for line in lines)
    assert "No torques of bare: the robot file has no [masses]." in lines
    assert picture.read_bytes().startswith(b"\x89PNG")


def test_for_scripts(capsys) -> None:
    assert main(["compare", "fivebar", "fivebar", "--resolution", "4", "--json"]) == 0
    told = json.loads(capsys.readouterr().out)
    assert told["robots"] == ["fivebar", "fivebar"]
    assert told["first"] == told["second"]
    assert set(told["second_over_first"].values()) == {1.0}
    assert {"area_cm2", "resolution_worst_mm", "condition_worst", "holding_nm"} <= set(
        told["first"]
    )


def test_an_empty_workspace_is_status_1_with_its_reason(capsys) -> None:
    robot = load_robot("fivebar")
    low = replace(robot.joints, max=(math.radians(20),) * 2)
    short = FiveBar(base_half=80, platform_half=20, upper_arm=100, forearm=50)  # never meet there
    options = Namespace(resolution=10.0, payload=0.0, json=False, plot=None)
    assert run(robot, replace(robot, mechanism=short, joints=low), options) == 1
    assert "a workspace is empty" in capsys.readouterr().err


def test_a_picture_that_cannot_be_written(capsys) -> None:
    arguments = ["compare", "fivebar", "fivebar", "--resolution", "9", "--plot", "/nowhere/a.png"]
    assert main(arguments) == 1
    told = capsys.readouterr()
    assert told.out == ""  # not after a comparison that took its time
    assert told.err == "deltaviz: --plot /nowhere/a.png: No such file or directory\n"


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        (["fivebar"], "arguments are required"),
        (["fivebar", "trosen"], "did you mean 'trossen'"),
        (["fivebar", "stm32", "--resolution", "0"], "must be greater than 0"),
        (["fivebar", "stm32", "--payload", "-1"], "must be at least 0"),
    ],
)
def test_bad_usage(capsys, arguments: list[str], says: str) -> None:
    try:
        status = main(["compare", *arguments])
    except SystemExit as exit:
        status = exit.code
    assert status == 2
    assert says in capsys.readouterr().err
