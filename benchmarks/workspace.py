"""The workspace: the field of margins, the boundary, and what fits.

    python -m benchmarks.workspace [--nodes N]

Points per second of the field on one thread and on two, with collisions and without; against plain
numpy and against the scalar loop that the articles use, where all ask only whether the arms reach;
the peak of memory that each adds; the boundary's levels for a changed geometry, and to 1 mm; and
how the cost grows with the tolerance.
"""

from __future__ import annotations

import argparse
import math
import time
import tracemalloc
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np

from deltaviz import load_robot
from deltaviz.mechanism import RotaryDelta
from deltaviz.robots import Robot
from deltaviz.robots.workspace import Limit, Margins, levels
from deltaviz.robots.workspace.cells import hull
from deltaviz.robots.workspace.field import Grid, sample

SCALAR_NODES = 100_000
ROUNDS = 3


def measured(run: Callable[[], Any]) -> tuple[float, float]:
    """(s, the least of some rounds; MB at its peak)."""
    tracemalloc.start()
    run()
    _, peak = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    least = math.inf
    for _ in range(ROUNDS):
        start = time.perf_counter()
        run()
        least = min(least, time.perf_counter() - start)
    return least, peak / 1e6


def by_numpy(mechanism: RotaryDelta, points: np.ndarray) -> np.ndarray:
    legal = np.ones(len(points), dtype=bool)
    for i, azimuth in enumerate(np.radians(mechanism.azimuths_deg)):
        s = mechanism.base_radius[i] - mechanism.effector_radius[i]
        upper, fore = mechanism.upper_arm[i], mechanism.forearm[i]
        x, y, z = points.T
        p = x * np.cos(azimuth) + y * np.sin(azimuth) - s
        v = y * np.cos(azimuth) - x * np.sin(azimuth)
        k = (p**2 + v**2 + z**2 + upper**2 - fore**2) / (2 * upper)
        legal &= k**2 <= p**2 + z**2
    return legal


def by_a_loop(mechanism: RotaryDelta, points: list[list[float]]) -> int:
    count = 0
    for x, y, z in points:
        for i, azimuth in enumerate(mechanism.azimuths_deg):
            angle = math.radians(azimuth)
            upper, fore = mechanism.upper_arm[i], mechanism.forearm[i]
            p = x * math.cos(angle) + y * math.sin(angle)
            p -= mechanism.base_radius[i] - mechanism.effector_radius[i]
            v = y * math.cos(angle) - x * math.sin(angle)
            k = (p**2 + v**2 + z**2 + upper**2 - fore**2) / (2 * upper)
            if k**2 > p**2 + z**2:
                break
        else:
            count += 1
    return count


def field(robot: Robot, nodes: int) -> None:
    mechanism = robot.mechanism
    assert isinstance(mechanism, RotaryDelta)
    box = hull(Margins.of(robot))
    assert box is not None
    grid = Grid.around(box, float(np.prod(box.size) / nodes) ** (1 / 3))
    count = math.prod(grid.shape)
    points = np.stack(np.meshgrid(*grid.axes, indexing="ij"), axis=-1).reshape(-1, 3)
    print(f"field of {robot.name}, {count} nodes       s   ns/node   million/s   MB")

    def told(name: str, seconds: float, megabytes: float, of: int = count) -> None:
        print(f"  {name:32}{seconds:7.2f}{1e9 * seconds / of:9.0f}{of / seconds / 1e6:11.1f}"
              f"{megabytes:8.0f}")  # fmt: skip

    reach, machine = Margins.of(robot, Limit.REACH), Margins.of(robot)
    free = replace(machine, collisions=None)
    for name, margins in (("reach", reach), ("all but collisions", free), ("all", machine)):
        for threads in (1, 2):
            told(f"{name}, {threads} thread{'s' * (threads > 1)}",
                 *measured(lambda: sample(margins, grid, threads=threads)))  # noqa: B023 # fmt: skip
    told("numpy, reach", *measured(lambda: by_numpy(mechanism, points)))
    some = points[:: max(1, count // SCALAR_NODES)].tolist()
    told("a loop in Python, reach", *measured(lambda: by_a_loop(mechanism, some)), of=len(some))


def boundaries(robot: Robot) -> None:
    print(f"boundary of {robot.name}, 1 thread      s   faces   deviation mm")
    start = time.perf_counter()
    names = ("coarse", "coarse, refined", "within 1 mm", "again, finer grid")
    for name, level in zip(names, levels(robot), strict=False):
        seconds = time.perf_counter() - start
        print(f"  {name:22}{seconds:10.2f}{len(level.faces):8}{level.deviation:12.2f}")
    for tolerance in (4.0, 2.0, 1.0, 0.5, 0.25):
        start = time.perf_counter()
        *_, last = levels(robot, tolerance=tolerance)
        seconds = time.perf_counter() - start
        print(f"  to {tolerance:4g} mm            {seconds:10.2f}{len(last.faces):8}"
              f"{last.deviation:12.2f}")  # fmt: skip


def changed(robot: Robot) -> None:
    """A hand on a slider: another forearm each time, first levels only."""
    mechanism = robot.mechanism
    assert isinstance(mechanism, RotaryDelta)
    spent: list[float] = []
    for step in range(20):
        longer = replace(mechanism, forearm=tuple(l + step for l in mechanism.forearm))  # noqa: E741
        start = time.perf_counter()
        next(levels(replace(robot, mechanism=longer)))
        spent.append(1000 * (time.perf_counter() - start))
    print(f"first boundary of a changed {robot.name}: median {np.median(spent):.0f} ms, "
          f"worst {max(spent):.0f} ms")  # fmt: skip


def fits(robot: Robot) -> None:
    workspace = robot.workspace()
    _ = workspace.box
    for name, run in (
        ("extents", lambda: workspace.extents),
        ("largest cylinder", workspace.largest_cylinder),
        ("largest cylinder 100 mm high", lambda: workspace.largest_cylinder(height=100)),
    ):
        start = time.perf_counter()
        run()
        print(f"{robot.name}, {name}: {time.perf_counter() - start:.2f} s")


def main() -> None:
    options = argparse.ArgumentParser(description=__doc__)
    options.add_argument("--nodes", type=int, default=10_000_000)
    chosen = options.parse_args()
    robot = load_robot("stm32")
    list(levels(robot, tolerance=20))  # compiled code is loaded
    field(robot, chosen.nodes)
    boundaries(robot)
    for name in ("stm32", "trossen", "zheng2023"):
        changed(load_robot(name))
    for name in ("stm32", "zheng2023"):
        fits(load_robot(name))


if __name__ == "__main__":
    main()
