"""What hangs on the simulated board's pins: arms with a hidden pose at power-up, switches, ends.

The arms hold where they are when the drivers are off; real ones may drop. The direction pins'
inversion is no part of it: messages and counts know no pins.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import radians

from deltaviz.link.board.parameters import Parameters
from deltaviz.link.configuration import P_UNIT
from deltaviz.link.messages import Configure

_END_BEYOND = radians(6)  # from the outermost of joint limit and switch to the mechanical end
_POWER_UP = (0.20, -0.12, 0.08, -0.16)  # rad from the ready pose: where arms were left


class Plant:
    """Arms by microsteps from the true zero angle; `switches`: which are pressed."""

    def __init__(self, parameters: Parameters, *, theta: Sequence[float]) -> None:
        """`theta` is the hidden pose of the arms (rad)."""
        configure = parameters.configure
        per_rad = configure.microsteps_per_rad
        self._direction = configure.homing_direction
        self._switch = configure.homing_switch
        self._arms = [round(angle * m) for angle, m in zip(theta, per_rad, strict=True)]
        self._ends = mechanical_ends(configure)
        self._per_rad = per_rad
        self._counts: Sequence[int] = (0,) * parameters.joints
        self._forced: dict[int, bool] = {}
        self.switches = self._read_switches()

    @property
    def theta(self) -> tuple[float, ...]:
        """The true angles of the arms, rad."""
        return tuple(arm / m for arm, m in zip(self._arms, self._per_rad, strict=True))

    def force_switch(self, joint: int, pressed: bool | None) -> None:
        """A broken switch: it reads so whatever the arm does; None: it is mended."""
        if pressed is None:
            self._forced.pop(joint, None)
        else:
            self._forced[joint] = pressed
        self.switches = self._read_switches()

    def _read_switches(self) -> list[bool]:
        pressed = [
            (arm - switch) * self._direction >= 0
            for arm, switch in zip(self._arms, self._switch, strict=True)
        ]
        for joint, reads in self._forced.items():
            pressed[joint] = reads
        return pressed

    def step(self, counts: Sequence[int]) -> None:
        """The counter went to `counts`; an arm at its mechanical end stays, its steps are lost."""
        arms, before, ends = self._arms, self._counts, self._ends
        if counts == before:
            return
        for joint, count in enumerate(counts):
            arm = arms[joint] + count - before[joint]
            low, high = ends[joint]
            if arm < low:
                arm = low
            elif arm > high:
                arm = high
            arms[joint] = arm
        self._counts = counts
        self.switches = self._read_switches()

    def rebase(self, counts: Sequence[int]) -> None:
        """The counter was set to `counts`, without a step."""
        self._counts = counts


def mechanical_ends(configure: Configure) -> list[tuple[int, int]]:
    """The lowest and the highest microstep of each arm."""
    return [
        (
            int(min(low / P_UNIT, switch) - _END_BEYOND * m),
            int(max(high / P_UNIT, switch) + _END_BEYOND * m),
        )
        for low, high, switch, m in zip(
            configure.joint_min,
            configure.joint_max,
            configure.homing_switch,
            configure.microsteps_per_rad,
            strict=True,
        )
    ]


def power_up_pose(configure: Configure) -> tuple[float, ...]:
    """Where the arms of a robot that was just switched on hang: inside the joint limits."""
    return tuple(
        min(max(ready / m + away, low / P_UNIT / m), high / P_UNIT / m)
        for ready, away, low, high, m in zip(
            configure.ready,
            _POWER_UP,
            configure.joint_min,
            configure.joint_max,
            configure.microsteps_per_rad,
            strict=False,
        )
    )
