"""A page's view of the scene, as its socket tells it: what it may choose, and what it is told."""

from __future__ import annotations

import json
from dataclasses import fields
from typing import Any

from deltaviz.scene.items import AnyItem
from deltaviz.scene.rows import ColourKey, Row


def view_json(shown: tuple[AnyItem, ...] | None) -> str:
    """None: the page has no view."""
    return json.dumps({"type": "view", "items": shown}, default=_with_kind, allow_nan=False)


def _with_kind(told: AnyItem | Row | ColourKey) -> dict[str, Any]:
    return {"kind": told.kind} | {field.name: getattr(told, field.name) for field in fields(told)}
