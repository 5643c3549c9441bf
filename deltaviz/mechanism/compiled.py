"""How the control loop's functions are compiled."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, ParamSpec, TypeVar

import numba

_P = ParamSpec("_P")
_R = TypeVar("_R")
_jit: Any = numba.njit  # pyright: ignore  (numba has no types)


def compiled(function: Callable[_P, _R]) -> Callable[_P, _R]:
    """Compiled at its first call; a division by zero gives inf or NaN, as in numpy.

    The batch functions are cached, in the package's folder or else in the user's; where neither
    can be written they are compiled anew by each process.
    """
    if not function.__name__.startswith("_"):
        try:
            return _jit(cache=True, error_model="numpy")(function)
        except RuntimeError:  # numba found no folder for its cache
            pass
    return _jit(error_model="numpy")(function)


def compiled_loop(function: Callable[_P, _R]) -> Callable[_P, _R]:
    """As `compiled`, for loops over many poses: products and sums are fused, so that the loop
    becomes short vector instructions, and other threads run meanwhile."""
    options: dict[str, Any] = {"error_model": "numpy", "fastmath": {"contract"}, "nogil": True}
    if not function.__name__.startswith("_"):
        try:
            return _jit(cache=True, **options)(function)
        except RuntimeError:
            pass
    return _jit(**options, forceinline=function.__name__.startswith("_"))(function)
