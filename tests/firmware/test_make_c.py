"""`make -C firmware`: the same bytes everywhere, and nothing that the board cannot compute."""

from __future__ import annotations

import shutil
import subprocess
from pathlib import Path

import pytest

from deltaviz.link.emulator import firmware
from deltaviz.link.transport import LinkError

SOURCES = Path(__file__).parents[2] / "firmware"


@pytest.fixture
def copy(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The sources as they are installed, and a cache of one's own."""
    folder = tmp_path / "_firmware"
    shutil.copytree(SOURCES, folder, ignore=shutil.ignore_patterns("build", "fuzz"))
    monkeypatch.setattr(firmware, "sources", lambda: folder)
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    return folder


def test_the_same_sources_give_the_same_bytes_wherever_they_are(copy: Path) -> None:
    elsewhere = firmware.built("disc1.elf")
    assert elsewhere.is_relative_to(copy.parent / "cache")
    subprocess.run(["make", "-s", "-C", SOURCES, "disc1"], check=True)
    assert elsewhere.read_bytes() == (SOURCES / "build" / "disc1.elf").read_bytes()


def test_a_changed_source_changes_the_name_of_the_build(copy: Path) -> None:
    build = copy.parent / "build"
    names: list[str] = []
    for text in ("", "\n/* changed */\n"):
        with (copy / "core" / "lease.c").open("a") as source:
            source.write(text)
        target = build / "build_name.h"
        subprocess.run(["make", "-s", "-C", copy, f"BUILD={build}", target], check=True)
        names.append(target.read_text())
    assert names[0] != names[1]


@pytest.mark.parametrize(
    ("line", "says"),
    [
        ("    static volatile double x;\n    x = x * 2.0;\n", "soft floats"),
        ("    int unused;\n", "error: unused variable"),
    ],
)
def test_what_the_board_cannot_compute_and_what_is_careless_is_no_image(
    copy: Path, line: str, says: str
) -> None:
    main = copy / "port" / "stm32f407" / "main.c"
    main.write_text(main.read_text().replace("int main(void)\n{\n", f"int main(void)\n{{\n{line}"))
    with pytest.raises(LinkError, match="could not be built") as refused:
        firmware.built("f407vet6.elf")
    assert says in str(refused.value)
