"""The firmware's images: built from the sources when they are asked for."""

from __future__ import annotations

import contextlib
import fcntl
import os
import shutil
import subprocess
from collections.abc import Generator
from pathlib import Path

from deltaviz.link.transport import LinkError

COMPILER = "arm-none-eabi-gcc"
MISSING = (
    "The emulated board runs the real firmware, which is built with make and arm-none-eabi-gcc. "
    "On Debian and Ubuntu: sudo apt install make gcc-arm-none-eabi libnewlib-arm-none-eabi"
)


def is_buildable() -> bool:
    return shutil.which(COMPILER) is not None and shutil.which("make") is not None


def sources() -> Path:
    """The folder of the firmware: in the installed package, or beside it in a checkout."""
    package = Path(__file__).parents[2]
    for folder in (package / "_firmware", package.parent / "firmware"):
        if (folder / "Makefile").is_file():
            return folder
    raise LinkError("The firmware's sources are not installed; install deltaviz again.")


def built(image: str = "emulator.elf") -> Path:
    """An image, today's: what is older than its sources is built anew, in some seconds.

    Raises LinkError.
    """
    if not is_buildable():
        raise LinkError(MISSING)
    folder = sources()
    build = _build_folder(folder)
    build.mkdir(parents=True, exist_ok=True)
    jobs = f"--jobs={os.cpu_count()}"
    make = ["make", "--silent", jobs, "-C", str(folder), f"BUILD={build}", str(build / image)]
    with _turn(build):
        done = subprocess.run(make, stdin=subprocess.DEVNULL, capture_output=True, text=True)
    if done.returncode:
        lines = done.stderr.strip().splitlines() or ["make failed"]
        reason = next((line for line in lines if "error" in line.lower()), lines[-1])
        raise LinkError(f"The board's firmware could not be built: {reason}")
    return build / image


def _build_folder(folder: Path) -> Path:
    """In a checkout beside the sources; an installed package is not ours to write into."""
    if folder.name == "firmware":
        return folder / "build"
    cache = os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache"
    return Path(cache) / "deltaviz" / "firmware"


@contextlib.contextmanager
def _turn(build: Path) -> Generator[None]:
    """One after another: two builds at once would write the same files."""
    with (build / "lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        yield
