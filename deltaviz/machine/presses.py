"""Everything that a hand holds: jogs, drags and pulled sliders, with their dead-man leases."""

from __future__ import annotations

from deltaviz.machine import intent as i
from deltaviz.machine.fresh_press import FreshPress
from deltaviz.machine.jog_lease import LEASE, DragLease, JogLease, PageClocks


class Presses:
    """At most one jog or drag is held at a time."""

    def __init__(self) -> None:
        self._clocks = PageClocks()
        self.jog = JogLease(self._clocks)
        self.drag = DragLease(self._clocks)
        self._fresh = FreshPress()

    @property
    def held(self) -> bool:
        return self.jog.live or self.drag.live

    def begin(self, intent: i.JogStart | i.DragStart, now: float) -> str | None:
        """A new press, which ends the one before. The refusal, or None."""
        if isinstance(intent, i.DragStart):
            refused = self.drag.begin(intent.client, at=intent.at, now=now)
            if refused is None:
                self.jog.end()
            return refused
        refused = self.jog.begin(intent.client, intent.id, at=intent.at, now=now)
        if refused is None:
            self.drag.end()
        return refused

    def admits_value(self, client: str, now: float) -> bool:
        """Whether a slider's value belongs to a pull begun since the last stop."""
        return self._fresh.admits(client, now)

    def jog_beat(self, beat: i.JogBeat) -> bool:
        return self.jog.beat(
            beat.client,
            beat.id,
            seq=beat.seq,
            sent_ms=beat.sent_ms,
            clock=beat.clock,
            at=beat.at,
        )

    def drag_alive(self, alive: i.DragAlive) -> None:
        self.drag.alive(alive.client, sent_ms=alive.sent_ms, clock=alive.clock, at=alive.at)

    def lost(self, now: float) -> str | None:
        """Why the robot must stop, when the page behind a press has fallen silent."""
        if not (self.jog.expired(now) or self.drag.expired(now)):
            return None
        what = "jog" if self.jog.live else "drag"
        return f"The {what} broke off: the page gave no sign of life for {LEASE * 1000:.0f} ms."

    def stopped(self, now: float) -> None:
        """Every press is over; a fresh one is needed."""
        self.jog.end()
        self.drag.end()
        self._fresh.stopped(now)

    def arrived(self, client: str) -> None:
        """A page was loaded: its clock is a new one."""
        self._clocks.forget(client)

    def forget(self, client: str) -> None:
        self._clocks.forget(client)
        self.drag.forget(client)
        self._fresh.forget(client)
