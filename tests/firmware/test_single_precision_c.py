"""For the board's processor, which computes in single precision only: nothing brings in more."""

from __future__ import annotations

import re
import subprocess
from pathlib import Path

from tests.firmware.c_library import CORE, STRICT_C

CORTEX_M4F = ["-mthumb", "-mcpu=cortex-m4", "-mfpu=fpv4-sp-d16", "-mfloat-abi=hard"]
SOURCES = sorted(CORE.glob("*.c"))
USED = ["dv_board_init", "dv_board_piece", "dv_board_poll", "dv_stepper_tick", "dv_inverse"]


def run(*command: str) -> str:
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return done.stdout


def linked(target: Path, *sources: Path) -> set[str]:
    """The names in a program of these sources and all that they need of the libraries."""
    needed = [f"-Wl,-u,{name}" for name in USED]
    options = ["-O2", "-nostartfiles", "-Wl,-e,dv_board_poll", "-specs=nosys.specs", *needed]
    files = [*map(str, sources), "-lm", "-lc", "-o", str(target)]
    run("arm-none-eabi-gcc", *STRICT_C, *CORTEX_M4F, *options, *files)
    return {line.split()[-1] for line in run("arm-none-eabi-nm", str(target)).splitlines()}


def soft_floats(names: set[str]) -> set[str]:
    return {name for name in names if re.match(r"__aeabi_([fd]|c[fd]|u?[il]2[fd])", name)}


def test_no_soft_floats(tmp_path):
    names = linked(tmp_path / "board.elf", *SOURCES)
    assert set(USED) <= names
    assert soft_floats(names) == set()


def test_a_soft_float_would_be_found(tmp_path):
    doubling = tmp_path / "doubling.c"
    doubling.write_text("double dv_twice(double x);\ndouble dv_twice(double x) { return 2 * x; }\n")
    names = linked(tmp_path / "board.elf", *SOURCES, doubling)
    assert soft_floats(names) >= {"__aeabi_dadd"}
