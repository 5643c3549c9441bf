"""A hand that drags the effector in a real page, and grabs it again when a drag breaks off.

A page that cannot keep up with drawing breaks its own drag off, and rightly: software that draws
four scenes on two cores does that.
"""

from __future__ import annotations

import time

from playwright.sync_api import Page

from benchmarks.served import Served
from deltaviz.machine.mode import Mode

PATIENCE = 60.0  # s
PANEL = 288  # pixels of viser's panel, left of the robot


class Hand:
    """Use as a context: lets go at its end."""

    def __init__(self, page: Page, running: Served) -> None:
        self._page = page
        self._machine = running.machine
        self._at = (0.0, 0.0)

    def __enter__(self) -> Hand:
        self.hold()
        return self

    def __exit__(self, *_: object) -> None:
        self._page.mouse.up()

    @property
    def holding(self) -> bool:
        return self._machine.snapshot.mode is Mode.JOGGING

    def hold(self) -> None:
        """Grab the effector unless it is held: down the robot's axis until a press drags."""
        if self.holding:
            return
        box = self._page.locator("#scene").bounding_box()
        assert box is not None
        x = box["x"] + (box["width"] + PANEL) / 2
        end = time.monotonic() + PATIENCE
        while time.monotonic() < end:
            for y in range(int(box["y"] + box["height"]) - 40, int(box["y"]), -12):
                if self._grab(x, y):
                    return
        raise SystemExit("no drag handle found")

    def move(self, dx: float, dy: float) -> None:
        """To a place beside the one that was grabbed, pixels."""
        self._page.mouse.move(self._at[0] + dx, self._at[1] + dy)

    def _grab(self, x: float, y: float) -> bool:
        self._page.mouse.up()
        self._page.mouse.move(x, y)
        self._page.mouse.down()
        self._page.mouse.move(x + 4, y)
        for _ in range(6):
            self._page.wait_for_timeout(50)
            if self.holding:
                self._at = (x, y)
                return True
        return False
