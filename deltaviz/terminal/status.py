"""How a command ends."""

from __future__ import annotations

OK, FAILED, BAD_USAGE = 0, 1, 2  # done; it could not be done; the arguments are wrong


class UsageError(Exception):
    """A wrong argument; the text says which, and what would be right."""
