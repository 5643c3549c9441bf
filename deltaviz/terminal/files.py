"""Files that a person wants written."""

from __future__ import annotations

from pathlib import Path


def unwritable(path: Path) -> str | None:
    """Why a file cannot be written; it is left as it was."""
    was_there = path.exists()
    try:
        path.open("a").close()
        if not was_there:
            path.unlink()
    except OSError as error:
        return error.strerror or str(error)
    return None


def first_unwritable(files: dict[str, str | None]) -> str | None:
    """Of options with their files, what is wrong with the first that cannot be written."""
    for option, path in files.items():
        why = None if path is None else unwritable(Path(path))
        if why is not None:
            return f"{option} {path}: {why}"
    return None
