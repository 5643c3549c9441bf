"""Where in a TOML file a key stands: tomllib tells values, not lines."""

from __future__ import annotations

import re

_HEADER = re.compile(r"^\s*\[\s*([^\[\]]+?)\s*\]\s*(#.*)?$")
_KEY = re.compile(r"""^\s*((?:[A-Za-z0-9_-]+|"[^"]*"|'[^']*')(?:\s*\.\s*[A-Za-z0-9_"'-]+)*)\s*=""")


def key_lines(text: str) -> dict[str, int]:
    """Dotted names of sections and keys ("limits.joint.velocity_deg_s") to 1-based lines."""
    lines: dict[str, int] = {}
    section = ""
    depth = 0  # of brackets that an earlier line left open: a value over several lines
    for number, line in enumerate(text.splitlines(), start=1):
        if depth == 0:
            header, key = _HEADER.match(line), _KEY.match(line)
            if header:
                section = _plain(header[1])
                lines.setdefault(section, number)
                continue
            if key:
                name = _plain(key[1])
                lines.setdefault(f"{section}.{name}" if section else name, number)
        code = re.sub(r"""("[^"]*"|'[^']*'|\#.*)""", "", line)
        opened, closed = len(re.findall(r"[\[{]", code)), len(re.findall(r"[\]}]", code))
        depth = max(0, depth + opened - closed)
    return lines


def line_of(lines: dict[str, int], field: str) -> int | None:
    """The line of a field, or of the nearest section that should hold it."""
    while field:
        if field in lines:
            return lines[field]
        field = field.rpartition(".")[0]
    return None


def _plain(name: str) -> str:
    return ".".join(part.strip().strip("\"'") for part in name.split("."))
