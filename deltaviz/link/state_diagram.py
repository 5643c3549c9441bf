"""A transition table as a picture: what the docs show of every state machine."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Mapping
from enum import Enum
from typing import TypeVar

S = TypeVar("S", bound=Enum)
E = TypeVar("E", bound=Enum)


def mermaid(table: Mapping[tuple[S, E], S], *, first: S, anywhere: str) -> str:
    """`table` as a Mermaid state diagram that begins in `first`.

    An event that leads to one state from all others (or all but one) is drawn once, from a state
    called `anywhere`; events that leave a state as it is are left out.
    """
    states = list(type(first))
    shared: defaultdict[S, list[str]] = defaultdict(list)
    drawn: set[E] = set()
    for event in type(next(iter(table))[1]):
        if (found := _shared_by_all(table, states, event)) is not None:
            target, label = found
            shared[target].append(label)
            drawn.add(event)
    names = [*([anywhere] if shared else []), *map(_name, states)]
    lines = [f'    state "{name}" as {_id(name)}' for name in names if _id(name) != name]
    lines.append(f"    [*] --> {_id(_name(first))}")
    lines += [_arrow(anywhere, _name(target), labels) for target, labels in shared.items()]
    for state in states:
        by_target: defaultdict[S, list[str]] = defaultdict(list)
        for (at, event), target in table.items():
            if at is state and target is not state and event not in drawn:
                by_target[target].append(str(event.value))
        lines += [_arrow(_name(state), _name(to), labels) for to, labels in by_target.items()]
    return "\n".join(["stateDiagram-v2", *lines])


def _arrow(start: str, end: str, labels: list[str]) -> str:
    return f"    {_id(start)} --> {_id(end)}: {' / '.join(labels)}"


def _shared_by_all(
    table: Mapping[tuple[S, E], S], states: list[S], event: E
) -> tuple[S, str] | None:
    """Where `event` leads from all states or all but one, with its label."""
    leads = {state: table[state, event] for state in states if (state, event) in table}
    targets = {target for state, target in leads.items() if target is not state}
    if len(targets) != 1:
        return None
    (target,) = targets
    others = [s for s in states if leads.get(s) is not target and s is not target]
    if len(others) > 1:
        return None
    label = str(event.value)
    return target, f"{label} (not {_name(others[0])})" if others else label


def _name(state: Enum) -> str:
    """What people call it: a text's own, a number's name."""
    return state.value if isinstance(state.value, str) else state.name


def _id(name: str) -> str:
    return name.replace(" ", "_").replace("-", "_")
