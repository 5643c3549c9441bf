"""A page's view of the scene, as its socket tells it: what it may choose, and what it is told."""

from __future__ import annotations

import json
from dataclasses import asdict
from typing import Any

from deltaviz.scene import items
from deltaviz.scene.rows import ColourKey, Row


def view_json(shown: tuple[items.AnyItem, ...] | None) -> str:
    """None: the page has no view."""
    told = None if shown is None else [_item(item) for item in shown]
    return json.dumps({"type": "view", "items": told}, allow_nan=False)


def _item(item: items.AnyItem) -> dict[str, Any]:
    if isinstance(item, items.Readout):
        rows = [_row(row) for row in item.rows]
        return {"kind": item.kind, "key": item.key, "group": item.group, "rows": rows}
    return {"kind": item.kind, **asdict(item)}


def _row(row: Row | ColourKey) -> dict[str, Any]:
    kind = "colours" if isinstance(row, ColourKey) else "row"
    return {"kind": kind, **asdict(row)}
