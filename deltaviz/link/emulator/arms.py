"""The arms that hang on the emulated board: what its plant is told about a robot."""

from __future__ import annotations

from dataclasses import dataclass

from deltaviz.link.board.plant import mechanical_ends, power_up_pose
from deltaviz.link.messages import Configure, Options


@dataclass(frozen=True, slots=True)
class Arm:
    """Microsteps from the true zero angle, which the board does not know at power-up."""

    at: int
    low: int  # the mechanical ends
    high: int
    switch: int  # pressed from here on
    direction: int  # towards the switch: +1 or -1
    inverted: bool  # positive angles at the low level of DIR
    switch_open: bool  # the pressed switch is an open circuit


def arms_of(configure: Configure) -> tuple[Arm, ...]:
    """Those of a robot that was just switched on."""
    pose, per_rad = power_up_pose(configure), configure.microsteps_per_rad
    return tuple(
        Arm(
            at=round(pose[joint] * per_rad[joint]),
            low=low,
            high=high,
            switch=configure.homing_switch[joint],
            direction=configure.homing_direction,
            inverted=configure.inverted[joint],
            switch_open=Options.SWITCH_ACTIVE_OPEN in configure.options,
        )
        for joint, (low, high) in enumerate(mechanical_ends(configure))
    )
