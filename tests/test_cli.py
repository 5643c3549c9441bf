"""What a person reads in the terminal, and what a script gets back."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import pytest

from deltaviz.cli import main


def run(capsys: pytest.CaptureFixture[str], *arguments: str) -> tuple[int, str, str]:
    """Exit status, standard output and standard error of one command."""
    try:
        status = main(arguments)
    except SystemExit as exit:
        status = exit.code if isinstance(exit.code, int) else 1
    out, err = capsys.readouterr()
    return status, out, err


def test_ik_prints_one_solution(capsys: pytest.CaptureFixture[str]) -> None:
    status, out, err = run(capsys, "ik", "0", "0", "-300")
    assert (status, err) == (0, "")
    assert out == "2.271907  2.271907  2.271907 °\n"


def test_fk_agrees_with_the_tutorial(capsys: pytest.CaptureFixture[str]) -> None:
    status, out, _ = run(capsys, "fk", "0", "0", "0", "--robot", "trossen", "--json")
    assert status == 0
    assert json.loads(out)["xyz_mm"] == pytest.approx([0, 0, -96.859015171], abs=1e-9)


def test_json_is_one_object_that_goes_there_and_back(capsys: pytest.CaptureFixture[str]) -> None:
    _, out, _ = run(capsys, "ik", "10", "-20", "-300", "--json")
    theta = json.loads(out)["theta_deg"]
    _, out, _ = run(capsys, "fk", "--json", *map(repr, theta))
    assert json.loads(out)["xyz_mm"] == pytest.approx([10, -20, -300], abs=1e-9)


@pytest.mark.parametrize("z", ["-300", "-300.0", "-3e2", "-.3e3"])
def test_negative_numbers_work_as_typed(capsys: pytest.CaptureFixture[str], z: str) -> None:
    assert run(capsys, "ik", "0", "0", z)[1] == "2.271907  2.271907  2.271907 °\n"


def test_out_of_reach_says_why(capsys: pytest.CaptureFixture[str]) -> None:
    status, out, err = run(capsys, "ik", "0", "0", "-900", "--json")
    assert (status, out) == (1, "")
    assert "Arm 1 cannot reach" in err


def test_outside_the_limits_is_a_solution_with_a_note(capsys: pytest.CaptureFixture[str]) -> None:
    status, out, err = run(capsys, "ik", "200", "0", "-200")
    assert status == 0
    assert out
    assert "lower limit of -45°" in err


def test_a_planar_robot_has_three_coordinates_too(capsys: pytest.CaptureFixture[str]) -> None:
    status, out, err = run(capsys, "ik", "0", "0", "-240", "--robot", "fivebar")
    assert (status, out, err) == (0, "53.130102  53.130102 °\n", "")  # a 3-4-5 triangle
    status, out, _ = run(
        capsys, "fk", "53.13010235415598", "53.13010235415598", "--robot", "fivebar"
    )
    assert (status, out) == (0, "0.000000  0.000000  -240.000000 mm\n")
    status, out, err = run(capsys, "ik", "0", "5", "-240", "--robot", "fivebar")
    assert (status, out) == (2, "")
    assert "Y must be 0, as fivebar is planar; got 5" in err


def test_a_turning_tool_is_the_last_angle(capsys: pytest.CaptureFixture[str]) -> None:
    robot = str(Path(__file__).parents[1] / "docs/examples/stm32-tool.toml")
    assert run(capsys, "ik", "0", "0", "-300", "--robot", robot)[1] == (
        "2.271907  2.271907  2.271907  0.000000 °\n"
    )
    out = run(capsys, "fk", "0", "0", "0", "90", "--robot", robot)[1]
    assert out == "0.000000  0.000000  -294.989830 mm\n"


def test_angles_at_which_nothing_meets(capsys: pytest.CaptureFixture[str]) -> None:
    status, out, err = run(capsys, "fk", "--robot", "zheng2023", "136.5", "99.25", "-46.5")
    assert (status, out) == (1, "")
    assert "forearms cannot meet" in err


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        (["ik", "0", "0"], "takes 3 coordinates in mm; got 2"),
        (["ik", "0", "0", "0", "0"], "takes 3 coordinates in mm; got 4"),
        (["ik", "0", "x", "-300"], "'x' is no number"),
        (["ik", "0", "nan", "-300"], "'nan' is not finite"),
        (["ik", "0", "-inf", "-300"], "'-inf' is not finite"),
        (["fk", "0", "0"], "takes 3 angles in degrees; got 2"),
        (["fk", "0", "0", "0", "--robot", "fivebar"], "takes 2 angles in degrees; got 3"),
        (["ik", "0", "-200", "--robot", "fivebar"], "takes 3 coordinates in mm; got 2"),
        (["ik", "0", "0", "-300", "--robot", "trosen"], "did you mean 'trossen'"),
        (["serve", "--robot", "trosen"], "did you mean 'trossen'"),
        (["--robot", "./none.toml"], "none.toml"),
        (["sreve"], "Did you mean 'serve'?"),
        (["--port", "99999"], "use a number from 0 to 65535"),
        (["--port", "x"], "use a number from 0 to 65535"),
        (["--host", "0.0.0.0"], "token"),
    ],
)
def test_bad_usage_is_status_2_with_a_way_out(
    capsys: pytest.CaptureFixture[str], arguments: list[str], says: str
) -> None:
    status, out, err = run(capsys, *arguments)
    assert (status, out) == (2, "")
    assert says in err
    assert "Traceback" not in err


@pytest.mark.parametrize(
    ("link", "says"),
    [
        ("emulate://?homed=1", "disabled and unhomed"),
        ("serial:///dev/ttyUSB0?speed=9600", "speed"),
        ("sim://?home=0", "home"),
        ("nonsense", "sim://"),
    ],
)
def test_a_link_that_cannot_be_had_is_status_1(
    capsys: pytest.CaptureFixture[str], link: str, says: str
) -> None:
    status, out, err = run(capsys, "serve", "--port", "0", "--no-browser", "--link", link)
    assert (status, out) == (1, "")
    assert says in err
    assert "Traceback" not in err


def test_robots_lists_the_presets(capsys: pytest.CaptureFixture[str]) -> None:
    _, out, _ = run(capsys, "robots")
    names = [line.split()[0] for line in out.splitlines()]
    assert names[0] == "stm32"
    assert {"trossen", "zheng2023", "deltadraw", "fivebar"} <= set(names)


def test_ports_never_fails(capsys: pytest.CaptureFixture[str]) -> None:
    status, out, _ = run(capsys, "ports", "--json")
    assert status == 0
    assert isinstance(json.loads(out)["ports"], list)


def test_the_command_starts_without_the_heavy_libraries() -> None:
    watched = (
        *("numba", "viser", "fastapi", "ruckig", "serial"),
        *("scipy", "skimage", "matplotlib", "distributed", "tqdm"),
    )
    code = (
        "import sys; from deltaviz.cli import main; main(['ik', '0', '0', '-300', '--json']);"
        f"print([m for m in {watched} if m in sys.modules], file=sys.stderr)"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stderr == "[]\n"
