"""Malformed input, told in one sentence: which field, what was wrong, what would be right."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

_LONGEST_ECHO = 40  # characters of somebody's input that come back to them


def sentence(errors: Sequence[Mapping[str, Any]], *, tags: Iterable[str] = ()) -> str:
    """The first of pydantic's errors as a sentence. `tags` are path parts that name no field."""
    error = errors[0]
    field = _field([part for part in error["loc"] if part != "body" and part not in set(tags)])
    kind, message = error["type"], error["msg"]
    if kind == "json_invalid":
        return "This is no JSON that can be read."
    if kind in ("missing", "model_attributes_type", "model_type", "dict_type") and not field:
        return "A JSON object is needed here; see /docs."
    if kind == "missing":
        return f"{field} is missing."
    if kind == "extra_forbidden":
        return f"{field} is no field of this message; see /docs."
    if kind == "value_error":
        return f"{field + ': ' if field else ''}{error['ctx']['error']}."
    message = message.removeprefix("Input ").removeprefix("Value ").rstrip(".")
    return f"{field or 'The message'} {message}{_echo(error.get('input'))}."


def _field(path: Sequence[str | int]) -> str:
    text = ""
    for part in path:
        if isinstance(part, int):
            text += f"[{part}]"
        else:
            name = part if part.isidentifier() else repr(part)  # it may be anything
            text += f".{name}" if text else name
    return _short(text)


def _echo(value: Any) -> str:
    if isinstance(value, str | bool | int | float | None):
        return f"; got {_short(repr(value))}"
    return ""


def _short(text: str) -> str:
    return text if len(text) <= _LONGEST_ECHO else f"{text[:_LONGEST_ECHO]}..."
