"""What can be wrong with bytes and messages, split into ours and the peer's."""

from __future__ import annotations


class Unsendable(ValueError):
    """Ours: a message with values that its fields cannot carry."""


class Malformed(Exception):
    """The peer's: a payload that is no message of its type."""
