"""What can be wrong with a board at the other end, as sentences: the cause, and the way out."""

from __future__ import annotations

from deltaviz.link.impression import Impression, Kind
from deltaviz.link.messages import PROTOCOL_VERSION
from deltaviz.link.timing import GREETING_WITHIN, SILENT_AFTER


def silent() -> str:
    return (
        f"The board has been silent for {SILENT_AFTER:g} s; hearing nothing, it brakes by itself. "
        "Check its cable and power, then connect."
    )


def no_answer(impression: Impression) -> str:
    if impression.kind is Kind.BOARD:
        return (
            "A board is heard, but it does not seem to hear this computer. Check the wire from "
            "the computer's TX to the board's RX, then connect."
        )
    return (
        f"No board answered within {GREETING_WITHIN:g} s: not a byte came. Check its power, cable "
        "(TX to RX, RX to TX), firmware and baud rate, or choose another link; then connect."
    )


def strange(impression: Impression) -> str | None:
    """What seems to be connected instead of a board; None: it may still be one."""
    match impression.kind:
        case Kind.TEXT:
            return (
                f"What is connected says '{impression.sample}': it is no board with deltaviz "
                "firmware. Choose another link, or flash the board, then connect."
            )
        case Kind.ECHO:
            return (
                "What is connected sends back what it hears, as a modem does, or a cable whose TX "
                "and RX touch. Check the wiring, or choose another link, then connect."
            )
        case Kind.NOISE:
            return (
                "Bytes come, but none that make sense: another baud rate, or another device. "
                "Choose another link, or start with --link serial://DEVICE?baud=N."
            )
        case Kind.NOTHING | Kind.BOARD:
            return None


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
        "The board took another configuration than it was given. Connect again; if it happens "
        "again, its firmware does not fit this program."
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
        "disable, then choose this robot; or switch the board off and on, then connect."
    )


def unanswered(command: str) -> str:
    return (
        f"The board did not answer '{command}'. Check its cable, then connect; if it happens "
        "again, its firmware does not fit this program."
    )


def not_reporting() -> str:
    return "The board took its configuration and then reported nothing. Connect again."


def restarted() -> str:
    return (
        "The board has restarted, so it does not know its position any more. "
        "See to its power supply, then connect and home."
    )
