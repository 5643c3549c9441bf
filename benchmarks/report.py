"""A measurement as a Markdown table, and the machine it was made on."""

from __future__ import annotations

import os
import platform
import statistics
from collections.abc import Sequence
from dataclasses import dataclass, field


@dataclass
class Table:
    """Rows of text under a heading; `notes` say how it was measured."""

    title: str
    header: Sequence[str]
    notes: str = ""
    rows: list[Sequence[str]] = field(default_factory=list)

    def add(self, *cells: str) -> None:
        self.rows.append(cells)

    def __str__(self) -> str:
        lines = [f"## {self.title}", ""]
        if self.notes:
            lines += [self.notes, ""]
        lines += [
            f"| {' | '.join(self.header)} |",
            f"| {' | '.join('---' for _ in self.header)} |",
            *(f"| {' | '.join(row)} |" for row in self.rows),
        ]
        return "\n".join(lines)


def quantile(values: Sequence[float], share: float) -> float:
    """The smallest value that at least `share` of all do not exceed."""
    ordered = sorted(values)
    return ordered[min(len(ordered) - 1, int(share * len(ordered)))]


def spread(values: Sequence[float], *, scale: float = 1e3) -> tuple[str, str, str]:
    """p50, p99 and worst as text; by default seconds to ms."""
    return tuple(
        f"{scale * v:.2f}" for v in (statistics.median(values), quantile(values, 0.99), max(values))
    )  # pyright: ignore[reportReturnType]


def machine() -> str:
    model = "processor unknown"
    if os.path.exists("/proc/cpuinfo"):
        with open("/proc/cpuinfo") as cpuinfo:
            names = [line.split(":", 1)[1].strip() for line in cpuinfo if "model name" in line]
            model = names[0] if names else model
    return f"{os.cpu_count()} cores ({model}), Python {platform.python_version()}"
