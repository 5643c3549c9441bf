"""What is wrong with a robot file, for the person who wrote it."""

from __future__ import annotations


class RobotFileError(ValueError):
    """A robot that cannot be loaded: the message names field, value, line and what is legal."""
