"""The workspace: the field of margins, the boundary, and what fits.

    python -m benchmarks.workspace [--nodes N]

Points per second of the field on one thread and on two, with collisions and without; against plain
numpy and against the scalar loop that the articles use, where all ask only whether the arms reach;
the processor's time beside the clock's, and the peak of memory that each adds, its points
included; how the cost of the field and of the marched boundary grows with the spacing of the nodes,
and that of the refined boundary with the tolerance; the boundary's levels for a changed geometry.
"""

from __future__ import annotations

import argparse
import math
import time
import tracemalloc
from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np

from deltaviz import load_robot
from deltaviz.mechanism import RotaryDelta
from deltaviz.robots import Robot
from deltaviz.robots.workspace import Limit, Margins, levels
from deltaviz.robots.workspace.boundary import march
from deltaviz.robots.workspace.cells import hull
from deltaviz.robots.workspace.field import Grid, sample

SCALAR_NODES = 100_000
ROUNDS = 3
SPACINGS = (16.0, 8.0, 4.0, 2.0)  # mm between the nodes of a field
TOLERANCES = (4.0, 2.0, 1.0, 0.5, 0.25, 0.125)  # mm


class Cost(NamedTuple):
    """s by the clock and of the processor's time, in the quickest of some rounds; MB at the peak.
    Where two threads take as long as one but no more of the processor, another program had it."""

    wall: float
    processor: float
    megabytes: float


def measured(run: Callable[[], Any]) -> Cost:
    tracemalloc.start()
    run()
    _, peak = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    return Cost(*min(_timed(run) for _ in range(ROUNDS)), peak / 1e6)


def _timed(run: Callable[[], Any]) -> tuple[float, float]:
    start, processor = time.perf_counter(), time.process_time()
    run()
    return time.perf_counter() - start, time.process_time() - processor


def power(fineness: Sequence[float], costs: Sequence[float]) -> float:
    """The exponent with which the costs grow as spacing or tolerance shrinks."""
    return -float(np.polyfit(np.log(fineness), np.log(costs), 1)[0])


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
    print(f"field of {robot.name}, {count} nodes       s   processor s   ns/node   million/s   MB")

    def told(name: str, cost: Cost, *, of: int = count, memory: bool = True) -> None:
        print(f"  {name:32}{cost.wall:7.2f}{cost.processor:14.2f}{1e9 * cost.wall / of:10.0f}"
              f"{of / cost.wall / 1e6:12.1f}"
              + (f"{cost.megabytes:5.0f}" if memory else "    -"))  # fmt: skip

    reach, machine = Margins.of(robot, Limit.REACH), Margins.of(robot)
    free = replace(machine, collisions=None)
    for name, margins in (("reach", reach), ("all but collisions", free), ("all", machine)):
        for threads in (1, 2):
            told(f"{name}, {threads} thread{'s' * (threads > 1)}",
                 measured(lambda: sample(margins, grid, threads=threads)))  # noqa: B023 # fmt: skip
    told("numpy, reach, and its points", measured(lambda: by_numpy(mechanism, nodes_of(grid))))
    some = nodes_of(grid)[:: max(1, count // SCALAR_NODES)].tolist()
    told(f"a Python loop, reach, {len(some)} nodes", measured(lambda: by_a_loop(mechanism, some)),
         of=len(some), memory=False)  # fmt: skip


def nodes_of(grid: Grid) -> np.ndarray:
    return np.stack(np.meshgrid(*grid.axes, indexing="ij"), axis=-1).reshape(-1, 3)


def growth(robot: Robot) -> None:
    """How cost grows as the nodes of a field come closer; the boundary marched through it, too."""
    margins = Margins.of(robot)
    box = hull(margins)
    assert box is not None
    print(f"spacing, {robot.name}, 1 thread      nodes   field s   march s    faces")
    rows: list[tuple[int, float, float, int]] = []
    for spacing in SPACINGS:
        grid = Grid.around(box, spacing)
        sampled = sample(margins, grid)
        field_s, _ = min(_timed(lambda: sample(margins, grid)) for _ in range(ROUNDS))  # noqa: B023
        march_s, _ = min(_timed(lambda: march(margins, sampled)) for _ in range(ROUNDS))  # noqa: B023
        rows.append((math.prod(grid.shape), field_s, march_s, len(march(margins, sampled).faces)))
        print(f"  {spacing:4g} mm               {rows[-1][0]:13}{field_s:10.3f}{march_s:10.3f}"
              f"{rows[-1][3]:9}")  # fmt: skip
    nodes, sampled_by, marched_by, faces = (power(SPACINGS, c) for c in zip(*rows, strict=True))
    print(f"  grow with 1/spacing to the power{nodes:6.2f}{sampled_by:10.2f}{marched_by:10.2f}"
          f"{faces:9.2f}")  # fmt: skip


def boundaries(robot: Robot) -> None:
    print(f"boundary of {robot.name}, 1 thread      s   faces   deviation mm   cell mm")
    start = time.perf_counter()
    names = ("coarse", "coarse, refined", "within 1 mm", "again, finer grid")
    for name, level in zip(names, levels(robot), strict=False):
        seconds = time.perf_counter() - start
        print(f"  {name:22}{seconds:10.2f}{len(level.faces):8}{level.deviation:15.2f}"
              f"{level.cell:10.2f}")  # fmt: skip
    spent: list[float] = []
    for tolerance in TOLERANCES:
        start = time.perf_counter()
        *_, last = levels(robot, tolerance=tolerance)
        spent.append(time.perf_counter() - start)
        print(f"  to {tolerance:5g} mm           {spent[-1]:10.2f}{len(last.faces):8}"
              f"{last.deviation:15.2f}{last.cell:10.2f}")  # fmt: skip
    half = len(TOLERANCES) // 2
    above, below = power(TOLERANCES[:half], spent[:half]), power(TOLERANCES[half:], spent[half:])
    print(f"  time grows with 1/tolerance to the power {above:.2f} to {TOLERANCES[half - 1]:g} mm, "
          f"{below:.2f} from {TOLERANCES[half]:g} mm on")  # fmt: skip


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
    growth(robot)
    boundaries(robot)
    for name in ("stm32", "trossen", "zheng2023"):
        changed(load_robot(name))
    for name in ("stm32", "zheng2023"):
        fits(load_robot(name))


if __name__ == "__main__":
    main()
