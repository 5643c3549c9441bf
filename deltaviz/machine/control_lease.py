"""Who controls the robot: one client at a time, changing hands only at rest."""

from __future__ import annotations

ELSEWHERE = (
    "Another page controls the robot. Control changes hands when the robot is at rest: "
    "ask for it there. Stop works for everyone."
)
MOVES = "The robot is moving; control changes hands only at rest. Stop works for everyone."


class ControlLease:
    """The holder of control, if any.

    A page (a client that said it is here) keeps control until it releases it or is gone. A
    client that never said so, a program over HTTP, keeps it for the motion it asked for, or, if
    it asked for control outright, until it releases it.
    """

    def __init__(self) -> None:
        self._holder: str | None = None
        self._here: set[str] = set()
        self._asked = False

    @property
    def holder(self) -> str | None:
        return self._holder

    def here(self, client: str) -> None:
        self._here.add(client)

    def gone(self, client: str) -> bool:
        """Forget `client`; whether it held control."""
        self._here.discard(client)
        if self._holder != client:
            return False
        self._free()
        return True

    def refusal(self, client: str, *, at_rest: bool) -> str | None:
        """Why an input of `client`'s is not taken, or None."""
        if self._holder == client:
            return None
        if self._holder is not None:
            return ELSEWHERE
        return None if at_rest else MOVES

    def take(self, client: str) -> None:
        """An input of `client`'s was taken: it holds control."""
        self._holder = client

    def request(self, client: str, *, at_rest: bool) -> str | None:
        """Ask for control outright: given at rest, whoever held it. The refusal, or None."""
        if self._holder != client and not at_rest:
            return MOVES
        self._holder = client
        self._asked = True
        return None

    def release(self, client: str, *, at_rest: bool) -> str | None:
        """Give control up. The refusal, or None; harmless for one who does not hold it."""
        if self._holder != client:
            return None
        if not at_rest:
            return MOVES
        self._free()
        return None

    def rested(self) -> None:
        """Nothing moves: what was held for one motion only is free."""
        if self._holder is not None and not self._asked and self._holder not in self._here:
            self._free()

    def _free(self) -> None:
        self._holder = None
        self._asked = False
