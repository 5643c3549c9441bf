"""`deltaviz workspace`: what a person reads of a robot's reach, and the files it writes."""

from __future__ import annotations

import csv
import json
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import trimesh
from PIL import Image

from deltaviz.robots import load_robot
from deltaviz.robots.presets import preset_text
from deltaviz.robots.workspace import Workspace
from deltaviz.robots.workspace.export import write_csv, write_stl
from tests.test_cli import run

COARSE = ("--resolution", "5")


def found(capsys: pytest.CaptureFixture[str], *arguments: str) -> dict[str, Any]:
    """Of the five-bar, which takes the least time."""
    status, out, err = run(capsys, "workspace", "--robot", "fivebar", "--json", *arguments)
    assert (status, err) == (0, "")
    return json.loads(out)


@pytest.fixture(scope="module")
def stm32() -> Workspace:
    return load_robot("stm32").workspace(tolerance=5.0)


def test_it_tells_how_far_the_default_robot_reaches(capsys: pytest.CaptureFixture[str]) -> None:
    status, out, err = run(capsys, "workspace", *COARSE)
    assert (status, err) == (0, "")
    lines = out.splitlines()
    assert lines[0] == "stm32: tool tip, limits reach, joints, ball-joints, singularities, " \
        "collisions"  # fmt: skip
    assert lines[1].startswith("Volume 30.")
    assert "Z -45" in lines[2]
    assert "Of its zone 74" in lines[3]
    assert [line.split()[0] for line in lines if line.startswith("  -")] == [
        "-200", "-250", "-300", "-350", "-400", "-450",
    ]  # fmt: skip
    for start in ("Largest: cylinder ", "Largest: box ", "condition ", "resolution ", "Holding "):
        assert any(line.startswith(start) for line in lines), start


def test_a_planar_robot_has_an_area(capsys: pytest.CaptureFixture[str]) -> None:
    status, out, _ = run(capsys, "workspace", "--robot", "fivebar", *COARSE)
    assert status == 0
    assert "Area 35" in out
    assert "Largest: rectangle " in out
    assert "cylinder" not in out
    assert "Y " not in out.splitlines()[2]


def test_json_holds_the_same_as_the_text(capsys: pytest.CaptureFixture[str]) -> None:
    data = found(capsys)
    assert data["robot"] == "fivebar"
    assert data["empty"] is False
    assert data["area_mm2"] == pytest.approx(35_050, rel=0.01)
    assert data["extents_mm"]["z"] == pytest.approx([-290.8, -80.8], abs=0.5)
    assert data["reach"][0]["z_mm"] == -100
    assert data["largest_cylinder"] is None
    assert data["largest_box"]["size_mm"][0] > 160
    assert data["quality"]["condition"]["worst"] > data["quality"]["condition"]["best"]
    assert len(data["torque"]["holding_nm"]) == 2


def test_limits_are_chosen(capsys: pytest.CaptureFixture[str]) -> None:
    wide = found(capsys, "--limits", "reach")
    within = found(capsys, "--limits", "joints")
    zone = found(capsys, "--limits", "joints,zone")
    assert wide["area_mm2"] > within["area_mm2"] > zone["area_mm2"]
    assert zone["limits"] == ["reach", "joints", "zone"]
    assert zone["extents_mm"]["z"][0] >= -240


@pytest.mark.parametrize(
    ("shape", "status", "says"),
    [
        (("--cylinder", "380", "80"), 0, "Fits: cylinder 380 mm across and 80 mm high"),
        (("--cylinder", "380", "80", "--at", "-330"), 0, "Z -330 to -250 mm"),
        (("--cylinder", "800", "80"), 1, "Does not fit: cylinder 800 mm across"),
        (("--box", "200", "250", "50"), 0, "Fits: box of 200 by 250 by 50 mm"),
        (("--box", "700", "100", "50"), 1, "Of this height the first side may be "),
        (("--belt", "200", "40", "--at", "-340"), 0, "Served: belt 200 mm wide along x"),
        (("--belt", "200", "--at", "-340", "--along", "y"), 0, "from y -"),
        (("--belt", "800", "40", "--at", "-340"), 1, "mm too wide"),
    ],
)
def test_does_it_fit(
    capsys: pytest.CaptureFixture[str], shape: tuple[str, ...], status: int, says: str
) -> None:
    code, out, err = run(capsys, "workspace", *COARSE, *shape)
    assert (code, err) == (status, "")
    assert says in out


def test_what_does_not_fit_says_by_how_much_and_where(capsys: pytest.CaptureFixture[str]) -> None:
    status, out, _ = run(
        capsys, "workspace", "--json", *COARSE, "--cylinder", "440", "100", "--at", "-360"
    )
    answer = json.loads(out)["cylinder"]
    assert status == 1
    assert answer["fits"] is False
    assert answer["clearance_mm"] < 0
    assert 0 < answer["unreached"] < 0.5
    assert 300 < answer["largest_width_mm"] < 440
    robot = load_robot("stm32")
    assert not robot.reach(answer["where_mm"]).legal
    _, out, _ = run(capsys, "workspace", *COARSE, "--cylinder", "440", "100", "--at", "-360")
    assert "It would have to shrink by " in out
    assert "Worst at (" in out


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        (("--cylinder", "-3", "10"), "must be greater than 0"),
        (("--box", "10"), "--box takes 3 lengths for this robot; got 1"),
        (("--belt", "100"), "--belt needs --at Z"),
        (("--belt", "1", "2", "3", "--at", "0"), "got 3 lengths"),
        (("--at", "nan"), "is no finite number"),
        (("--limits", "legs"), "'legs' is none of reach, joints"),
        (("--colour", "condition"), "--colour needs --plot"),
        (("--colour", "beauty", "--plot", "x.png"), "use one of condition, slowest"),
        (("--robot", "fivebar", "--cylinder", "1", "2"), "in a plane there are none"),
        (("--robot", "fivebar", "--stl", "x.stl"), "has no surface"),
        (("--robot", "fivebar", "--belt", "9", "--at", "0", "--along", "y"), "plane of x and z"),
    ],
)
def test_bad_usage(
    capsys: pytest.CaptureFixture[str], arguments: tuple[str, ...], says: str
) -> None:
    status, out, err = run(capsys, "workspace", *arguments)
    assert (status, out) == (2, "")
    assert says in err


def test_an_empty_workspace_says_why(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    robot = tmp_path / "fat.toml"
    text = preset_text("stm32")
    robot.write_text(
        text.replace("rod_diameter = 6 ", "rod_diameter = 300 ").replace(
            "rod_spacing = 50 ", "rod_spacing = 400 "
        )
    )
    status, out, err = run(capsys, "workspace", "--robot", str(robot), "--json")
    assert status == 1
    assert "parts of the robot would touch" in err
    assert json.loads(out)["empty"] is True
    assert "would touch" in json.loads(out)["reason"]


def test_the_csv_is_read_back(stm32: Workspace, tmp_path: Path) -> None:
    path = tmp_path / "points.csv"
    count = write_csv(stm32, str(path), 20.0)
    with path.open(newline="") as file:
        rows = list(csv.DictReader(file))
    xyz = np.array([[float(row[f"{axis}_mm"]) for axis in "xyz"] for row in rows])
    theta = np.array([[float(row[f"theta{i}_deg"]) for i in (1, 2, 3)] for row in rows])
    assert len(rows) == count == pytest.approx(30.86e6 / 20**3, rel=0.03)
    np.testing.assert_allclose(stm32.robot.forward(np.radians(theta)), xyz, atol=1e-3)
    assert {row["limit"] for row in rows} >= {"arm 1 lower joint limit", "arm 2 ball joint"}
    assert all(float(row["margin_mm"]) >= 0 for row in rows)


def test_the_command_writes_files(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    points, picture = tmp_path / "points.csv", tmp_path / "reach.svg"
    found(capsys, "--csv", str(points), "--plot", str(picture))
    assert points.read_text().startswith("x_mm,z_mm,theta1_deg,theta2_deg,margin_mm,limit\n")
    assert "<svg" in picture.read_text()


def test_the_stl_is_a_closed_surface(stm32: Workspace, tmp_path: Path) -> None:
    path = tmp_path / "reach.stl"
    write_stl(stm32, str(path))
    mesh = trimesh.load_mesh(path)
    assert mesh.is_watertight
    assert mesh.volume == pytest.approx(30.86e6, rel=0.01)


@pytest.mark.parametrize("colour", [None, "resolution"])
def test_pictures_show_something(stm32: Workspace, tmp_path: Path, colour: str | None) -> None:
    path = tmp_path / "reach.png"
    stm32.plot(str(path), colour=colour)
    picture = np.asarray(Image.open(path).convert("RGB"))
    assert picture.shape[1] > 800
    colours = np.unique(picture.reshape(-1, 3), axis=0)
    assert len(colours) > (1000 if colour else 100)


def test_a_picture_that_cannot_be_written(capsys: pytest.CaptureFixture[str]) -> None:
    status, _, err = run(
        capsys, "workspace", "--robot", "fivebar", *COARSE, "--plot", "/nowhere/x.png"
    )
    assert status == 1
    assert "/nowhere/x.png" in err


def test_without_matplotlib_it_says_how_to_get_it(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "matplotlib", None)
    monkeypatch.setitem(sys.modules, "matplotlib.figure", None)
    status, out, err = run(capsys, "workspace", "--robot", "fivebar", *COARSE, "--plot", "x.png")
    assert status == 1
    assert "pip install 'deltaviz[plot]'" in err
    assert "Area" in out  # the rest is told all the same


def test_the_notebook_has_a_figure() -> None:
    figure = load_robot("fivebar").workspace(tolerance=5.0).plot()
    assert figure.axes


def test_other_commands_load_none_of_it() -> None:
    code = (
        "import sys; from deltaviz.cli import main; main(['ik', '0', '0', '-300'])\n"
        "assert not {'skimage', 'scipy', 'matplotlib', 'numba'} & set(sys.modules), sys.modules"
    )
    subprocess.run([sys.executable, "-c", code], check=True, capture_output=True)
