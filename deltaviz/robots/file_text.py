"""The text of a robot file, from what it holds."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import Any

_ARRAY = re.compile(r"\[\n((?:    [^\n]+,\n)+)\]")  # as tomli_w writes them, an entry a line


def file_text(data: dict[str, Any], notes: Sequence[str]) -> str:
    """TOML; `notes` are lines of comment at its head."""
    import tomli_w

    head = "".join(f"# {note}\n" for note in notes)
    return f"{head}{_ARRAY.sub(_in_one_line, tomli_w.dumps(data))}"


def _in_one_line(array: re.Match[str]) -> str:
    return f"[{', '.join(line.strip().rstrip(',') for line in array[1].splitlines())}]"
