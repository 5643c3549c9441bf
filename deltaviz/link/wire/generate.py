"""Writes the C codec: `python -m deltaviz.link.wire.generate [--check]`."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from deltaviz.link.wire.c_source import header, source
from deltaviz.link.wire.description import load_description

CORE = Path(__file__).parents[3] / "firmware" / "core"


def generated() -> dict[Path, str]:
    description = load_description()
    return {CORE / "messages.h": header(description), CORE / "messages.c": source(description)}


def stale() -> list[Path]:
    """The files that are not what they would be if they were written now."""
    return [
        path
        for path, text in generated().items()
        if not path.exists() or path.read_text(encoding="utf-8") != text
    ]


def main(arguments: list[str]) -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--check", action="store_true", help="only say what is out of date")
    if not parser.parse_args(arguments).check:
        for path, text in generated().items():
            path.write_text(text, encoding="utf-8")
        return 0
    for path in stale():
        print(f"{path} is out of date: run python -m deltaviz.link.wire.generate", file=sys.stderr)
    return 1 if stale() else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
