"""The state machine as a picture, drawn from the table that the controller runs."""

from __future__ import annotations

from collections import defaultdict

from deltaviz.machine.mode import Mode
from deltaviz.machine.transitions import TABLE, Event


def mermaid() -> str:
    """The table as a Mermaid state diagram.

    An event that leads to one mode from all others (or all but one) is drawn once, from
    "any mode"; events that leave a mode as it is are left out.
    """
    lines = ["stateDiagram-v2", '    state "any mode" as any_mode', "    [*] --> offline"]
    drawn: set[Event] = set()
    shared: defaultdict[Mode, list[str]] = defaultdict(list)
    for event in Event:
        if (found := _shared_by_all(event)) is not None:
            target, label = found
            shared[target].append(label)
            drawn.add(event)
    lines += [f"    any_mode --> {mode}: {', '.join(labels)}" for mode, labels in shared.items()]
    for mode, row in TABLE.items():
        by_target: defaultdict[Mode, list[str]] = defaultdict(list)
        for event, target in row.items():
            if target is not mode and event not in drawn:
                by_target[target].append(event.value)
        lines += [f"    {mode} --> {to}: {', '.join(events)}" for to, events in by_target.items()]
    return "\n".join(lines)


def _shared_by_all(event: Event) -> tuple[Mode, str] | None:
    """Where `event` leads from all modes or all but one, with its label."""
    targets = {row[event] for mode, row in TABLE.items() if row.get(event, mode) is not mode}
    if len(targets) != 1:
        return None
    target = targets.pop()
    others = [mode for mode, row in TABLE.items() if row.get(event) is not target]
    others = [mode for mode in others if mode is not target]
    if len(others) > 1:
        return None
    return target, f"{event.value} (not {others[0]})" if others else event.value
