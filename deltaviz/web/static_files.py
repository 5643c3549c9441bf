"""Where the console's files are: in the installed package, or beside it in a checkout."""

from __future__ import annotations

from pathlib import Path


def static_dir() -> Path:
    """The folder of the console. Raises FileNotFoundError when it is not installed."""
    package = Path(__file__).parents[1]
    for folder in (package / "_static", package.parent / "static"):
        if (folder / "index.html").is_file():
            return folder
    raise FileNotFoundError("the page's files are not installed; install deltaviz again")
