"""Whether a board executed what was commanded and no more, and within its robot's limits.

It shares no code with what it judges: the limits are the preset's file, read here; the cubics and
the brake are the formulas of docs/protocol.md in floating point; poses are judged by the
kinematics of the tests. A board's own word is used once, as a hint: how late a motion runs.
With a wrong hint nothing fits.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from deltaviz.link.messages import BoardState, Segment
from tests.faults.executed import Executed, Sample
from tests.motion.conftest import joint_limit, judged

Floats = NDArray[np.float64]
MS = 200  # ticks
SAME = 5e-4  # microsteps: two ways of computing a path's position
BRAKED = 5e-3  # the same of a brake, whose velocity is a whole number of 2^-16 microsteps/ms
COUNTED = 0.8  # of both, by whole microsteps: half of one, and a step's ticks on its way
STILL = 0.02  # microsteps, within which a path ends as a brake would
UNSURE = 12  # samples by which a slow path and its brake may look the same
UNSURE_COUNTED = 80  # the same, by whole microsteps
RATE_SLACK = 0.003  # of velocity and acceleration: the board's own slack, and rounding
PLACE = 0.1  # mm, which the board allows itself
LATEST = 150 * MS  # ticks by which a motion may begin late
LEASE = 150 * MS  # ticks
STOPS_WITHIN = 3 * MS  # ticks from a Stop to the brake: planned is up to two milliseconds ahead


@dataclass
class Verdict:
    """`wrong` says what should not have been. `worst` has, for each limit, the share of it that was
    reached, or the millimetres by which it was passed (less than 0: not at all).
    """

    wrong: list[str] = field(default_factory=list)
    worst: dict[str, float] = field(default_factory=dict)
    brakes: int = 0

    def peak(self, limit: str, value: float) -> None:
        self.worst[limit] = max(value, self.worst.get(limit, -np.inf))

    @property
    def excess(self) -> dict[str, float]:
        """What was above its limit by more than rounding."""
        return {
            name: value
            for name, value in self.worst.items()
            if value > (1 + RATE_SLACK if name in _RATES else PLACE)
        }


_RATES = ("joint velocity", "joint acceleration")


class Judge:
    """With `counted` the positions are steps, of which a fit has to tell speeds and accelerations:
    they are not judged here.
    """

    def __init__(self, preset: str = "stm32", *, counted: bool = False) -> None:
        self.counted = counted
        self.same = COUNTED if counted else SAME
        self.braked = COUNTED if counted else BRAKED
        self.unsure = UNSURE_COUNTED if counted else UNSURE
        self._robot = judged(preset)
        drive = self._robot.file["drive"]
        turns = drive["gear"][0] / drive["gear"][1]
        self._per_rad = drive["full_steps"] * drive["microsteps"] * turns / (2 * np.pi)
        self._velocity = joint_limit(self._robot.file, "velocity_deg_s") * self._per_rad
        self._acceleration = joint_limit(self._robot.file, "acceleration_deg_s2") * self._per_rad

    def __call__(self, executed: Executed) -> Verdict:
        verdict = Verdict()
        for life in _lives(executed.samples):
            self._life(life, executed, verdict)
        if any(s.state is BoardState.HOMING and s.unheard > LEASE for s in executed.samples):
            verdict.wrong.append("homing goes on without a host")
        if not executed.lost_power and executed.samples[-1].moving:
            verdict.wrong.append("does not come to rest")
        if verdict.excess:
            verdict.wrong.append(f"limits were broken: {verdict.excess}")
        return verdict

    def _life(self, life: _Life, executed: Executed, verdict: Verdict) -> None:
        samples = life.samples
        positions = np.array([s.positions for s in samples], np.float64) / 2**32
        counts = np.array([s.counts for s in samples], np.float64)
        if np.abs(counts - positions).max(initial=0.0) > 0.5 + SAME:
            verdict.wrong.append("the count is not the position")
        same = self._limits(positions, counts, samples, verdict)
        if life.homes:
            return
        if not same.all():
            verdict.wrong.append("steps were lost or added on the way to the arms")
        self._places(positions, verdict)
        ticks = _unwrapped(samples)
        for begin, end in _epochs(samples):
            moved = np.abs(np.diff(positions[begin:end], axis=0)).max(axis=1, initial=0.0) > 0
            if moved.any():
                here = slice(begin, end)
                _Following(self, executed, samples[here], ticks[here], positions[here])(verdict)

    def _limits(
        self, positions: Floats, counts: Floats, samples: Sequence[Sample], verdict: Verdict
    ) -> NDArray[np.bool_]:
        """Speeds and accelerations. In which milliseconds the arms went as the count did: it is set
        anew at the end of homing.
        """
        arms = np.array([s.arms for s in samples]) * self._per_rad
        same = (np.abs(np.diff(counts, axis=0) - np.diff(arms, axis=0)) < 0.5).all(axis=1)
        rate = np.diff(positions, axis=0) * 1000.0
        turn = np.diff(rate, axis=0) * 1000.0
        # Opening an epoch forgets fractions of a microstep, without a step.
        even = same & np.array([a.epoch == b.epoch for a, b in pairwise(samples)], bool)
        even &= ~_rounded(positions)
        if self.counted:
            return same
        fast = np.abs(rate[even]) / self._velocity
        hard = np.abs(turn[even[:-1] & even[1:]]) / self._acceleration
        verdict.peak("joint velocity", float(fast.max(initial=0.0)))
        verdict.peak("joint acceleration", float(hard.max(initial=0.0)))
        return same

    def _places(self, positions: Floats, verdict: Verdict) -> None:
        moved = np.flatnonzero(np.abs(np.diff(positions, axis=0)).max(axis=1, initial=0.0))
        if len(moved):
            for limit, values in self._robot.broken(positions[moved] / self._per_rad).items():
                verdict.peak(limit, float(values.max()))

    def brake(self, p: Floats, v: Floats, since: Floats) -> Floats:
        """Positions (k, n), ticks `since` its beginning at `p` with `v` (microsteps/s): all joints
        along the tangent, in one time, the hardest braked one at its limit.
        """
        time = max(1e-3, float((np.abs(v) / self._acceleration).max()))
        t = np.clip(since / (1000 * MS), 0.0, time)[:, None]
        return p + v * (t - t * t / (2 * time))


class _Following:
    """Follows the motions of one epoch, one after the other."""

    def __init__(
        self,
        judge: Judge,
        executed: Executed,
        samples: Sequence[Sample],
        ticks: Floats,
        positions: Floats,
    ) -> None:
        self._judge = judge
        self._executed = executed
        self._samples = samples
        self._epoch = samples[0].epoch
        self._ticks = ticks
        self._positions = positions

    def __call__(self, verdict: Verdict) -> None:
        arm = self._executed.arms.get(self._epoch)
        if arm is None:
            verdict.wrong.append(f"motion in epoch {self._epoch}, which nobody has opened")
            return
        if np.abs(self._positions[0] - arm.counts).max() > SAME:
            verdict.wrong.append(f"epoch {self._epoch} begins elsewhere than was said")
        at = 0  # the first sample that is not explained yet
        origin = np.array(arm.counts, np.float64)
        for motion in self._motions():
            if _stands(motion, origin):
                continue
            at = self._rests(at)
            if at == len(self._ticks):
                return
            at, braked = self._follow(motion, origin, at, verdict)
            origin = np.array(motion[-1].p, np.float64) / 1024
            if braked:
                break
        if self._rests(at) < len(self._ticks):
            verdict.wrong.append(f"epoch {self._epoch}: motion that was not commanded")

    def _motions(self) -> Iterator[list[Segment]]:
        """Of what was sent: from rest to rest, or to where it breaks off."""
        motion: list[Segment] = []
        for index in range(0x10000):
            segment = self._executed.segments.get((self._epoch, index))
            if segment is None:
                break
            motion.append(segment)
            if not any(segment.v):
                yield motion
                motion = []
        if motion:
            yield motion

    def _rests(self, at: int) -> int:
        """The first sample from `at` on that differs from the one before it."""
        steps = np.abs(np.diff(self._positions[max(at - 1, 0) :], axis=0)).max(axis=1, initial=0.0)
        moved = np.flatnonzero(steps > 0)
        return len(self._ticks) if not len(moved) else max(at - 1, 0) + int(moved[0]) + 1

    def _follow(
        self, motion: list[Segment], origin: Floats, at: int, verdict: Verdict
    ) -> tuple[int, bool]:
        """From sample `at`, the first that moves: the first one after it that is not explained by
        this motion, and whether it was left for a brake.
        """
        late = self._late(motion)
        if late is None:
            verdict.wrong.append(f"epoch {self._epoch}: motion of which the board does not tell")
            return len(self._ticks), True
        if not 0 <= late <= LATEST:
            verdict.wrong.append(f"epoch {self._epoch}: a motion began {late / MS:.0f} ms late")
        path = _Path(motion, origin, since=self._ticks[at], late=late)
        ticks, positions = self._ticks[at:], self._positions[at:]
        off = np.abs(path.positions(ticks) - positions).max(axis=1) > self._judge.same
        off |= ticks > path.end
        left = int(np.argmax(off)) if off.any() else len(off)
        braked = left < len(off) and not (ticks[left] > path.end and path.rests)
        explained = left
        if braked:
            verdict.brakes += 1
            left, explained = self._brake(path, left, ticks, positions)
            if explained <= left:
                verdict.wrong.append(f"epoch {self._epoch}: left its path, and not by the brake")
        self._stops(at, left, path, verdict)
        return at + explained, braked

    def _stops(self, at: int, left: int, path: _Path, verdict: Verdict) -> None:
        """What is commanded does not go on after a Stop, nor without a host that hears."""
        ticks = self._ticks[at : at + left]
        going = np.flatnonzero(ticks < path.end)
        if not len(going):
            return
        first, last = float(self._ticks[0]), int(ticks[going[-1]])
        stops = (first + _since(stop, int(first)) for stop in self._executed.stops)
        after = [stop + STOPS_WITHIN for stop in stops if first <= stop < last - STOPS_WITHIN]
        if after and np.abs(path.position(last) - path.position(min(after))).max() > STILL:
            verdict.wrong.append(f"epoch {self._epoch}: goes on after a Stop")
        if max(s.unheard for s in self._samples[at : at + int(going[-1]) + 1]) > LEASE:
            verdict.wrong.append(f"epoch {self._epoch}: goes on without a host")

    def _late(self, motion: list[Segment]) -> int | None:
        for segment in motion:
            told = self._executed.queue_ends.get((self._epoch, segment.index))
            if told is not None:
                return _since(told, segment.t_end)
        return None

    def _brake(self, path: _Path, left: int, ticks: Floats, positions: Floats) -> tuple[int, int]:
        """The brake by which the path was left before sample `left`: its first sample, and the
        first one after it. It begins at the end of a sample, or at a knot.
        """
        best = left, left
        for first in range(left, max(left - self._judge.unsure, -1), -1):
            start = ticks[first] - MS
            for begun in (start, *path.knots_in(start, ticks[first])):
                p, v = path.position(begun), path.velocity(begun)
                wanted = self._judge.brake(p, v, ticks[first:] - begun)
                off = np.abs(wanted - positions[first:]).max(axis=1) > self._judge.braked
                end = first + (int(np.argmax(off)) if off.any() else len(off))
                if end > left and end >= best[1]:
                    best = first, end
        return best


def _stands(motion: list[Segment], origin: Floats) -> bool:
    """Its knots are where it begins, but for rounding."""
    away = max(float(np.abs(np.array(s.p) / 1024 - origin).max()) for s in motion)
    return away <= 1 / 1024 and not any(any(s.v) for s in motion)


class _Path:
    """Cubics between knots, from `origin` at rest; ticks are the caller's, on from `since`."""

    def __init__(self, motion: list[Segment], origin: Floats, *, since: float, late: int) -> None:
        first = motion[0].t_end - motion[0].duration + late
        self._begin = since + _since(first, int(since))
        self._lengths = np.array([s.duration for s in motion], np.float64)
        self._ends = self._begin + np.cumsum(self._lengths)
        self._p = np.array([origin, *(np.array(s.p) / 1024 for s in motion)])
        self._v = np.array([0 * origin, *(np.array(s.v) / 65.536 for s in motion)])
        self.rests = not any(motion[-1].v)

    @property
    def end(self) -> float:
        return float(self._ends[-1])

    def knots_in(self, low: float, high: float) -> list[float]:
        return [float(end) for end in self._ends if low <= end <= high]

    def position(self, tick: float) -> Floats:
        return self.positions(np.array([tick]))[0]

    def velocity(self, tick: float) -> Floats:
        """Microsteps per second."""
        piece, u, h = self._at(np.array([tick]))
        p0, p1, v0, v1 = self._knots(piece)
        slope = (p1 - p0) * (6 * u - 6 * u**2) / h
        return (slope + v0 * (1 - 4 * u + 3 * u**2) + v1 * (3 * u**2 - 2 * u))[0]

    def positions(self, ticks: Floats) -> Floats:
        """(k, n) microsteps."""
        piece, u, h = self._at(ticks)
        p0, p1, v0, v1 = self._knots(piece)
        return (
            p0
            + (p1 - p0) * (3 * u**2 - 2 * u**3)
            + v0 * h * (u - 2 * u**2 + u**3)
            + v1 * h * (u**3 - u**2)
        )

    def _at(self, ticks: Floats) -> tuple[NDArray[np.int64], Floats, Floats]:
        """The cubic of each tick, the share of it that has passed, and its seconds."""
        piece = np.minimum(np.searchsorted(self._ends, ticks), len(self._ends) - 1)
        length = self._lengths[piece]
        u = np.clip(1 - (self._ends[piece] - ticks) / length, 0.0, 1.0)
        return piece, u[:, None], length[:, None] / (1000 * MS)

    def _knots(self, piece: NDArray[np.int64]) -> tuple[Floats, Floats, Floats, Floats]:
        return self._p[piece], self._p[piece + 1], self._v[piece], self._v[piece + 1]


def _rounded(positions: Floats) -> NDArray[np.bool_]:
    """Where a reference is taken at rest: the fraction of a microstep is forgotten, no step is
    made, and nothing moves after it.
    """
    steps = np.abs(np.diff(positions, axis=0)).max(axis=1, initial=0.0)
    whole = (positions[1:] == np.round(positions[1:])).all(axis=1)
    return whole & (steps <= 0.5) & np.concatenate([steps[1:] == 0, [True]])


def _since(tick: int, origin: int) -> int:
    """On the wrapping counter."""
    return (tick - origin + 2**31) % 2**32 - 2**31


def _unwrapped(samples: Sequence[Sample]) -> Floats:
    steps = [_since(b.tick, a.tick) for a, b in pairwise(samples)]
    return samples[0].tick + np.concatenate([[0.0], np.cumsum(steps, dtype=np.float64)])


@dataclass
class _Life:
    """A stretch in which positions mean the same; `homes`: which ends with that."""

    samples: list[Sample]
    homes: bool


def _lives(samples: Sequence[Sample]) -> Iterator[_Life]:
    """Of a board that is configured. The brake that ends a homing is a part of it."""
    life: _Life | None = None
    for sample in samples:
        homes = sample.state is BoardState.HOMING or (
            life is not None and life.homes and sample.state is BoardState.BRAKING
        )
        if not sample.positions:
            continue
        if life is None or homes != life.homes:
            if life is not None:
                yield life
            life = _Life(life.samples[-1:] if life is not None and homes else [], homes)
        life.samples.append(sample)
    if life is not None:
        yield life


def _epochs(samples: Sequence[Sample]) -> Iterator[tuple[int, int]]:
    begin = 0
    for i in range(1, len(samples) + 1):
        if i == len(samples) or samples[i].epoch != samples[begin].epoch:
            yield begin, i
            begin = i
