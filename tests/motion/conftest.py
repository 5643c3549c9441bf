"""A judge of executed motion, and what drives a follower for it.

The judge shares no code with what it judges: it reads the preset's file itself, has kinematics
of its own (the constraint equations, solved by numpy) and samples the cubics between the knots.
"""

from __future__ import annotations

import tomllib
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

import deltaviz.robots
from deltaviz.motion.follower import Follower
from deltaviz.motion.goal import (
    AtJointVelocity,
    AtVelocity,
    Goal,
    Rest,
    ToAngles,
    ToPoint,
)
from deltaviz.motion.knot import Knot
from deltaviz.robots import Robot, load_robot

Array = NDArray[np.float64]
PRESETS = Path(deltaviz.robots.__file__).parent / "presets"
FILES = {"stm32-tool": Path(__file__).parents[2] / "docs" / "examples" / "stm32-tool.toml"}
PERIOD = 0.010
SAMPLES = 11  # of each segment: 1 kHz
BRAKE_SAMPLES = 24
LENGTH = 0.01  # mm; what a limit of place may be passed by
ROUNDING = 1e-9  # of a limit of velocity or acceleration


class Arms:
    """A robot's file and what its kinds have in common; kinematics from the constraints.

    Arrays are (..., n) over the arms' angles; vectors have the robot's own axes.
    """

    axes: str
    out: Array  # unit vectors, one per arm
    down: Array

    def __init__(self, file: dict[str, Any]) -> None:
        self.file = file
        shape = file["geometry"]
        self.upper, self.fore = float(shape["upper_arm"]), float(shape["forearm"])
        self.inset = 0.0
        self.arms = len(self.out)

    def tip(self, theta: Array) -> Array:
        """Where the forearms meet, below the elbows."""
        raise NotImplementedError

    def elbows(self, theta: Array) -> Array:
        """Elbows moved inwards by the effector's radius, (..., n, d)."""
        cos, sin = np.cos(theta)[..., None], np.sin(theta)[..., None]
        return self.out * self.inset + self.upper * (cos * self.out + sin * self.down)

    def turning(self, theta: Array) -> tuple[Array, Array]:
        """First and second derivative of the elbows by their angles."""
        cos, sin = np.cos(theta)[..., None], np.sin(theta)[..., None]
        return (
            self.upper * (cos * self.down - sin * self.out),
            -self.upper * (cos * self.out + sin * self.down),
        )

    def motion(self, theta: Array, rate: Array, turn: Array) -> tuple[Array, Array, Array]:
        """Tip, its velocity and acceleration: S·(v - D'w) = 0 and its derivative, solved."""
        tip = self.tip(theta)
        rods = tip[..., None, :] - self.elbows(theta)
        first, second = self.turning(theta)
        slide = first * rate[..., None]
        velocity = np.linalg.solve(rods, (rods * slide).sum(-1)[..., None])[..., 0]
        swing = velocity[..., None, :] - slide
        push = first * turn[..., None] + second * rate[..., None] ** 2
        right = (rods * push).sum(-1) - (swing**2).sum(-1)
        return tip, velocity, np.linalg.solve(rods, right[..., None])[..., 0]

    def broken(self, theta: Array) -> dict[str, Array]:
        """By how much (mm) each limit of place is broken at poses; at most 0 if not."""
        tip = self.tip(theta)
        rods = tip[..., None, :] - self.elbows(theta)
        first, _ = self.turning(theta)
        joints, space = self.file["joints"], self.file["workspace"]
        low, high = np.radians(joints["min_deg"]), np.radians(joints["max_deg"])
        offset = dict(zip("xyz", self.file["geometry"].get("tool_offset", [0, 0, 0]), strict=True))
        place = {name: tip[..., k] + offset[name] for k, name in enumerate(self.axes)}
        result = {
            "finite": np.where(np.isfinite(tip).all(-1), -1.0, 1e9),
            "joint range": np.maximum(low - theta, theta - high).max(-1) * self.upper,
            "elbow outside": -(rods * first).sum(-1).min(-1) / self.fore,
            "assembly": np.linalg.det(rods) / self.fore ** (self.arms - 1),
        }
        for name in self.axes:
            if name in space:
                low, high = space[name]
                result[name] = np.maximum(low - place[name], place[name] - high)
        if "radius" in space:
            result["radius"] = np.hypot(place["x"], place["y"]) - space["radius"]
        return result


class Delta(Arms):
    axes = "xyz"
    down = np.array([0.0, 0.0, -1.0])

    def __init__(self, file: dict[str, Any]) -> None:
        shape = file["geometry"]
        azimuth = np.radians(shape["azimuths_deg"])
        self.out = np.stack([np.cos(azimuth), np.sin(azimuth), 0 * azimuth], axis=-1)
        self.side = np.stack([-np.sin(azimuth), np.cos(azimuth), 0 * azimuth], axis=-1)
        super().__init__(file)
        base = shape.get("base_radius", shape.get("base_side", 0.0) / (2 * 3**0.5))
        tool = shape.get("effector_radius", shape.get("effector_side", 0.0) / (2 * 3**0.5))
        self.inset = base - tool

    def tip(self, theta: Array) -> Array:
        """Where three spheres of the forearm's length about the elbows meet, below them."""
        one, two, three = np.moveaxis(self.elbows(theta), -2, 0)
        ex = two - one
        far = np.linalg.norm(ex, axis=-1, keepdims=True)
        ex = ex / far
        along = (ex * (three - one)).sum(-1, keepdims=True)
        ey = three - one - along * ex
        across = np.linalg.norm(ey, axis=-1, keepdims=True)
        ey = ey / across
        ez = np.cross(ex, ey)
        x = far / 2
        y = (along**2 + across**2 - 2 * along * x) / (2 * across)
        height = np.sqrt(self.fore**2 - x**2 - y**2)
        sign = np.where(ez[..., 2:] > 0, -1.0, 1.0)
        return one + x * ex + y * ey + sign * height * ez

    def broken(self, theta: Array) -> dict[str, Array]:
        rods = self.tip(theta)[..., None, :] - self.elbows(theta)
        sideways = np.abs((rods * self.side).sum(-1))
        most = self.fore * np.sin(np.radians(self.file["joints"]["ball_joint_max_deg"]))
        return {**super().broken(theta), "ball joint": (sideways - most).max(-1)}


class FiveBar(Arms):
    axes = "xz"
    out = np.array([[-1.0, 0.0], [1.0, 0.0]])
    down = np.array([0.0, -1.0])

    def __init__(self, file: dict[str, Any]) -> None:
        super().__init__(file)
        self.inset = file["geometry"]["base_half"] - file["geometry"]["platform_half"]

    def tip(self, theta: Array) -> Array:
        """Where two circles of the forearm's length about the elbows meet, below them."""
        left, right = np.moveaxis(self.elbows(theta), -2, 0)
        half = (right - left) / 2
        far = np.linalg.norm(half, axis=-1, keepdims=True)
        across = np.stack([half[..., 1], -half[..., 0]], axis=-1) / far
        return left + half + across * np.sqrt(self.fore**2 - far**2)


class TurningTool:
    """Arms, and a joint behind theirs that turns the tool: a pose of its own, without effect."""

    def __init__(self, arms: Arms) -> None:
        self.under = arms
        self.file, self.axes, self.arms = arms.file, arms.axes, arms.arms

    def motion(self, theta: Array, rate: Array, turn: Array) -> tuple[Array, Array, Array]:
        return self.under.motion(theta[..., :-1], rate[..., :-1], turn[..., :-1])

    def broken(self, theta: Array) -> dict[str, Array]:
        tool, angle = self.file["tool_axis"], np.degrees(theta[..., -1])
        beyond = np.maximum(tool["min_deg"] - angle, angle - tool["max_deg"])
        return {**self.under.broken(theta[..., :-1]), "tool range": beyond}


def judged(name: str) -> Arms | TurningTool:
    """What a robot's file says, by kinematics of the tests' own."""
    file = tomllib.loads(FILES.get(name, PRESETS / f"{name}.toml").read_text())
    arms = {"rotary_delta": Delta, "five_bar": FiveBar}[file["kind"]](file)
    return TurningTool(arms) if "tool_axis" in file else arms


def joint_limit(file: dict[str, Any], name: str) -> Array:
    """A limit of `[limits.joint]` for each joint, the tool's last; rad."""
    arms = {"rotary_delta": 3, "five_bar": 2}[file["kind"]]
    values = [file["limits"]["joint"][name]] * arms
    if "tool_axis" in file:
        values.append(file["tool_axis"]["limits"][name])
    return np.radians(values)


@dataclass
class Ride:
    """What was executed: the knots, and which segments were commanded (not braked).

    `tip` tells that only the tip's motion was asked for: then the plan's jerk is limited too.
    """

    start: Array
    knots: list[Knot] = field(default_factory=list)
    commanded: list[bool] = field(default_factory=list)
    tip: bool = True
    switches: int = 0


@dataclass
class Finding:
    """Each broken limit with the worst excess; the commanded peaks as shares of the limits."""

    broken: dict[str, float]
    peaks: dict[str, float]


class Judge:
    """Judges rides of one preset."""

    def __init__(self, name: str) -> None:
        self.robot = judged(name)
        limits = self.robot.file["limits"]
        self.rate = joint_limit(self.robot.file, "velocity_deg_s")
        self.turn = joint_limit(self.robot.file, "acceleration_deg_s2")
        self.speed = limits["cartesian"]["velocity"]
        self.thrust = limits["cartesian"]["acceleration"]
        self.jerk = limits["cartesian"]["jerk"]

    def __call__(self, ride: Ride) -> Finding:
        theta = np.array([ride.start, *(k.theta for k in ride.knots)])
        rate = np.array([np.zeros_like(ride.start), *(k.velocity for k in ride.knots)])
        time = np.array([k.duration for k in ride.knots])[:, None]
        commanded = np.array(ride.commanded)
        poses, rates, turns = _cubics(theta, rate, time)
        tip, velocity, acceleration = self.robot.motion(poses, rates, turns)
        speed = np.linalg.norm(velocity, axis=-1)[commanded]
        thrust = np.linalg.norm(acceleration, axis=-1)[commanded]
        asked = {
            "joint velocity": float((np.abs(rates[commanded]) / self.rate).max(initial=0)),
            "joint acceleration": float((np.abs(turns[commanded]) / self.turn).max(initial=0)),
            "tip velocity": float(speed.max(initial=0) / self.speed),
            "tip acceleration": float(thrust.max(initial=0) / self.thrust),
        }
        jerk = self._jerk(tip[:, -1], time[:, 0], commanded) if ride.tip else 0.0
        run = {
            **asked,
            "brake velocity": float((np.abs(rates) / self.rate).max()),
            "brake acceleration": float((np.abs(turns) / self.turn).max()),
            "tip jerk": jerk,
        }
        broken = {k: v - 1 for k, v in run.items() if not v <= 1 + ROUNDING}
        self._place(broken, "", poses.reshape(-1, poses.shape[-1]))
        self._place(broken, "brake: ", self._brakes(theta, rate))
        if rate[-1].any():
            broken["at rest"] = 1.0
        return Finding(broken, asked)

    def _place(self, broken: dict[str, float], what: str, poses: Array) -> None:
        for name, excess in self.robot.broken(poses).items():
            worst = float(np.where(np.isnan(excess), np.inf, excess).max())
            if worst > LENGTH:
                broken[what + name] = worst

    def _brakes(self, theta: Array, rate: Array) -> Array:
        time = (np.abs(rate) / self.turn).max(-1)[:, None, None]
        share = np.linspace(0, 1, BRAKE_SAMPLES)[None, :, None]
        path = theta[:, None] + rate[:, None] * time * (share - share**2 / 2)
        return path.reshape(-1, theta.shape[-1])

    def _jerk(self, tip: Array, time: Array, commanded: NDArray[np.bool_]) -> float:
        """The third difference over equal segments is a mean of the plan's jerk."""
        if len(tip) < 4:
            return 0.0
        third = tip[3:] - 3 * tip[2:-1] + 3 * tip[1:-2] - tip[:-3]
        alike = commanded & np.isclose(time, PERIOD)
        fine = alike[:-3] & alike[1:-2] & alike[2:-1] & alike[3:]
        jerk = np.linalg.norm(third, axis=-1)[fine] / PERIOD**3
        return float(jerk.max(initial=0) / self.jerk)


def _cubics(theta: Array, rate: Array, time: Array) -> tuple[Array, Array, Array]:
    """Hermite's basis: angles, velocities, accelerations (K, SAMPLES, n)."""
    u = np.linspace(0, 1, SAMPLES)[None, :, None]
    t = time[:, :, None]
    p0, p1 = theta[:-1, None], theta[1:, None]
    m0, m1 = rate[:-1, None] * t, rate[1:, None] * t
    angle = (
        (2 * u**3 - 3 * u**2 + 1) * p0
        + (u**3 - 2 * u**2 + u) * m0
        + (3 * u**2 - 2 * u**3) * p1
        + (u**3 - u**2) * m1
    )
    slope = (6 * u**2 - 6 * u) * (p0 - p1) + (3 * u**2 - 4 * u + 1) * m0 + (3 * u**2 - 2 * u) * m1
    bend = (12 * u - 6) * (p0 - p1) + (6 * u - 4) * m0 + (6 * u - 2) * m1
    return angle, slope / t, bend / t**2


def random_goal(judged: Arms | TurningTool, rng: np.random.Generator, mode: str) -> Goal:
    """One target of a kind: "inside", "rim", "edge", "far", "angles", "jog", "turn" or "mixed"."""
    if mode == "mixed":
        kinds = ["inside", "edge", "far", "angles", "jog", "turn", "rest"]
        mode = str(rng.choice(kinds))
    space, axes = judged.file["workspace"], len(judged.axes)
    low, high = space["z"]
    width = space.get("radius", max(abs(v) for v in space.get("x", [100])))
    speed = float(rng.choice([1.0, 1.0, 0.5]))
    match mode:
        case "inside":
            place = (
                *_beside(rng, axes, width * np.sqrt(rng.uniform(0, 0.8))),
                rng.uniform(low, high),
            )
            return ToPoint(tuple(map(float, place)), speed, tool=_tool_angle(judged, rng))
        case "rim":
            place = _beside(rng, axes, width * np.sqrt(rng.uniform(0.1, 0.9)))
            level = float(rng.choice([low + 0.02, high - 0.02]))
            return ToPoint((*place, level), tool=_tool_angle(judged, rng))
        case "edge":
            way = rng.normal(size=axes)
            way *= width * rng.uniform(0.9, 1.4) / np.linalg.norm(way)
            way[-1] += (low + high) / 2
            return ToPoint(tuple(map(float, way)), speed, tool=_tool_angle(judged, rng))
        case "far":
            place = rng.uniform([-900] * (axes - 1) + [-1500], [900] * (axes - 1) + [100])
            return ToPoint(tuple(place.tolist()))
        case "angles":
            joints = judged.file["joints"]
            span = np.radians(joints["min_deg"]) - 0.1, np.radians(joints["max_deg"]) + 0.1
            theta = rng.uniform(*span, size=judged.arms).tolist()
            tool = _tool_angle(judged, rng)
            return ToAngles(tuple(theta if tool is None else [*theta, tool * 1.1]), speed)
        case "jog":
            limit = judged.file["limits"]["cartesian"]["velocity"]
            return AtVelocity(tuple((rng.normal(size=axes) * limit * 0.7).tolist()))
        case "turn":
            limit = joint_limit(judged.file, "velocity_deg_s")
            signs = rng.choice([-1.0, 0.0, 1.0], size=len(limit))
            return AtJointVelocity(tuple((signs * limit * rng.choice([0.5, 1.2])).tolist()))
        case _:
            return Rest()


def _beside(rng: np.random.Generator, axes: int, out: float) -> tuple[float, ...]:
    """A place at a distance from the z axis, without its z."""
    angle = rng.uniform(0, 2 * np.pi)
    if axes == 2:
        return (float(out * np.sign(np.cos(angle))),)
    return float(out * np.cos(angle)), float(out * np.sin(angle))


def _tool_angle(judged: Arms | TurningTool, rng: np.random.Generator) -> float | None:
    if not isinstance(judged, TurningTool):
        return None
    tool = judged.file["tool_axis"]
    return float(np.radians(rng.uniform(tool["min_deg"], tool["max_deg"])))


def sprints(robot: Robot, arms: Arms, rng: np.random.Generator) -> list[Goal]:
    """Moves on which a joint comes to its velocity limit, then to its acceleration limit.

    A joint turns at S·v/jq: fastest where jq is least, for a tip that moves along the forearm S.
    """
    joints, limits = arms.file["joints"], arms.file["limits"]["cartesian"]
    low, high = np.radians(joints["min_deg"]), np.radians(joints["max_deg"])
    theta = rng.uniform(low, high, size=(6000, arms.arms))
    tip = arms.tip(theta)
    rods = tip[:, None, :] - arms.elbows(theta)
    lever = (rods * arms.turning(theta)[0]).sum(-1)
    arm = lever.argmin(-1)
    along = rods[np.arange(len(theta)), arm] / arms.fore
    run = 0.7 * limits["velocity"] ** 2 / limits["acceleration"]
    run += 0.5 * limits["velocity"] * limits["acceleration"] / limits["jerk"]
    goals: list[Goal] = []
    for reach in ((-1, 0, 1), (-0.25, 0, 1), (-0.5, 0, 1), (1, 0, -0.5), (0, 0.3, 0.6)):
        ends = tip[:, None, :] + along[:, None, :] * (run * np.array(reach))[:, None]
        flat = np.ascontiguousarray(ends.reshape(-1, ends.shape[-1]))
        margins = robot.kernel.margins(flat, robot.kernel.inverse(flat))
        fine = np.isfinite(tip).all(-1) & (margins.min(-1).reshape(-1, 3) > 1.0).all(-1)
        order = np.flatnonzero(fine)[np.argsort(lever.min(-1)[fine])]
        if not len(order):
            continue
        pick = ends[order[int(rng.integers(min(3, len(order))))]]
        goals += [ToPoint(tuple(pick[0].tolist())), ToPoint(tuple(pick[2].tolist()))]
    return goals


def ride(
    name: str, *, seed: int, mode: str, ticks: int, hold: tuple[int, int] = (2, 60),
    clock: Callable[[], float] = lambda: 0.0, budget: float = 1.0,
    prepare: Callable[[Follower], None] = lambda follower: None,
) -> Ride:  # fmt: skip
    """Targets each held for a random number of ticks; at the end the brake, to rest.

    Mode "sprint" drives at the joints' limits, the others are `random_goal`'s. `prepare` gets
    the follower before it starts.
    """
    robot = load_robot(FILES.get(name, name))
    known = judged(name)
    rng = np.random.default_rng(seed)
    follower = Follower(robot, robot.homing.ready, clock=clock, budget=budget)
    prepare(follower)
    done = Ride(
        np.array(robot.homing.ready), tip=mode in ("inside", "rim", "edge", "far", "jog", "sprint")
    )
    planned = sprints(robot, known, rng) if mode == "sprint" and isinstance(known, Arms) else []
    goal: Goal = Rest()
    left = 0
    override = 1.0
    for _ in range(ticks):
        if left == 0:
            goal = planned.pop(0) if planned else random_goal(known, rng, mode)
            left = 120 if mode == "sprint" else int(rng.integers(*hold))
            override = float(rng.choice([1.0, 1.0, 1.5, 0.6, 0.0])) if mode == "mixed" else 1.0
            done.switches += 1
        left -= 1
        _advance(done, follower, goal, override)
        if mode == "sprint" and follower.resting and not planned:
            break
        if mode == "sprint" and follower.resting:
            left = 0
    for _ in range(200):
        if follower.resting:
            break
        _advance(done, follower, Rest(), 1.0)
    return done


def _advance(done: Ride, follower: Follower, goal: Goal, override: float) -> None:
    done.knots.append(follower.step(goal, override=override))
    done.commanded.append(not follower.braking)


@pytest.fixture(scope="session")
def tool_robot() -> Robot:
    """The preset stm32 with a tool that turns."""
    return load_robot(FILES["stm32-tool"])


@pytest.fixture(scope="session")
def judge() -> Callable[[str], Judge]:
    """`judge(preset)` gives a judge of rides of that preset."""
    return Judge


@pytest.fixture(scope="session")
def take_ride() -> Callable[..., Ride]:
    return ride
