"""After a stop nothing resumes by itself, sliders included.

The values of a slider that is being pulled have no press of their own. Those of one client with
no pause between them are one pull; a pull that began before a stop is dead until it pauses.
"""

from __future__ import annotations

PAUSE = 0.4  # s; a slider under a hand sends every 50 ms


class FreshPress:
    def __init__(self) -> None:
        self._stopped = float("-inf")
        self._pulls: dict[str, tuple[float, float]] = {}  # client: began, last value

    def stopped(self, now: float) -> None:
        self._stopped = now

    def admits(self, client: str, now: float) -> bool:
        """Whether a value that came now belongs to a pull begun since the last stop."""
        began, last = self._pulls.get(client, (now, float("-inf")))
        if now - last >= PAUSE:
            began = now
        self._pulls[client] = (began, now)
        return began > self._stopped

    def forget(self, client: str) -> None:
        self._pulls.pop(client, None)
