"""What a board has gone through that is met, or met again: told to the person who connected it."""

from __future__ import annotations

from deltaviz.link.session import Session
from deltaviz.machine import sentences


class Acquaintance:
    """The board that was last on a link: which power-up it was, and whether it was homed.

    Whether the robot is homed now is the board's own word: it loses it with its power, with its
    drivers, and with another configuration. This only finds words for what has become of it.
    """

    def __init__(self) -> None:
        self._link: str | None = None
        self._boot = 0
        self._homed = False

    def note(self, link: str, session: Session) -> None:
        """Remember the board of a session that has been ready, while it lasts."""
        if session.board is not None:
            self._link, self._boot, self._homed = link, session.board.boot, session.homed

    def greet(self, link: str, session: Session) -> str | None:
        """What to say of the board of a session that has just become ready; None: nothing."""
        if session.board is None:
            return None
        braked = sentences.BRAKED_ALONE.get(session.board.last_stop)
        if link != self._link or not self._homed:
            if braked is None:
                return None
            return f"Before this, the board braked by itself: {braked}. Nothing was resumed."
        same = session.board.boot == self._boot
        if session.homed:
            alone = "" if braked is None else f"braked by itself ({braked}) and "
            return (
                f"Connected again: the board {alone}kept its position, the robot is still homed. "
                "Nothing was resumed."
                if same
                else None
            )
        if same:
            return "Connected again: the board is the same, but it is not homed any more."
        return "Connected again: the board was restarted, or is another one, so home it."
