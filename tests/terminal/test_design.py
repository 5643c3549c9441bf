"""`deltaviz design`, for people and for scripts."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from deltaviz.cli import main
from deltaviz.robots import load_robot
from deltaviz.robots.design import Wish

QUICK = ["--robot", "fivebar", "--box", "200", "80", "--workers", "1", "--generations", "6"]


def run(capsys: pytest.CaptureFixture[str], *arguments: str) -> tuple[int, str, str]:
    try:
        status = main(["design", *arguments])
    except SystemExit as exit:
        status = exit.code if isinstance(exit.code, int) else 1
    out, err = capsys.readouterr()
    return status, out, err


def test_it_writes_a_robot_and_tells_what_it_does(capsys, tmp_path: Path) -> None:
    out = tmp_path / "lifter.toml"
    status, told, err = run(capsys, *QUICK, "--out", str(out))
    assert (status, err) == (0, "")
    assert "Reaches, as is proved: rectangle of 200 by 80 mm" in told
    assert "conditioning is at worst" in told
    robot = load_robot(out)
    assert robot.name == "lifter"
    assert robot.limits == load_robot("fivebar").limits
    assert out.read_text().startswith("# Designed by `deltaviz design` to reach a rectangle of 200")
    assert main(["verify", "--robot", str(out), "--poses", "100"]) == 0


def test_for_scripts_and_sizes(capsys, tmp_path: Path) -> None:
    out = tmp_path / "small.toml"
    sizes = ["--max-upper-arm", "110", "--max-forearm", "220", "--max-depth", "260"]
    status, told, _ = run(capsys, *QUICK, *sizes, "--out", str(out), "--json")
    assert status == 0
    data = json.loads(told)
    assert data["file"] == str(out)
    assert data["upper_arm_mm"] <= 110
    assert data["forearm_mm"] <= 220
    assert data["reaches"]["floor_mm"] >= -260
    assert data["clearance_mm"] >= 0
    assert "--max-upper-arm 110 --max-forearm 220 --max-depth 260" in out.read_text()


def test_a_file_that_is_there_is_kept(capsys, tmp_path: Path) -> None:
    out = tmp_path / "mine.toml"
    out.write_text("mine")
    status, _, err = run(capsys, *QUICK, "--out", str(out))
    assert status == 1
    assert "--overwrite" in err
    assert out.read_text() == "mine"
    assert run(capsys, *QUICK, "--out", str(out), "--overwrite")[0] == 0
    assert load_robot(out).name == "mine"


def test_a_file_that_cannot_be_written_is_told_before_the_search(
    monkeypatch, capsys, tmp_path: Path
) -> None:
    monkeypatch.setattr("deltaviz.robots.design.design", lambda *_, **__: pytest.fail("searched"))
    out = tmp_path / "nowhere" / "x.toml"
    status, told, err = run(capsys, *QUICK, "--out", str(out))
    assert (status, told) == (1, "")
    assert err == f"deltaviz: --out {out}: No such file or directory\n"


def test_out_of_reach_writes_nothing(capsys, tmp_path: Path) -> None:
    out = tmp_path / "never.toml"
    status, told, err = run(capsys, *QUICK, "--max-forearm", "50", "--out", str(out))
    assert (status, told) == (1, "")
    assert "no lengths within these limits reach it" in err
    assert "forearm at the limit" in err
    assert not out.exists()


def test_what_is_not_proved_is_not_written(monkeypatch, capsys, tmp_path: Path) -> None:
    monkeypatch.setattr(Wish, "points", lambda self: np.array([[0.0, 40.0]]))  # its middle only
    out = tmp_path / "hoped.toml"
    status, told, err = run(capsys, *QUICK, "--max-forearm", "150", "--out", str(out))
    assert (status, told) == (1, "")
    assert "the best that was found misses by" in err
    assert not out.exists()


@pytest.mark.parametrize(
    ("arguments", "status", "says"),
    [
        ([], 2, "is required"),
        (["--cylinder", "300"], 2, "expected 2 arguments"),
        (["--cylinder", "300", "0"], 2, "must be greater than 0"),
        (["--cylinder", "3", "4", "--paper", "a4"], 2, "not allowed with"),
        (["--paper", "napkin"], 2, "letter"),
        (["--box", "3", "4"], 2, "--box takes 3 lengths for stm32"),
        (["--robot", "fivebar", "--cylinder", "3", "4"], 2, "ask for --box W H"),
        (["--cylinder", "300", "80", "--max-upper-arm", "0.2"], 2, "at least 0.5, one --grain"),
        (["--cylinder", "300", "80", "--max-base", "50"], 2, "--max-base 50: must be at least 75"),
        (["--cylinder", "300", "80", "--max-base", "50"], 2, "that of stm32, 75 mm in radius"),
        (["--cylinder", "300", "80", "--at", "-900", "--max-depth", "500"], 2, "lies deeper"),
        (["--cylinder", "300", "80", "--seed", "-1"], 2, "whole number from 0"),
        (["--cylinder", "300", "80", "--generations", "0"], 2, "from 1 to 100000"),
        (["--cylinder", "300", "80", "--out", "robot.json"], 2, "ends in .toml"),
        (["--cylinder", "300", "80", "--scheduler", "nonsense://x"], 1, "no Dask scheduler"),
        (["--cylinder", "300", "80", "--robot", "trosen"], 2, "did you mean 'trossen'"),
    ],
)
def test_what_cannot_be_asked(capsys, arguments: list[str], status: int, says: str) -> None:
    found, out, err = run(capsys, *arguments)
    assert (found, out) == (status, "")
    assert says in err
    assert "Traceback" not in err


def test_an_address_that_cannot_be_is_said_in_a_line(tmp_path: Path) -> None:
    """Of a process of its own: what a half-made connection says, it says when Python ends."""
    asked = ["--cylinder", "300", "80", "--scheduler", "tcp://127.0.0.1"]
    command = [sys.executable, "-m", "deltaviz", "design", *asked]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True)
    assert done.returncode == 1
    (line,) = done.stderr.splitlines()
    assert "no Dask scheduler answers at tcp://127.0.0.1: missing port" in line
