"""A user without a folder of one's own, as a system service has: nothing compiled is kept."""

from __future__ import annotations

import subprocess
import sys

WITHOUT_FOLDERS = """
from numba.core import caching
caching.CacheImpl._locator_classes = []
import deltaviz.machine.process
from deltaviz.motion.check_compiled import lowest
"""


def test_the_controller_is_loaded_without_a_folder_for_what_is_compiled() -> None:
    command = [sys.executable, "-c", WITHOUT_FOLDERS]
    done = subprocess.run(command, capture_output=True, text=True)
    assert (done.returncode, done.stderr) == (0, "")
