"""Compile a loop over poses to machine code, once; the result is cached on disk."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, ParamSpec, TypeVar

import numba

_njit: Any = numba.njit  # pyright: ignore  (numba has no types)

P = ParamSpec("P")
R = TypeVar("R")


def compiled(function: Callable[P, R]) -> Callable[P, R]:
    """The same function, compiled at its first call."""
    return _njit(cache=True, error_model="numpy")(function)
