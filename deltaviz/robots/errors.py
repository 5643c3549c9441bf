"""What is wrong with a robot file, for the person who wrote it."""

from __future__ import annotations


class RobotFileError(ValueError):
    """A robot that cannot be loaded: the message names field, value, line and what is legal."""


class Inconsistent(ValueError):
    """A field that contradicts another; `rule` says what would be legal."""

    def __init__(self, field: str, value: object, rule: str) -> None:
        super().__init__(f"{field} = {value}: {rule}")
        self.field = field
        self.value = value
        self.rule = rule


class Faulty(ValueError):
    """The numbers of a robot file that make no robot; the text is that of its first problem."""

    def __init__(self, problems: list[tuple[str, str]]) -> None:
        super().__init__(problems[0][1])
        self.problems = problems
        """(field, what is wrong with it) of each."""
