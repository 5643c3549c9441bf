"""Writes into the docs what the code says: each block between its two markers.

python docs/generate.py          write
python docs/generate.py --check  status 1 and the names of the pages that are not today's
"""

from __future__ import annotations

import re
import sys
from collections.abc import Callable
from pathlib import Path

DOCS = Path(__file__).parent


def machine_states() -> str:
    from deltaviz.machine.diagram import mermaid

    return f"```mermaid\n{mermaid()}\n```"


def board_states() -> str:
    from deltaviz.link.board.diagram import mermaid

    return f"```mermaid\n{mermaid()}\n```"


BLOCKS: dict[str, Callable[[], str]] = {
    "machine-states": machine_states,
    "board-states": board_states,
}


def fill(text: str) -> str:
    """`text` with the content of every marked block made anew."""

    def block(match: re.Match[str]) -> str:
        return f"{match[1]}\n{BLOCKS[match[2]]().strip()}\n{match[3]}"

    return re.sub(r"(<!-- made: ([\w-]+) -->).*?(<!-- end -->)", block, text, flags=re.DOTALL)


def main() -> int:
    stale = [
        page for page in sorted(DOCS.glob("*.md")) if fill(page.read_text()) != page.read_text()
    ]
    if "--check" in sys.argv:
        for page in stale:
            print(f"{page} is not today's; run: python docs/generate.py")
        return 1 if stale else 0
    for page in stale:
        page.write_text(fill(page.read_text()))
    return 0


if __name__ == "__main__":
    sys.exit(main())
