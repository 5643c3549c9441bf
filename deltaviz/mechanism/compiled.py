"""How the control loop's functions are compiled."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, ParamSpec, TypeVar

import numba
from numba.core import codegen, config

_P = ParamSpec("_P")
_R = TypeVar("_R")
_jit: Any = numba.njit  # pyright: ignore  (numba has no types)
_config: Any = config  # which gets its attributes at run time


def _features() -> str:
    """This processor's; with AVX-512, the compiler shall use the whole width of its registers.

    By itself it keeps to half of them, for the sake of code in which a few wide instructions would
    lower the clock for all others. The batch loops are nothing but such instructions, and are a
    fifth to a quarter faster for it.
    """
    features = codegen.get_host_cpu_features()
    wide = "+avx512f" in features.split(",")
    return f"{features},-prefer-256-bit" if wide else features


if _config.CPU_FEATURES is None:  # numba reads it when it compiles the first function
    _config.CPU_FEATURES = _features()


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
