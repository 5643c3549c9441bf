"""`deltaviz verify`, for people and for scripts."""

from __future__ import annotations

import json
from dataclasses import replace

import pytest

from deltaviz.cli import main
from deltaviz.mechanism import RotaryDelta
from deltaviz.robots import load_robot
from deltaviz.robots.verification import verify
from deltaviz.terminal.verify import text


def test_a_table_with_its_verdict(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["verify", "--robot", "trossen", "--poses", "2000"]) == 0
    out = capsys.readouterr().out
    assert out.startswith("trossen: 2000 poses within its limits (seed 0)\n")
    assert "forward: tetrahedron by circumcentre (Zheng and Chen)" in out
    assert "have an elbow inside" in out
    assert out.endswith("All agree.\n")


def test_for_scripts(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["verify", "--robot", "fivebar", "--poses", "200", "--json"]) == 0
    told = json.loads(capsys.readouterr().out)
    assert (told["robot"], told["poses"], told["agrees"]) == ("fivebar", 200, True)
    assert all(check["worst"] <= check["tolerance"] for check in told["checks"])
    assert told["angles_within_the_joint_limits"]["closes"] == 1.0


@pytest.mark.parametrize("form", [[], ["--json"]])
def test_a_disagreement_is_status_1(monkeypatch, capsys: pytest.CaptureFixture[str], form) -> None:
    right = RotaryDelta.forward
    monkeypatch.setattr(RotaryDelta, "forward", lambda self, theta: right(self, theta) + 1e-6)
    assert main(["verify", "--poses", "200", *form]) == 1
    out = capsys.readouterr().out
    assert "DISAGREES" in out or json.loads(out)["agrees"] is False


def test_a_pose_without_a_solution_and_a_method_that_does_not_apply() -> None:
    found = verify(load_robot("stm32"), poses=100)
    nan = float("nan")
    hole = replace(found.checks[0], worst=nan, median=nan)
    unfit = replace(found.checks[1], worst=nan, median=nan, not_for="needs equal forearms")
    shown = text(replace(found, checks=(hole, unfit)))
    assert "a pose without a solution   DISAGREES" in shown
    assert "does not apply: needs equal forearms" in shown
    assert "1 of 2 disagree" in shown


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        (["--poses", "0"], "use a number from 1 to 10000000"),
        (["--poses", "many"], "use a number from 1 to 10000000"),
        (["--seed", "-1"], "--seed must be at least 0"),
        (["--robot", "trosen"], "did you mean 'trossen'"),
    ],
)
def test_bad_usage(capsys: pytest.CaptureFixture[str], arguments: list[str], says: str) -> None:
    try:
        status = main(["verify", *arguments])
    except SystemExit as exit:
        status = exit.code
    assert status == 2
    assert says in capsys.readouterr().err
