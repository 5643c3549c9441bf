"""What the docs take from the code is today's."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]


def test_the_generated_parts_are_todays() -> None:
    check = [sys.executable, ROOT / "docs" / "generate.py", "--check"]
    done = subprocess.run(check, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr


def test_the_figures_are_todays() -> None:
    check = [sys.executable, ROOT / "docs" / "figures.py", "--check"]
    done = subprocess.run(check, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr


def test_a_stale_part_is_seen(tmp_path: Path) -> None:
    for name in ("generate.py", "architecture.md"):
        (tmp_path / name).write_text((ROOT / "docs" / name).read_text())
    page = tmp_path / "architecture.md"
    page.write_text(page.read_text().replace("idle -->", "idle ..>"))
    check = [sys.executable, tmp_path / "generate.py", "--check"]
    done = subprocess.run(check, capture_output=True, text=True)
    assert done.returncode == 1
    assert "architecture.md" in done.stdout


@pytest.mark.parametrize("page", ["README.md", "docs/kinematics.md", "docs/sources.md"])
def test_every_picture_and_page_that_is_linked_exists(page: str) -> None:
    text = (ROOT / page).read_text()
    for link in (part.split(")")[0] for part in text.split("](")[1:]):
        assert ((ROOT / page).parent / link.split("#")[0]).exists(), link


VERDICTS = ("yes", "**no")


def rows_of_sources() -> list[list[str]]:
    """The cells of the tables that compare."""
    return [
        [cell.strip() for cell in line.strip("|").split("|")]
        for line in (ROOT / "docs" / "sources.md").read_text().splitlines()
        if line.startswith("|") and not line.startswith(("| |", "| ---"))
    ]


def test_every_difference_from_a_source_is_explained() -> None:
    compared = [row for row in rows_of_sources() if len(row) == 5]
    verdicts = [row for row in rows_of_sources() if len(row) == 3 and row[2].startswith(VERDICTS)]
    assert len(compared) > 40
    assert len(verdicts) > 20
    assert [row for row in compared if row[3] != "0" and not row[4]] == []
    assert [row for row in verdicts if row[2] != "yes"] == []


def test_a_difference_from_a_source_is_that_of_the_numbers_beside_it() -> None:
    for name, *cells, _ in (row for row in rows_of_sources() if len(row) == 5):
        theirs, ours, difference = (
            float(re.sub(r"[^0-9.+-].*", "", cell.replace("−", "-"))) for cell in cells
        )
        assert difference == pytest.approx(ours - theirs, abs=1e-10), name


def test_the_notes_below_the_measurements_are_todays() -> None:
    check = (
        "from benchmarks.__main__ import PAGE, page, read; text = PAGE.read_text(); "
        "raise SystemExit(text != page(dict(read(text))))"
    )
    done = subprocess.run([sys.executable, "-c", check], cwd=ROOT)
    assert done.returncode == 0, "run: python -m benchmarks --notes"
