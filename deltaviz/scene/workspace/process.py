"""A process that computes: orders come on stdin, pictures go to stdout.

The newest order of each key counts. One that comes while its predecessor is computed ends that at
once. At the end of stdin the process is gone. It is nice to others: a robot may be driven on the
same processor.
"""

from __future__ import annotations

import _thread
import os
import signal
import sys
import threading
from types import FrameType
from typing import BinaryIO

from deltaviz.scene.workspace.orders import Key, Order, Reply, read, write
from deltaviz.scene.workspace.pictures import Failed, Picture

NICE = 10


class _Superseded(BaseException):
    """Raised in the midst of a computation."""


class Process:
    def __init__(self, orders: BinaryIO, replies: BinaryIO) -> None:
        self._in, self._out = orders, replies
        self._wanted: dict[Key, Order] = {}
        self._some = threading.Condition()
        self._computing: Key | None = None  # of the main thread alone

    def run(self) -> None:
        """Never returns; the end of the orders ends the process."""
        signal.signal(signal.SIGINT, self._interrupt)
        threading.Thread(target=self._read, daemon=True).start()
        while True:
            with self._some:
                while not self._wanted:
                    self._some.wait()
                order = self._wanted.pop(next(iter(self._wanted)))
            self._obey(order)

    def _read(self) -> None:
        try:
            while True:
                order = read(self._in)
                assert isinstance(order, Order)
                with self._some:
                    self._wanted[order.key] = order
                    self._some.notify()
                if self._computing == order.key:
                    _thread.interrupt_main()
        finally:
            os._exit(0)

    def _interrupt(self, number: int, frame: FrameType | None) -> None:
        if self._computing is not None and self._computing in self._wanted:
            raise _Superseded

    def _obey(self, order: Order) -> None:
        if order.task is None:
            return
        try:
            pictures = order.task.pictures()
            while (picture := self._next(order.key, pictures)) is not None:
                write(self._out, Reply(order.key, order.number, picture))
        except _Superseded:
            return
        except Exception as error:
            text = f"The workspace could not be computed: {error}"
            write(self._out, Reply(order.key, order.number, Failed(text)))

    def _next(self, key: Key, pictures: object) -> Picture | None:
        """Only here may a computation be broken off: a reply is written whole."""
        try:
            self._computing = key
            if key in self._wanted:
                raise _Superseded
            return next(pictures, None)  # type: ignore[call-overload]
        finally:
            self._computing = None


def main() -> None:
    os.nice(NICE)
    replies = os.fdopen(os.dup(sys.stdout.fileno()), "wb")
    os.dup2(sys.stderr.fileno(), sys.stdout.fileno())  # whatever prints does not garble them
    Process(sys.stdin.buffer, replies).run()


if __name__ == "__main__":
    main()
