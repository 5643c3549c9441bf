"""Inverse and forward kinematics of 10^6 poses, against scalar C at -O3 (tutorial.c).

    python benchmarks/kinematics.py [--poses N] [--rounds N]

Prints ns per pose of the public (n, 3) call, of the compiled kernel, and of the C code, each
measured in turn in every round, so that other load hits all alike; medians over the rounds, and
the ratios to C of the same round. Also the time of one pose alone, as the control loop has it.
"""

from __future__ import annotations

import argparse
import ctypes
import statistics
import subprocess
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np

from deltaviz import load_robot

SIDES = np.array([457.3, 115.0, 112.0, 232.0])  # f, e, upper arm, forearm of the preset trossen
Run = Callable[[], np.ndarray]


class Tutorial:
    """The C code, compiled here."""

    def __init__(self, folder: Path) -> None:
        library = folder / "tutorial.so"
        source = Path(__file__).with_name("tutorial.c")
        flags = ["-O3", "-march=native", "-std=c11", "-shared", "-fPIC"]
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
    options.add_argument("--rounds", type=int, default=7)
    chosen = options.parse_args()
    robot = load_robot("trossen")
    kernel = robot.kernel
    kernel.warm_up()
    theta = _legal_angles(chosen.poses)
    xyz = kernel.forward(theta)
    theta_deg = np.degrees(theta)
    with tempfile.TemporaryDirectory() as folder:
        tutorial = Tutorial(Path(folder))
        ways: dict[str, dict[str, Run]] = {
            "inverse": {
                "public": lambda: robot.mechanism.inverse(xyz),
                "kernel": lambda: kernel.inverse(xyz),
                "C": lambda: tutorial.inverse(xyz),
            },
            "forward": {
                "public": lambda: robot.mechanism.forward(theta),
                "kernel": lambda: kernel.forward(theta),
                "C": lambda: tutorial.forward(theta_deg),
            },
        }
        for name, runs in ways.items():
            _compare(name, runs, chosen.poses, chosen.rounds)
            apart = np.abs(runs["public"]() - runs["kernel"]()).max()
            print(f"  public and kernel differ by at most {apart:.1e}")
    _one_pose(robot.mechanism, kernel, xyz[:1], theta[:1])


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
    print(f"{name}, {poses} poses, medians of {rounds} rounds")
    for way, times in taken.items():
        ratio = statistics.median(t / c for t, c in zip(times, taken["C"], strict=True))
        print(f"  {way:8} {statistics.median(times):7.1f} ns/pose   {ratio:5.2f} of C")


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
