"""The board's states as a picture, drawn from the table that it runs."""

from __future__ import annotations

from collections import defaultdict

from deltaviz.link.board.states import TRANSITIONS, BoardEvent
from deltaviz.link.messages import BoardState


def mermaid() -> str:
    """The table as a Mermaid state diagram. The e-stop is drawn once; what leaves a state as it is,
    is left out.
    """
    labels: defaultdict[tuple[BoardState, BoardState], list[str]] = defaultdict(list)
    for (state, event), after in TRANSITIONS.items():
        if after is not state and event is not BoardEvent.ESTOP:
            labels[state, after].append(event.value)
    lines = ["stateDiagram-v2", '    state "any state" as any_state', "    [*] --> DISABLED"]
    lines.append(f"    any_state --> {BoardState.ESTOP.name}: {BoardEvent.ESTOP.value}")
    for (state, after), events in labels.items():
        lines.append(f"    {state.name} --> {after.name}: {' / '.join(events)}")
    return "\n".join(lines)
