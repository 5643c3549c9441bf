"""Homing: fast to the switch, back off, slow to the switch, then to the ready pose.

One joint after another or all together. Where the slow approach met the switch is the switch's
angle; the counts follow from it. Velocities change by no more than the joint's acceleration.
"""

from __future__ import annotations

from collections.abc import Sequence
from enum import StrEnum
from math import isqrt

from deltaviz.link.board.parameters import Parameters
from deltaviz.link.board.paths import Cubic, Path, Ramp
from deltaviz.link.board.stepper import nearest
from deltaviz.link.messages import Fault


class Phase(StrEnum):
    FAST = "fast to the switch"
    BACK = "back off"
    SLOW = "slow to the switch"
    STOP = "at the switch"
    DONE = "done"


class JointHoming:
    """One joint. Positions in Q32, velocities in 2^-16 microsteps per ms."""

    def __init__(self, parameters: Parameters, joint: int) -> None:
        configure = parameters.configure
        self._direction = configure.homing_direction
        self._fast = configure.homing_fast[joint] * self._direction
        self._slow = configure.homing_slow[joint] * self._direction
        self._backoff = configure.homing_backoff[joint] << 32
        self._max_travel = configure.homing_max_travel[joint] << 32
        self._most_change = parameters.accelerations[joint] >> 16
        self._mark = 0
        self._released: int | None = None
        self._phase: Phase | None = None
        self.velocity = 0
        self.trigger = 0
        self.fault = Fault.NONE

    @property
    def done(self) -> bool:
        return self._phase is Phase.DONE

    def next_velocity(self, position: int, *, pressed: bool) -> int:
        """The velocity to have 1 ms after the plan's end."""
        if self._phase is None:
            self._enter(Phase.BACK if pressed else Phase.FAST, position)
        change = self._aim(position, pressed) - self.velocity
        self.velocity += min(max(change, -self._most_change), self._most_change)
        return self.velocity

    def _enter(self, phase: Phase, position: int) -> None:
        self._phase = phase
        self._mark = position
        self._released = None

    def _aim(self, position: int, pressed: bool) -> int:
        travelled = (position - self._mark) * self._direction  # towards the switch
        if self._phase is Phase.FAST:
            if pressed:
                self._enter(Phase.BACK, position)
                return -self._fast
            if travelled > self._max_travel:
                self.fault = Fault.HOMING_NO_SWITCH
            return self._fast
        if self._phase is Phase.BACK:
            return self._back_off(position, -travelled, pressed)
        if self._phase is Phase.SLOW:
            if not pressed:
                if travelled > self._max_travel:
                    self.fault = Fault.HOMING_NO_SWITCH
                return self._slow
            self.trigger = position
            self._phase = Phase.STOP
        if self._phase is Phase.STOP and self.velocity == 0:
            self._phase = Phase.DONE
        return 0

    def _back_off(self, position: int, away: int, pressed: bool) -> int:
        if pressed:
            self._released = None
            if away > 2 * self._backoff:
                self.fault = Fault.HOMING_SWITCH_STUCK
        elif self._released is None:
            self._released = position
        elif (self._released - position) * self._direction >= self._backoff:
            self._enter(Phase.SLOW, position)
            return self._slow
        return -self._fast


class Homing:
    def __init__(self, parameters: Parameters, *, ticks_per_ms: int) -> None:
        self._parameters = parameters
        self._ticks_per_ms = ticks_per_ms
        self._joints = [JointHoming(parameters, joint) for joint in range(parameters.joints)]

    @property
    def done(self) -> bool:
        """Every joint stands at its reference, or will where the plan ends."""
        return all(joint.done for joint in self._joints)

    @property
    def fault(self) -> Fault:
        return next((joint.fault for joint in self._joints if joint.fault), Fault.NONE)

    def next_path(
        self, positions: Sequence[int], switches: Sequence[bool], *, planned: Sequence[int]
    ) -> Path:
        """The millisecond after the plan, which ends at `planned`; `positions` are those at which
        the switches were looked at.
        """
        before = self._velocities
        for joint, position, pressed in zip(self._joints, positions, switches, strict=True):
            if joint.done:
                continue
            joint.next_velocity(position, pressed=pressed)
            if not self._parameters.homing_together:
                break
        return Ramp(
            start=planned,
            v_start=before,
            v_end=self._velocities,
            ticks=self._ticks_per_ms,
            ticks_per_ms=self._ticks_per_ms,
        )

    @property
    def _velocities(self) -> list[int]:
        return [joint.velocity for joint in self._joints]

    def referenced(self, positions: Sequence[int]) -> list[int]:
        """What the positions are, now that the switches' angles are known; in whole microsteps."""
        return [
            (switch + nearest(position) - nearest(joint.trigger)) << 32
            for position, joint, switch in zip(
                positions, self._joints, self._parameters.configure.homing_switch, strict=True
            )
        ]

    def way_to_ready(self, counts: Sequence[int]) -> Path:
        """All joints in one time, none faster than its fast homing speed."""
        still = [0] * len(counts)
        return Cubic(
            start=[count << 10 for count in counts],
            end=[ready << 10 for ready in self._parameters.configure.ready],
            v_start=still,
            v_end=still,
            ticks=self._ticks_to_ready(counts),
            ticks_per_ms=self._ticks_per_ms,
        )

    def _ticks_to_ready(self, counts: Sequence[int]) -> int:
        """From rest to rest the cubic's peaks are 3 d / (2 T) and 6 d / T²."""
        ms = 4
        configure, accelerations = self._parameters.configure, self._parameters.accelerations
        for count, ready, fast, acceleration in zip(
            counts, configure.ready, configure.homing_fast, accelerations, strict=True
        ):
            distance = abs(ready - count)
            ms = max(
                ms,
                (3 * distance << 16) // (2 * fast) + 1,
                isqrt((6 * distance << 32) // acceleration) + 1,
            )
        return ms * self._ticks_per_ms
