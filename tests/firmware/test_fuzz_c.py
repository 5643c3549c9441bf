"""The fuzzers of firmware/fuzz, for a moment: what they found once, and a few thousand new inputs.

For longer: `make -C firmware fuzz-for SECONDS=3600`.
"""

from __future__ import annotations

import runpy
import shutil
import subprocess
from pathlib import Path

import pytest

from tests.firmware.c_board import FIRMWARE, run_make

CORPUS = FIRMWARE / "fuzz" / "corpus"


@pytest.fixture(scope="module")
def fuzzers() -> Path:
    run_make("fuzz")
    return FIRMWARE / "build" / "fuzz"


@pytest.mark.parametrize(("name", "runs"), [("frames", 50_000), ("board", 5000)])
def test_nothing_makes_it_stumble(fuzzers: Path, tmp_path: Path, name: str, runs: int) -> None:
    shutil.copytree(CORPUS / name, tmp_path / "corpus")
    options = [f"-runs={runs}", "-seed=1", "-timeout=20", f"-artifact_prefix={tmp_path}/"]
    command = [str(fuzzers / f"fuzz_{name}"), *options, str(tmp_path / "corpus")]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr[-5000:]
    assert f"Done {runs} runs" in done.stderr


def test_what_they_begin_with_speaks_todays_protocol() -> None:
    seeds = runpy.run_path(str(FIRMWARE / "fuzz" / "seeds.py"))
    expected = {f"board/{name}": session.steps for name, session in seeds["sessions"]().items()}
    expected |= {f"frames/{name}": data for name, data in seeds["frames"]().items()}
    for name, data in expected.items():
        path = CORPUS / name
        assert path.read_bytes() == data, f"{path} is out of date: python firmware/fuzz/seeds.py"
