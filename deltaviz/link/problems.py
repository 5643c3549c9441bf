"""What can be wrong with a board at the other end, as sentences: the cause, and the way out."""

from __future__ import annotations

from deltaviz.link.messages import PROTOCOL_VERSION
from deltaviz.link.timing import GREETING_WITHIN, SILENT_AFTER


def silent() -> str:
    return (
        f"The board has been silent for {SILENT_AFTER:g} s; it brakes by itself when it hears "
        "nothing. Check its cable and power, then connect."
    )


def no_answer() -> str:
    return (
        f"No board answered within {GREETING_WITHIN:g} s. Check its cable, its power and the "
        "chosen link, then connect."
    )


def other_version(theirs: int) -> str:
    ours = PROTOCOL_VERSION
    speaks = f"The board speaks version {theirs} of the protocol, deltaviz speaks {ours}."
    if theirs > ours:
        return f"{speaks} Update deltaviz, then connect."
    return f"{speaks} Flash the firmware that comes with this deltaviz, then connect."


def other_joints(theirs: int, ours: int) -> str:
    return (
        f"The board drives {theirs} joints, the robot has {ours}. "
        "Choose the robot that is connected, then connect."
    )


def other_configuration() -> str:
    return (
        "The board took another configuration than it was given. Connect again; if it "
        "happens again, its firmware does not fit this program."
    )


def set_up_for_another(robot: str | None) -> str:
    """`robot`: the name of the one whose configuration the board has, if it is known."""
    if robot is None:
        return (
            "The board is set up for another robot, or by another version of its file, and its "
            "drivers are on. Switch the board off and on again, then connect."
        )
    return (
        f"The board is set up for {robot} and its drivers are on. Choose {robot}, connect and "
        "disable; or switch the board off and on again. Then connect with this robot."
    )


def unanswered(command: str) -> str:
    return (
        f"The board did not answer '{command}'. Check its cable, then connect again; if it "
        "happens again, its firmware does not fit this program."
    )


def not_reporting() -> str:
    return "The board took its configuration and then reported nothing. Connect again."


def restarted() -> str:
    return (
        "The board has restarted, so it does not know its position any more. "
        "See to its power supply, then connect and home."
    )
