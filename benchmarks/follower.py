"""The follower's tick: p50, p99 and worst in ms, for each preset and kind of target.

    python benchmarks/follower.py [--ticks 2000] [--robot stm32 ...]

"wall" is what the control loop feels, other processes included; "cpu" is the tick's own work.
"kept" counts the ticks in which a new plan was wanted and the committed one went on.
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Callable

import numpy as np

from deltaviz.motion.follower import Follower
from deltaviz.motion.goal import AtJointVelocity, AtVelocity, Goal, ToAngles, ToPoint
from deltaviz.robots import Robot, load_robot, preset_names

Maker = Callable[[Robot, np.random.Generator], Goal]


def _width(robot: Robot) -> float:
    space = robot.zone
    return space.radius or max(abs(v) for v in (*(space.x or (100,)), *(space.y or (100,))))


def _inside(robot: Robot, rng: np.random.Generator) -> Goal:
    return _place(robot, rng, 0.6 * _width(robot), 0.0)


def _beyond(robot: Robot, rng: np.random.Generator) -> Goal:
    return _place(robot, rng, 1.5 * _width(robot), 80.0)


def _place(robot: Robot, rng: np.random.Generator, half: float, beyond: float) -> Goal:
    across, (low, high) = len(robot.axes) - 1, robot.zone.z
    least, most = [-half] * across + [low - beyond], [half] * across + [high + beyond]
    return ToPoint(tuple(rng.uniform(least, most).tolist()))


def _angles(robot: Robot, rng: np.random.Generator) -> Goal:
    return ToAngles(tuple(rng.uniform(robot.joints.min, robot.joints.max).tolist()))


def _jog(robot: Robot, rng: np.random.Generator) -> Goal:
    return AtVelocity(
        tuple((rng.normal(size=len(robot.axes)) * 0.5 * robot.limits.cartesian.velocity).tolist())
    )


def _turn(robot: Robot, rng: np.random.Generator) -> Goal:
    limit = np.asarray(robot.limits.joint.velocity)
    return AtJointVelocity(tuple((rng.normal(size=robot.joint_count) * 0.5 * limit).tolist()))


# What is followed, and for how many ticks each target stays.
MODES: dict[str, tuple[Maker, int, int]] = {
    "moves": (_inside, 60, 120),
    "drag": (_inside, 2, 3),  # a pointer at 30-60 Hz that jumps about
    "beyond reach": (_beyond, 10, 80),
    "angles": (_angles, 20, 80),
    "jog": (_jog, 20, 80),
    "joint jog": (_turn, 20, 80),
}


def measure(robot: Robot, make: Maker, hold: tuple[int, int], ticks: int) -> tuple[float, ...]:
    """p50, p99, worst of wall time and p50, p99 of cpu time, in ms."""
    rng = np.random.default_rng(1)
    follower = Follower(robot, robot.homing.ready)
    wall, cpu = np.empty(ticks), np.empty(ticks)
    goal, left = make(robot, rng), 0
    for tick in range(ticks):
        if left == 0:
            goal, left = make(robot, rng), int(rng.integers(*hold))
        left -= 1
        wall_before, cpu_before = time.perf_counter(), time.thread_time()
        follower.step(goal)
        wall[tick] = time.perf_counter() - wall_before
        cpu[tick] = time.thread_time() - cpu_before
    p50, p99 = np.percentile(wall, (50, 99))
    return tuple(1e3 * v for v in (p50, p99, wall.max(), *np.percentile(cpu, (50, 99)), cpu.max()))


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else None)
    parser.add_argument("--ticks", type=int, default=2000)
    parser.add_argument("--robot", action="append", help="preset or file; may be repeated")
    options = parser.parse_args()
    print(f"{'robot':<10} {'target':<13} {'wall p50':>9} {'p99':>7} {'worst':>7}"
          f" {'cpu p50':>9} {'p99':>7} {'worst':>7}   ms")  # fmt: skip
    for name in options.robot or preset_names():
        robot = load_robot(name)
        for mode, (make, least, most) in MODES.items():
            values = measure(robot, make, (least, most), options.ticks)
            columns = "{:9.3f} {:7.2f} {:7.2f} {:9.3f} {:7.2f} {:7.2f}".format(*values)
            print(f"{robot.name:<10} {mode:<13} {columns}")


if __name__ == "__main__":
    main()
