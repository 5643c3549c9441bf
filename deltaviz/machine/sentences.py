"""What the machine tells a person: why it stopped, what is wrong, what to do next."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

from deltaviz.link.messages import Fault, Refusal, Refused, StopCause
from deltaviz.machine.mode import Mode

NEXT_STEP: Final[Mapping[Mode, str]] = {
    Mode.OFFLINE: "Connect to a board, or to the simulated one.",
    Mode.DISABLED: "Enable the drivers; the arms then hold.",
    Mode.UNHOMED: "Home the robot, so that it knows its pose.",
    Mode.IDLE: "Jog with the buttons, or drag the handle in the scene.",
    Mode.PAUSED: "Resume the motion, or stop it.",
    Mode.FAULT: "See to the fault, then reset.",
    Mode.ESTOP: "Make sure that all is safe, then reset.",
}

STOPPED_BY: Final[Mapping[StopCause, str]] = {
    StopCause.HOST_STOP: "The board was told to stop, and not from here.",
    StopCause.UNDERRUN: "The computer was too slow: the board ran out of motion and braked.",
    StopCause.LEASE: "The board did not hear from the computer for 150 ms and braked.",
    StopCause.BAD_SEGMENT: "The board refused a motion and braked.",
    StopCause.LIMIT_SWITCH: "An arm reached its end switch.",
    StopCause.ESTOP: "E-stop: the drivers are off, the robot must be homed again.",
    StopCause.DISABLED: "The drivers were switched off.",
    StopCause.HOMING_FAILED: "Homing failed.",
    StopCause.BOOT: "The board restarted.",
}

LOST_ON_THE_WAY = (
    "The connection lost or delayed too much: the board ran out of motion and braked. "
    "Check its cable."
)
NEVER_BEGAN = (
    "The motion did not reach the board, so it was given up. Check its cable; if it happens again, "
    "connect anew."
)
ESTOP_BY_INPUT: Final = (
    "The hardware emergency stop was pressed: the drivers are off, the robot must be homed again."
)

# Of a board that stopped while nobody was there to hear why: "it braked by itself: ..."
BRAKED_ALONE: Final[Mapping[StopCause, str]] = {
    StopCause.UNDERRUN: "it ran out of motion, and no more came",
    StopCause.LEASE: "it did not hear from a computer for 150 ms",
    StopCause.BAD_SEGMENT: "it refused a motion",
    StopCause.LIMIT_SWITCH: "an arm reached its end switch",
}

FAULT: Final[Mapping[Fault, str]] = {
    Fault.LIMIT_SWITCH: "An arm reached its end switch. Move it away by hand, then reset and home.",
    Fault.HOMING_NO_SWITCH: (
        "Homing found no end switch on its way. Check the switches and the motors' direction."
    ),
    Fault.HOMING_SWITCH_STUCK: (
        "An end switch stays pressed. Check its wire; a broken one reads as pressed."
    ),
    Fault.ESTOP_INPUT: "The hardware emergency stop is pressed. Release it, then reset.",
    Fault.CONFIGURATION: "The board cannot work with this robot's configuration.",
    Fault.LATE: (
        "The board did not keep up with the motion, so it switched the drivers off. Reset, then "
        "home. If it happens again, its firmware does not fit its processor."
    ),
}

REFUSED_BECAUSE: Final[Mapping[Refusal, str]] = {
    Refusal.STATE: "it is not in a state for it",
    Refusal.EPOCH: "it belongs to an earlier motion",
    Refusal.COUNTS: "the robot is not where this program believes it to be",
    Refusal.MOVING: "the robot is moving",
    Refusal.INDEX: "a part of it was lost on the way",
    Refusal.TIME: "it came at the wrong time",
    Refusal.QUEUE_FULL: "its queue is full",
    Refusal.JOINT_LIMIT: "it leaves a joint's range",
    Refusal.VELOCITY: "a joint would be too fast",
    Refusal.ACCELERATION: "a joint would accelerate too hard",
    Refusal.BRAKE: "the robot could not brake in time",
    Refusal.WORKSPACE: "it leaves the workspace",
    Refusal.CONFIGURATION: "the configuration does not fit",
    Refusal.VERSION: "it speaks another version of the protocol",
    Refusal.UNHOMED_SPEED: "it is too fast for a robot that is not homed",
    Refusal.LEASE: "it came too late",
    Refusal.INPUT: "the hardware emergency stop is still pressed",
    Refusal.KIND: "it mixes straight and joint motion where the robot does not rest",
}


def stopped_by(cause: StopCause, *, lossy: bool) -> str | None:
    """What made the board stop; None: it was asked to. `lossy`: much was lost on its way."""
    if cause is StopCause.UNDERRUN and lossy:
        return LOST_ON_THE_WAY
    return STOPPED_BY.get(cause)


def board_refused(refused: Refused) -> str:
    """The board's refusal as a sentence."""
    what = "to begin" if refused.command == "arm" else f"'{refused.command}'"
    what = "a motion" if refused.of_segment else what
    where = "" if refused.joint is None else f" (joint {refused.joint + 1})"
    return f"The board refused {what}: {REFUSED_BECAUSE[refused.reason]}{where}."
