"""What a person is told about a robot file that cannot be."""

import re
import subprocess
import sys
from pathlib import Path

import pytest

from deltaviz.robots import RobotFileError, load_robot
from deltaviz.robots.load import parse_robot
from deltaviz.robots.presets import preset_text


def line_with(text: str, start: str) -> int:
    return next(n for n, line in enumerate(text.splitlines(), 1) if line.startswith(start))


# (what stands in the stm32 preset, what to write instead, field, what the message says)
CHANGES = [
    ("forearm = 338.0", "forearm = -338.0", "geometry.forearm", "greater than 0"),
    ("forearm = 338.0", "forearm = 0", "geometry.forearm", "greater than 0"),
    ("forearm = 338.0", "forearm = 1e308", "geometry.forearm", "at most 100000 mm"),
    ("forearm = 338.0", "forearm = nan", "geometry.forearm", "finite"),
    ("forearm = 338.0", "forearm = inf", "geometry.forearm", "finite"),
    ("forearm = 338.0", 'forearm = "long"', "geometry.forearm", "'long'.*a number"),
    ("forearm = 338.0", "forearm = true", "geometry.forearm", "a number"),
    ("forearm = 338.0", "forearm = [338, 338]", "geometry.forearm", "one value, or 3"),
    ("forearm = 338.0", "forearm = [338, 338, nan]", "geometry.forearm", "finite"),
    ("forearm = 338.0", "forarm = 338.0", "geometry.forarm", "did you mean 'forearm'"),
    ("forearm = 338.0", "colour = 3", "geometry.colour", "known here: base_radius"),
    ("base_radius = 115.0", "base_radius = 900.0", "geometry.base_radius", "arm 1 cannot close"),
    ("base_radius = 115.0", "base_side = 400", "geometry", "either base_radius and effector_radi"),
    (
        "azimuths_deg = [0, 120, 240]",
        "azimuths_deg = [0, 120, 120]",
        "geometry.azimuths_deg",
        "1° apart",
    ),
    (
        "azimuths_deg = [0, 120, 240]",
        "azimuths_deg = [0, 90, 180, 270]",
        "geometry.azimuths_deg",
        r"must be 3 directions \(one per arm\)",
    ),
    ("tool_offset = [0, 0, 0]", "tool_offset = [0, 0]", "geometry.tool_offset", r"\[x, y, z\]"),
    ("min_deg = -45", "min_deg = 95", "joints.min_deg", r"less than joints.max_deg \(90\)"),
    ("min_deg = -45", "min_deg = -500", "joints.min_deg", "between -180 and 180"),
    (
        "ball_joint_max_deg = 45",
        "ball_joint_max_deg = 90",
        "joints.ball_joint_max_deg",
        "between 0 and 90, and neither of them",
    ),
    ("max_deg = 90", "max_deg = 180", "joints.max_deg", "180, and neither of them"),
    ("z = [-440, -225]", "z = [-225, -440]", "workspace.z", "low < high"),
    ("z = [-440, -225]", "z = -440", "workspace.z", r"\[low, high\]"),
    (
        "z = [-440, -225]",
        "z = [100, 200]",
        "workspace",
        r"z \[100.0, 200.0\], radius 230.0: must hold at least one point",
    ),
    ("z = [-440, -225]", "z = [-1e9, -225]", "workspace.z", "between -100000 and 100000 mm"),
    ("radius = 230", "radius = 1e6", "workspace.radius", "at most 100000 mm"),
    ("radius = 230", "x = [-1, 1]", "workspace", r"radius \(a cylinder\), or x and y"),
    ("velocity_deg_s = 340", "velocity_deg_s = 0", "limits.joint.velocity_deg_s", "greater than 0"),
    (
        "velocity_deg_s = 340",
        "velocity_deg_s = 1e6",
        "limits.joint.velocity_deg_s",
        "99800 steps a sec",
    ),
    ("velocity_deg_s = 340", "velocity_deg_s = 10", "homing.fast_deg_s", "at most limits.joint"),
    (
        "unhomed_velocity_deg_s = 5",
        "unhomed_velocity_deg_s = 500",
        "limits.joint.unhomed_velocity_deg_s",
        "at most 340",
    ),
    ("jerk = 150000", "jerk = -1", "limits.cartesian.jerk", "greater than 0"),
    ("forearm = 338.0", "forearm = 30", "geometry.forearm", "greater than 40.*cannot meet"),
    ("rod_diameter = 6 ", "rod_diameter = 0 ", "bodies.rod_diameter", "greater than 0"),
    ("rod_spacing = 50 ", "rod_spacing = 25 ", "bodies.rod_spacing", r"pass on both sides"),
    ("effector_kg = 0.12", "effector_kg = -1", "masses.effector_kg", "greater than 0"),
    ("forearm_kg = 0.05", "forearms_kg = 0.05", "masses.forearms_kg", "did you mean"),
    ("full_steps = 200", "full_steps = 1.8", "drive.full_steps", "whole number"),
    ("full_steps = 200", "full_steps = 0", "drive.full_steps", "whole number"),
    ('driver = "DRV8825"', 'driver = ""', "drive.driver", "a text"),
    ('kind = "step_dir"', 'kind = "steam"', "drive.kind", "'steam'.*'step_dir' or 'servo'"),
    ('kind = "step_dir"', 'kind = "servo"', "drive.full_steps", 'not used with kind = "servo"'),
    ("gear = [1, 1]", "gear = [1, 0]", "drive.gear", "greater than 0"),
    ("invert = [false, false, false]", "invert = [0, 0, 0]", "drive.invert", "true or false"),
    ('enable_active = "low"', 'enable_active = "maybe"', "drive.enable_active", "'low' or 'high'"),
    ('direction = "up"', 'direction = "left"', "homing.direction", "'up' or 'down'"),
    (
        'direction = "up"',
        'direction = "down"',
        "homing.switch_deg",
        r"beyond joints.max_deg \(90\)",
    ),
    (
        "switch_deg = [-50.0, -50.0, -50.0]",
        "switch_deg = [-50, -30, -50]",
        "homing.switch_deg",
        r"-30.*joints.min_deg \(-45\)",
    ),
    ("slow_deg_s = 2", "slow_deg_s = 40", "homing.slow_deg_s", r"at most homing.fast_deg_s \(20\)"),
    ("max_travel_deg = 170", "max_travel_deg = 100", "homing.max_travel_deg", "at least 140"),
    ("backoff_deg = 5", "backoff_deg = 141", "homing.backoff_deg", "at most 140"),
    ("ready_deg = 0", "ready_deg = 89", "homing.ready_deg", "lower end of the workspace"),
    ("ready_deg = 0", "ready_deg = [0, 0, 100]", "homing.ready_deg", "arm 3 upper joint limit"),
    ("ready_deg = 0", "ready_deg = [0, 0]", "homing.ready_deg", "one value, or 3"),
    ('name = "stm32"', 'name = ""', "name", "a text"),
    ('kind = "rotary_delta"', 'kind = "hexapod"', "kind", "must be 'rotary_delta' or 'five_bar'"),
    ('kind = "rotary_delta"', "kind = 3", "kind", "3: must be 'rotary_delta' or"),
]

# The same for the preset fivebar.
PLANAR_CHANGES = [
    ("base_half = 80.0", "base_half = -1", "geometry.base_half", "at least 0"),
    ("base_half = 80.0", "base_half = [80, 80, 80]", "geometry.base_half", "one value, or 2"),
    ("base_half = 80.0", "base_half = 700", "geometry.base_half", "forearms cannot meet"),
    ("base_half = 80.0", "base_hlaf = 80", "geometry.base_hlaf", "did you mean 'base_half'"),
    ("base_half = 80.0", "base_radius = 80", "geometry.base_radius", "did you mean 'base_half'"),
    ("forearm = 200.0", "forearm = 0", "geometry.forearm", "greater than 0"),
    ("tool_offset = [0, 0, 0]", "tool_offset = [0, 5, 0]", "geometry.tool_offset", "has no y"),
    ("min_deg = -45", "min_deg = [-45, -45, -45]", "joints.min_deg", "one value, or 2"),
    ("max_deg = 90", "ball_joint_max_deg = 40", "joints.ball_joint_max_deg", "known here: min_deg"),
    ("x = [-100, 100]", "radius = 100", "workspace.radius", "known here: x, z"),
    ("z = [-240, -130]", "z = [10, 20]", "workspace", "at least one point"),
    ("invert = [false, false]", "invert = [1, 0]", "drive.invert", "true or false"),
    ("forearm_width = 14", "forearm_width = 0", "bodies.forearm_width", "greater than 0"),
    (
        "forearm_width = 14",
        "rod_diameter = 14",
        "bodies.rod_diameter",
        "known here: base_thickness",
    ),
    ("switch_deg = [-50, -50]", "switch_deg = [-50, -30]", "homing.switch_deg", r"min_deg \(-45\)"),
    ("ready_deg = 20 ", "ready_deg = 88 ", "homing.ready_deg", "lower end of the workspace"),
    ("ready_deg = 20 ", "ready_deg = [0, 95] ", "homing.ready_deg", "arm 2 upper joint limit"),
    ('name = "fivebar"', 'name = "x"\ntool_axis = 3', "tool_axis", "known here: name, kind"),
]


@pytest.mark.parametrize(
    ("preset", "before", "after", "field", "says"),
    [("stm32", *change) for change in CHANGES]
    + [("fivebar", *change) for change in PLANAR_CHANGES],
    ids=lambda part: part[:40],
)
def test_what_is_wrong_and_where(preset, before, after, field, says):
    good = preset_text(preset)
    assert before in good
    text = good.replace(before, after)
    with pytest.raises(RobotFileError) as refused:
        parse_robot(text, source="my.toml")
    message = str(refused.value)
    found = re.search(rf"^my\.toml, line (\d+): {re.escape(field)}\b.*{says}", message, re.M)
    assert found, message
    shown = text.splitlines()[int(found[1]) - 1]
    assert shown.split(" ")[0].strip("[]") in (field, field.split(".")[-1])


@pytest.mark.parametrize(
    ("line", "field", "section"),
    [
        ("forearm", "geometry.forearm", "[geometry]"),
        ("jerk", "limits.cartesian.jerk", "[limits.cartesian]"),
        ("ready_deg", "homing.ready_deg", "[homing]"),
        ("driver", "drive.driver", "[drive]"),
    ],
)
def test_a_missing_field_is_named_with_its_section(stm32_text, line, field, section):
    text = "\n".join(row for row in stm32_text.splitlines() if not row.startswith(line))
    with pytest.raises(RobotFileError, match=field) as refused:
        parse_robot(text)
    assert f"line {line_with(text, section)}:" in str(refused.value)


def test_a_missing_section(stm32_text):
    with pytest.raises(RobotFileError, match="workspace is missing"):
        parse_robot(re.sub(r"\[workspace\][^\[]*\[[^\[]*", "", stm32_text))


def test_a_missing_kind(stm32_text):
    text = stm32_text.replace('kind = "rotary_delta"', "")
    with pytest.raises(RobotFileError, match="kind is missing; it must be 'rotary_delta' or"):
        parse_robot(text)


def test_a_value_in_the_place_of_a_section():
    with pytest.raises(RobotFileError, match=r"geometry = 3: must be a section, \[geometry\]"):
        parse_robot('name = "x"\nkind = "rotary_delta"\ngeometry = 3\n')


def test_a_misspelt_field_is_told_once(stm32_text):
    with pytest.raises(RobotFileError) as refused:
        parse_robot(stm32_text.replace("forearm = 338.0", "forarm = 338.0"))
    assert len(str(refused.value).splitlines()) == 1


def test_several_mistakes_are_told_together_in_the_files_order(stm32_text):
    text = stm32_text.replace("jerk = 150000", "jerk = -1").replace("z = [-440", "z = [440")
    with pytest.raises(RobotFileError) as refused:
        parse_robot(text)
    first, second = str(refused.value).splitlines()
    assert "workspace.z" in first
    assert "limits.cartesian.jerk" in second


def test_broken_toml_names_the_line():
    with pytest.raises(RobotFileError, match=r"not valid TOML.*line 2"):
        parse_robot('name = "x"\nkind = = 3\n')


def test_lines_are_found_in_other_styles_of_toml(stm32_text):
    text = stm32_text.replace("[limits.cartesian]", "[ limits . cartesian ]")
    text = text.replace("azimuths_deg = [0, 120, 240]", "azimuths_deg = [\n 0,\n 120,\n 240]")
    text = text.replace("jerk = 150000", '"jerk" = 0')
    with pytest.raises(RobotFileError) as refused:
        parse_robot(text)
    assert f"line {line_with(text, chr(34) + 'jerk')}: limits.cartesian.jerk" in str(refused.value)


def test_dotted_keys(stm32_text):
    head, _, tail = stm32_text.partition("[limits.joint]")
    limits, drive, rest = tail.partition("[drive]")
    joint, _, cartesian = limits.partition("[limits.cartesian]")
    dotted = "[limits]\n" + "".join(
        f"{section}.{row}\n"
        for section, rows in (("joint", joint), ("cartesian", cartesian))
        for row in rows.splitlines()
        if "=" in row
    )
    text = head + dotted.replace("jerk = 150000", "jerk = -5") + drive + rest
    with pytest.raises(RobotFileError) as refused:
        parse_robot(text)
    assert f"line {line_with(text, 'cartesian.jerk')}: limits.cartesian.jerk" in str(refused.value)


class TestNamesAndPaths:
    def test_a_file_of_ones_own(self, stm32_text, tmp_path):
        path = tmp_path / "mine.toml"
        path.write_text(stm32_text.replace('"stm32"', '"mine"').replace("338.0", "[338, 339, 337]"))
        for given in (path, str(path)):
            robot = load_robot(given)
            assert robot.name == "mine"
            assert robot.mechanism.forearm == (338.0, 339.0, 337.0)

    def test_a_relative_path(self, stm32_text, tmp_path, monkeypatch):
        monkeypatch.chdir(tmp_path)
        Path("mine.toml").write_text(stm32_text)
        Path("robots").mkdir()
        Path("robots/other").write_text(stm32_text)
        assert load_robot("mine.toml") == load_robot("robots/other") == load_robot("stm32")

    def test_a_file_that_is_not_there(self):
        with pytest.raises(RobotFileError, match=r"nowhere\.toml: No such file"):
            load_robot("nowhere.toml")

    def test_a_folder(self, tmp_path):
        with pytest.raises(RobotFileError, match="directory"):
            load_robot(f"{tmp_path}/")

    def test_not_text(self, tmp_path):
        (tmp_path / "bad.toml").write_bytes(b"\xff\xfe\x00")
        with pytest.raises(RobotFileError, match="UTF-8"):
            load_robot(tmp_path / "bad.toml")

    @pytest.mark.parametrize(
        ("name", "near"), [("stm23", "stm32"), ("Trossen", "trossen"), ("zheng", "zheng2023")]
    )
    def test_a_misspelt_preset(self, name, near):
        with pytest.raises(RobotFileError, match=f"did you mean '{near}'"):
            load_robot(name)

    def test_an_unknown_preset_lists_the_known(self):
        with pytest.raises(RobotFileError, match="stm32, deltadraw, fivebar, trossen, zheng2023"):
            load_robot("xyzzy")


def test_import_is_light():
    """Neither numba nor pydantic nor a web server before they are needed."""
    code = (
        "import sys, deltaviz, deltaviz.robots, deltaviz.mechanism\n"
        "heavy = {'numba', 'viser', 'fastapi', 'pydantic', 'ruckig'} & set(sys.modules)\n"
        "assert not heavy, heavy\n"
        "robot = deltaviz.load_robot('stm32')\n"
        "robot.reach([0, 0, -300]), robot.inverse([0, 0, -300])\n"
        "assert 'numba' not in sys.modules\n"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
