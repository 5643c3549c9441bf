"""Checks of the numbers that a mechanism is built from."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import cast


class GeometryError(ValueError):
    """A length or an angle that no mechanism can have; says which, its value and the rule."""

    def __init__(self, field: str, value: object, rule: str) -> None:
        super().__init__(f"{field} = {value}: {rule}")
        self.field = field
        self.value = value
        self.rule = rule


def per_arm(
    field: str,
    value: float | Sequence[float],
    *,
    arms: int,
    above: float | None = None,
    least: float | None = None,
) -> tuple[float, ...]:
    """One number per arm from one number for all or one for each.

    Raises GeometryError unless each is finite, greater than `above` and at least `least`.
    """
    numbers = _numbers(field, value, arms)
    for number in numbers:
        if not math.isfinite(number):
            raise GeometryError(field, value, "must be finite")
        if above is not None and not number > above:
            raise GeometryError(field, value, f"must be greater than {above:g}")
        if least is not None and not number >= least:
            raise GeometryError(field, value, f"must be at least {least:g}")
    return numbers


def _numbers(field: str, value: object, arms: int) -> tuple[float, ...]:
    rule = f"must be one number, or {arms} (one per arm)"
    if isinstance(value, str | bytes | bool):
        raise GeometryError(field, repr(value), rule)
    try:
        return (float(cast(float, value)),) * arms
    except (TypeError, ValueError):
        pass
    try:
        numbers = tuple(float(number) for number in cast(Sequence[float], value))
    except (TypeError, ValueError):
        raise GeometryError(field, repr(value), rule) from None
    if len(numbers) != arms:
        raise GeometryError(field, value, rule)
    return numbers
