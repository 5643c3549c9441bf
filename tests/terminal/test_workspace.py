"""`deltaviz workspace`: what a person reads of a robot's reach, and the files it writes."""

from __future__ import annotations

import csv
import json
import re
import subprocess
import sys
from io import BytesIO
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
from deltaviz.robots.workspace.field import MOST_NODES, Grid
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
    assert re.search(r"Area 3[45]\d\.\d cm²", out)
    assert "Largest: rectangle " in out
    assert "cylinder" not in out
    assert "Y " not in out.splitlines()[2]


def hundredth(preset: str) -> str:
    """The same robot with all lengths (and speeds) a hundredth."""
    head, rest = preset_text(preset).split("[joints]")
    zone = rest.index("[workspace]")

    def smaller(found: re.Match[str]) -> str:
        return f"{found[1]}{float(found[2]) / 100!r}"

    lengths = re.sub(r"(?m)^((?:base|platform|upper|fore)\w* = )([\d.]+)", smaller, head)
    cut = rest.index("[limits.joint]")
    space = re.sub(r"([\[ ])(-?[\d.]+)(?=[,\]])", smaller, rest[zone:cut])
    others = re.sub(r"(?m)^(\w+_(?:thickness|width) = )([\d.]+)", smaller, rest[cut:])
    return f"{lengths}[joints]{rest[:zone]}{space}{others}"


def test_a_robot_of_a_few_mm_is_judged_as_finely_as_its_size(
    capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    path = tmp_path / "small.toml"
    path.write_text(hundredth("fivebar"))
    status, out, _ = run(capsys, "workspace", "--robot", str(path))
    assert status == 0
    assert "Area 3.5" in out
    assert " cm²" not in out
    rows = [line.split() for line in out.splitlines() if line.startswith("  -")]
    assert rows
    assert all(float(nearest) == 0 < float(farthest) for _, farthest, _, nearest in rows)
    small = load_robot(str(path)).workspace()
    large = load_robot("fivebar").workspace()
    for one, other in zip(small.extents.size, large.extents.size, strict=True):
        assert 100 * one == pytest.approx(other, rel=0.01)


def test_a_resolution_beyond_all_use_is_refused(capsys: pytest.CaptureFixture[str]) -> None:
    """The five-bar's forearms are 200 mm long."""
    status, out, err = run(capsys, "workspace", "--robot", "fivebar", "--resolution", "0.0099")
    assert (status, out) == (2, "")
    assert err.startswith("deltaviz: --resolution 0.0099: at least 0.01 mm, 1/20000 of the forearm")
    finest = ("--resolution", "0.01", "--box", "9", "9", "--at", "-250")
    assert run(capsys, "workspace", "--robot", "fivebar", *finest)[0] == 0


def test_json_holds_the_same_as_the_text(capsys: pytest.CaptureFixture[str]) -> None:
    data = found(capsys)
    assert data["robot"] == "fivebar"
    assert data["empty"] is False
    assert data["area_mm2"] == pytest.approx(35_050, rel=0.01)
    low, high = data["extents_mm"]["z"]
    assert low == pytest.approx(-290.8, abs=0.5)
    assert -85 < high < -80.8  # where its joints alone would end it
    assert data["reach"][0]["z_mm"] == -100
    assert data["largest_cylinder"] is None
    assert data["largest_box"]["size_mm"][0] > 160
    assert data["quality"]["condition"]["worst"] > data["quality"]["condition"]["best"]
    assert "ball_joint_deg" not in data["quality"]
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
    ("sides", "at"),
    [(("--cylinder", "405.83", "100"), "-360"), (("--box", "288", "288", "100"), "-360")],
)
@pytest.mark.parametrize("more", [-0.05, 0.05, 1.0])
def test_near_the_limit_no_sentence_gainsays_another(
    capsys: pytest.CaptureFixture[str], sides: tuple[str, ...], at: str, more: float
) -> None:
    shape, *widths, height = sides
    wider = [f"{float(width) + more:.3f}" for width in widths]
    asked = ("workspace", *COARSE, shape, *wider, height, "--at", at)
    answer = json.loads(run(capsys, *asked, "--json")[1])[shape.removeprefix("--")]
    out = run(capsys, *asked)[1]
    assert "by -" not in out
    assert "by 0.0" not in out
    if answer["fits"]:
        assert out.startswith("Fits: ")
        return
    told = re.search(r"may be ([0-9.]+) mm \(none above ([0-9.]+) fits\)", out)
    assert told is not None
    found, most = map(float, told.groups())
    assert found <= answer["largest_width_mm"] <= answer["none_above_mm"] <= most
    assert found < float(wider[0])
    assert f"; {float(wider[0]):g} mm was asked for" in out
    proved = float(wider[0]) > answer["none_above_mm"]
    assert answer["fits"] is (False if proved else None)
    assert out.startswith(
        "Does not fit: " if proved else "Not found to fit, and not proved not to: "
    )


def test_between_what_was_found_and_the_bound_nothing_is_denied(
    capsys: pytest.CaptureFixture[str],
) -> None:
    asked = ("workspace", "--anywhere", "--cylinder", "24", "60", "--at", "-230")
    status, out, _ = run(capsys, *asked)
    assert status == 1
    assert out.startswith("Not found to fit, and not proved not to: cylinder 24 mm across")
    answer = json.loads(run(capsys, *asked, "--json")[1])["cylinder"]
    assert answer["fits"] is None
    assert answer["largest_width_mm"] < 24 < answer["none_above_mm"]


def test_a_belt_that_is_too_wide_says_where_the_widest_is(
    capsys: pytest.CaptureFixture[str],
) -> None:
    belt = ("workspace", *COARSE, "--belt", "800", "40", "--at", "-340")
    answer = json.loads(run(capsys, *belt, "--json")[1])["belt"]
    assert answer["widest_mm"] < answer["none_wider_mm"] < 800
    assert abs(answer["widest_at_mm"]) < 100
    assert all(limit is not None for limit in answer["limits"])
    out = run(capsys, *belt)[1]
    assert f"at x {answer['widest_at_mm']:.1f} mm" in out
    assert all(f"the {limit}" in out for limit in answer["limits"])


def test_a_belt_beside_the_axis_of_which_enough_must_be_served(
    capsys: pytest.CaptureFixture[str],
) -> None:
    belt = ("workspace", *COARSE, "--belt", "120", "40", "--at", "-340", "--offset", "60")
    status, out, _ = run(capsys, *belt, "--stretch", "100")
    assert status == 0
    assert out.splitlines()[1].startswith("  It ends at the ")
    status, out, _ = run(capsys, *belt, "--stretch", "1000")
    assert status == 1
    assert out.startswith("Not served for long enough: ")
    assert "of 1000 asked for" in out


@pytest.mark.parametrize(
    ("robot", "limits", "left_out"),
    [
        (
            "stm32 without bodies",
            ["reach", "joints", "ball-joints", "singularities"],
            ["collisions"],
        ),
        ("fivebar", ["reach", "joints", "singularities", "collisions"], ["ball-joints"]),
        ("stm32", ["reach", "joints", "ball-joints", "singularities", "collisions"], []),
    ],
)
def test_only_limits_that_were_considered_are_told(
    capsys: pytest.CaptureFixture[str],
    tmp_path: Path,
    robot: str,
    limits: list[str],
    left_out: list[str],
) -> None:
    if robot.endswith(" without bodies"):
        text = re.sub(r"\[bodies\][^\[]*", "", preset_text("stm32"))
        robot = str(tmp_path / "bare.toml")
        Path(robot).write_text(text)
    size = ("--box", "9", "9") if robot == "fivebar" else ("--box", "9", "9", "9")
    asked = ("workspace", *COARSE, "--robot", robot, *size, "--at", "-250")
    data = json.loads(run(capsys, *asked, "--json")[1])
    assert data["limits"] == limits
    assert list(data["not_considered"]) == left_out
    out = run(capsys, *asked)[1]
    assert [line for line in out.splitlines() if line.startswith("Not considered: ")] == [
        f"Not considered: {name}; {data['not_considered'][name]}." for name in left_out
    ]


def test_points_without_end_are_refused(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    path = tmp_path / "points.csv"
    asked = ("workspace", "--robot", "fivebar", "--box", "10", "10", "--csv", str(path))
    status, _, err = run(capsys, *asked, "--resolution", "0.01")
    assert status == 1
    assert err.startswith("deltaviz: --resolution: a spacing of 0.01 mm makes ")
    assert not path.exists()
    possible = float(err.split("use ")[1].split(" mm")[0])
    box = load_robot("fivebar").workspace().box
    assert np.prod(Grid.around(box, possible).shape) <= MOST_NODES


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        (("--stretch", "9"), "--stretch needs --belt"),
        (("--offset", "9"), "--offset needs --belt"),
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


@pytest.mark.parametrize("option", ["--plot", "--csv", "--stl"])
def test_a_file_that_cannot_be_written_is_told_first(
    capsys: pytest.CaptureFixture[str], option: str
) -> None:
    status, out, err = run(capsys, "workspace", *COARSE, option, "/nowhere/x.png")
    assert (status, out) == (1, "")
    assert err == f"deltaviz: {option} /nowhere/x.png: No such file or directory\n"


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
    figure: Any = load_robot("fivebar").workspace(tolerance=5.0).plot()
    assert Image.open(BytesIO(figure._repr_png_())).size[0] > 400


def test_the_boundary_is_coloured_by_the_scale_of_the_sections(stm32: Workspace) -> None:
    figure = stm32.plot(colour="condition")
    space, *views = (axes for axes in figure.axes if axes.get_title())
    surface = space.collections[0]
    values = np.asarray(surface.get_array())
    centres = stm32.boundary.vertices[stm32.boundary.faces].mean(axis=1)
    expected = stm32.quality(centres).condition
    near = np.isfinite(values) & np.isfinite(expected)
    assert near.mean() > 0.9
    assert np.median(np.abs(values[near] / expected[near] - 1)) < 0.03
    for view in views:
        (section,) = (c for c in view.collections if type(c).__name__ == "QuadMesh")
        assert section.get_clim() == surface.get_clim()
        assert section.get_cmap().name == surface.get_cmap().name


def test_other_commands_load_none_of_it() -> None:
    code = (
        "import sys; from deltaviz.cli import main; main(['ik', '0', '0', '-300'])\n"
        "assert not {'skimage', 'scipy', 'matplotlib', 'numba'} & set(sys.modules), sys.modules"
    )
    subprocess.run([sys.executable, "-c", code], check=True, capture_output=True)
