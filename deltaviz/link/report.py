"""How a link is doing, in numbers."""

from __future__ import annotations

from dataclasses import dataclass, field

from deltaviz.link.impression import Impression


@dataclass(frozen=True, slots=True)
class LinkReport:
    """`round_trip` (s) is that of the newest command that was answered at once."""

    dropped: int = 0  # frames that arrived and were no messages
    repeated: int = 0  # commands that were sent again
    round_trip: float | None = None
    impression: Impression = field(default_factory=Impression)
