"""The numbers that host and board agree on. Times are in milliseconds of board time."""

from __future__ import annotations

TICK_HZ = 200_000
TICK_HZ_MIN = 20_000  # of a board that moves; with fewer its processor is too slow for motion
LEASE_MS = 150  # after the telemetry tick that the host saw
SEGMENT_MIN_MS = 4
SEGMENT_MAX_MS = 50
LATE_MS = 150  # how old the start of a motion may be
AHEAD_MS = 100  # how far ahead the start of a motion may lie
TELEMETRY_MS = 5
QUEUE_PLACES = 64  # the longest horizon, 500 ms, in segments of 10 ms, and some


def since(tick: int, origin: int) -> int:
    """Ticks from `origin` to `tick` on the wrapping counter, in [-2^31, 2^31)."""
    return ((tick - origin + 0x8000_0000) & 0xFFFF_FFFF) - 0x8000_0000


def since16(number: int, origin: int) -> int:
    """The same for epochs and indices, in [-2^15, 2^15)."""
    return ((number - origin + 0x8000) & 0xFFFF) - 0x8000
