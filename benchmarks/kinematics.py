"""Inverse and forward kinematics of 10^6 poses, against scalar C at -O3 (tutorial.c).

    python benchmarks/kinematics.py [--poses N] [--rounds N]

Prints ns per pose of copying the data, of the C code, of the compiled loop over separate x, y, z
arrays, and of the public (n, 3) call, on one thread and on two; each measured in turn in every
round, the least of all rounds: other load only adds. Also the time of one pose alone, as the
control loop has it.
"""

from __future__ import annotations

import argparse
import ctypes
import statistics
import subprocess
import tempfile
import time
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from deltaviz import load_robot
from deltaviz.mechanism import RotaryDelta

SIDES = np.array([457.3, 115.0, 112.0, 232.0])  # f, e, upper arm, forearm of the preset trossen
Run = Callable[[], object]


class Tutorial:
    """The C code, compiled here."""

    def __init__(self, folder: Path, *tuning: str) -> None:
        library = folder / f"tutorial{len(tuning)}.so"
        source = Path(__file__).with_name("tutorial.c")
        flags = ["-O3", *tuning, "-std=c11", "-shared", "-fPIC"]
        subprocess.run(["gcc", *flags, "-o", library, source, "-lm"], check=True)
        self._library = ctypes.CDLL(str(library))

    def inverse(self, xyz: np.ndarray) -> np.ndarray:
        return self._run(self._library.inverse_many, xyz)

    def forward(self, theta_deg: np.ndarray) -> np.ndarray:
        return self._run(self._library.forward_many, theta_deg)

    def _run(self, function: Callable[..., int], values: np.ndarray) -> np.ndarray:
        out = np.empty_like(values)
        pointers = [array.ctypes.data_as(ctypes.c_void_p) for array in (SIDES, values, out)]
        if function(*pointers, ctypes.c_size_t(len(values))):
            raise ValueError("the C code calls a legal pose unreachable")
        return out


def main() -> None:
    options = argparse.ArgumentParser(description=__doc__)
    options.add_argument("--poses", type=int, default=1_000_000)
    options.add_argument("--rounds", type=int, default=40)
    chosen = options.parse_args()
    robot = load_robot("trossen")
    mechanism, kernel = robot.mechanism, robot.kernel
    assert isinstance(mechanism, RotaryDelta)
    kernel.warm_up()
    theta = _legal_angles(chosen.poses)
    xyz = kernel.forward(theta)
    theta_deg = np.degrees(theta)
    batch = mechanism.batch
    with tempfile.TemporaryDirectory() as folder:
        plain, native = Tutorial(Path(folder)), Tutorial(Path(folder), "-march=native")
        for name, into, back, rows, in_c in (
            ("inverse", xyz, theta, batch.inverse_rows, xyz),
            ("forward", theta, xyz, batch.forward_rows, theta_deg),
        ):
            public, apart = getattr(mechanism, name), getattr(batch, name)
            runs = _ways(public, apart, rows, into)
            for way, tutorial in (("C", plain), ("C, -march=native", native)):
                runs[way] = partial(getattr(tutorial, name), in_c)
            _compare(name, runs, chosen.poses, chosen.rounds)
            print(f"  public: at most {np.abs(public(into) - back).max():.1e} from the other way's")
    _one_pose(mechanism, kernel, xyz[:1], theta[:1])


def _ways(
    public: Callable[..., Any],
    apart: Callable[..., Any],
    rows: Callable[..., Any],
    into: np.ndarray,
) -> dict[str, Run]:
    """Each way to solve the same poses; the arrays written to exist already, but for the rows'."""
    separate = tuple(np.ascontiguousarray(into[:, i]) for i in range(3))
    out = tuple(np.zeros_like(column) for column in separate)
    return {
        "copy": lambda: [np.copyto(o, s) for o, s in zip(out, separate, strict=True)],
        "arrays": lambda: apart(*separate, out=out),
        "arrays, two threads": lambda: apart(*separate, out=out, threads=2),
        "public rows": lambda: public(into),
        "rows, two threads": lambda: rows(into, threads=2),
    }


def _legal_angles(count: int) -> np.ndarray:
    """Angles whose elbows all stand outside, so that all three ways solve the same."""
    robot = load_robot("trossen")
    rng = np.random.default_rng(1)
    found: list[np.ndarray] = []
    while sum(map(len, found)) < count:
        theta = rng.uniform(-0.6, 1.4, (count, 3))
        back = robot.kernel.inverse(robot.kernel.forward(theta))
        found.append(theta[np.abs(back - theta).max(axis=-1) < 1e-9])
    return np.ascontiguousarray(np.concatenate(found)[:count])


def _compare(name: str, runs: dict[str, Run], poses: int, rounds: int) -> None:
    taken: dict[str, list[float]] = {way: [] for way in runs}
    for _ in range(rounds):
        for way, run in runs.items():
            start = time.perf_counter()
            run()
            taken[way].append((time.perf_counter() - start) / poses * 1e9)
    least = {way: min(times) for way, times in taken.items()}
    print(f"{name}, {poses} poses, least of {rounds} rounds")
    for way, time_taken in least.items():
        print(
            f"  {way:20} {time_taken:7.1f} ns/pose {time_taken / least['copy']:6.1f} times a copy"
            f" {least['C'] / time_taken:6.1f} times as fast as C"
        )


def _one_pose(mechanism: object, kernel: object, xyz: np.ndarray, theta: np.ndarray) -> None:
    print("one pose in a call, medians of 2000")
    calls: dict[str, Run] = {
        "public inverse": lambda: mechanism.inverse(xyz),  # type: ignore[attr-defined]
        "kernel inverse": lambda: kernel.inverse(xyz),  # type: ignore[attr-defined]
        "kernel forward": lambda: kernel.forward(theta),  # type: ignore[attr-defined]
        "kernel margins": lambda: kernel.margins(xyz, theta),  # type: ignore[attr-defined]
    }
    for name, call in calls.items():
        times: list[float] = []
        for _ in range(2000):
            start = time.perf_counter()
            call()
            times.append(time.perf_counter() - start)
        print(f"  {name:15} {statistics.median(times) * 1e6:6.2f} us")


if __name__ == "__main__":
    main()
