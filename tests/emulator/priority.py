"""An emulated board is a computer of its own: what the host's has to do makes it no slower."""

from __future__ import annotations

import contextlib
import os
from collections.abc import Iterator


@contextlib.contextmanager
def coming_first() -> Iterator[None]:
    """This thread, and the processes that it starts, run before all others, where that is allowed.

    A nice value would not do: Linux shares a processor between sessions first, and lets a thread
    that works little, in a session that works much elsewhere, wait for a second.
    """
    with contextlib.suppress(OSError, AttributeError):  # not everywhere, nor for everyone
        os.sched_setscheduler(0, os.SCHED_RR, os.sched_param(1))
    try:
        yield
    finally:
        with contextlib.suppress(OSError, AttributeError):
            os.sched_setscheduler(0, os.SCHED_OTHER, os.sched_param(0))
