"""Runs every benchmark, or those named, in turn; what they print goes to docs/measurements.md.

Short runs; each benchmark can be called by itself for longer ones.
"""

from __future__ import annotations

import os
import platform
import subprocess
import sys
from collections.abc import Iterator
from datetime import date
from pathlib import Path

PAGE = Path(__file__).parents[1] / "docs" / "measurements.md"
BENCHMARKS = {
    "startup": ("Start-up", ["startup", "--rounds", "2"]),
    "kinematics": (
        "Inverse and forward for a million poses, against scalar C",
        ["kinematics", "--rounds", "40"],
    ),
    "workspace": ("The workspace: field, boundary, what fits", ["workspace"]),
    "geometry": (
        "Live editing: boundaries drawn anew while a length is dragged",
        ["geometry", "--seconds", "10"],
    ),
    "follower": ("One tick of the follower", ["follower", "--ticks", "200"]),
    "loop": ("The control loop, alone and on busy cores", ["loop", "--seconds", "5"]),
    "watched_loop": ("The control loop while browsers watch", ["watched_loop", "--seconds", "5"]),
    "dragged": ("The link while browsers watch and one drags", ["dragged", "--seconds", "10"]),
    "link": ("The link: round trip, and the cost of a capture", ["link", "--seconds", "5"]),
    "latency": ("Pointer to step, simulated board", ["latency", "--moves", "10"]),
    "latency_emulated": (
        "Pointer to step, the real firmware in the emulator",
        ["latency", "--moves", "10", "--link", "emulate://"],
    ),
}
# What a reader may ask of a section's numbers: it stands below them, also when measured anew.
NOTES = {
    "kinematics": """\
Forward on one thread is short of ten times the C code, by little. What bounds it is mostly memory
traffic: it takes 1.4 times as long as copying the poses and doing nothing, and that copy alone is
no more than some 13 times as fast as the C code. On two threads forward takes as long as the copy
and passes ten times.""",
    "workspace": """\
The loop in Python runs on the nodes that its row tells of, and keeps none. Numpy's memory holds its
points too, which a field makes from its axes as it goes. Two threads take half the time of one.
Where they do not, but the processor's time is the same for one and for two, another program had a
core.

A field costs in proportion to its nodes, so with the cube of 1/spacing: half the spacing, eight
times the time. Marching through it and the faces of its boundary grow with the square. The
tolerance of a boundary is another thing than the spacing: down to 0.5 mm refinement meets it on
the same grid and for next to nothing; below, the grid becomes finer with the tolerance, and the
cost grows about with the square.""",
}
HEAD = """# Measurements

Made by `python -m benchmarks`, or `python -m benchmarks NAME` for one of them. Browsers draw in
software there and share the cores with everything else."""


def processor() -> str:
    try:
        lines = Path("/proc/cpuinfo").read_text().splitlines()
    except OSError:
        return platform.processor()
    return next((s.split(":", 1)[1].strip() for s in lines if s.startswith("model name")), "?")


def main() -> int:
    """Measure what is named, or all; sections that are not measured stay as they are. `--notes`:
    measure nothing, write the notes below them."""
    if sys.argv[1:] == ["--notes"]:
        PAGE.write_text(page(dict(read(PAGE.read_text()))))
        return 0
    sections = dict(read(PAGE.read_text())) if PAGE.exists() else {}
    failed = False
    for name in sys.argv[1:] or BENCHMARKS:
        title, (module, *arguments) = BENCHMARKS[name]
        command = [sys.executable, "-m", f"benchmarks.{module}", *arguments]
        done = subprocess.run(command, stdout=subprocess.PIPE, text=True, cwd=PAGE.parents[1])
        if done.returncode:
            print(f"benchmarks.{name} failed", file=sys.stderr)
            failed = True
            continue
        print(done.stdout)
        sections[title] = f"{circumstances()}\n\n```text\n{done.stdout.strip(chr(10))}\n```"
        PAGE.write_text(page(sections))
    return 1 if failed else 0


def circumstances() -> str:
    return (
        f"{date.today()}, {os.cpu_count()} cores ({processor()}), "
        f"Python {platform.python_version()}, no graphics card."
    )


def read(text: str) -> Iterator[tuple[str, str]]:
    """Titles and texts of a page's sections, without their notes."""
    for section in text.split("\n## ")[1:]:
        title, _, body = section.partition("\n")
        measured, fence, _ = body.rpartition("```")
        yield title, (measured + fence).strip("\n")


def page(sections: dict[str, str]) -> str:
    """In the order of the benchmarks, whichever were measured last."""
    parts = [HEAD]
    for name, (title, _) in BENCHMARKS.items():
        if title in sections:
            parts += [f"## {title}", sections[title]]
            parts += [NOTES[name]] if name in NOTES else []
    return "\n\n".join(parts) + "\n"


if __name__ == "__main__":
    sys.exit(main())
