"""A file beside those that are there: none is written over."""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path

_MOST = 99  # of one name


def save_new(folder: Path, name: str, text: Callable[[str], str]) -> Path:
    """Write `text(stem)` to the first of NAME-2.toml, NAME-3.toml, .. that is not there.

    Raises OSError, FileExistsError if all are there.
    """
    plain = re.sub(r"[^A-Za-z0-9_-]+", "-", name).strip("-")[:48] or "robot"
    for number in range(2, _MOST + 1):
        path = folder / f"{plain}-{number}.toml"
        if path.exists():
            continue
        content = text(path.stem)
        try:
            with path.open("x", encoding="utf-8") as file:
                file.write(content)
        except FileExistsError:  # by somebody else, just now
            continue
        return path
    raise FileExistsError(f"{plain}-2.toml to {plain}-{_MOST}.toml are all there; remove some")
