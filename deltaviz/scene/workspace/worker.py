"""A computing process as the scene sees it: started when first needed, again when it broke."""

from __future__ import annotations

import subprocess
import sys
import threading
from collections.abc import Callable
from typing import BinaryIO, cast

from deltaviz.scene.workspace.orders import Key, Order, Reply, read, write
from deltaviz.scene.workspace.pictures import Failed
from deltaviz.scene.workspace.tasks import Task

_ENDED = Failed("The process that computes the workspace has ended; change something to try again.")


class Worker:
    """`order` never waits. `take` is called in a thread of the worker's."""

    def __init__(self, take: Callable[[Reply], None]) -> None:
        self._take = take
        self._lock = threading.Condition()
        self._waiting: dict[Key, Order] = {}
        self._numbers: dict[Key, int] = {}
        self._process: subprocess.Popen[bytes] | None = None
        self._closed = False

    def order(self, key: Key, task: Task | None) -> None:
        """Compute this, and nothing any more that was ordered by the same key before."""
        with self._lock:
            if self._closed or (task is None and key not in self._numbers):
                return
            number = self._numbers[key] = self._numbers.get(key, 0) + 1
            self._waiting[key] = Order(key, number, task)
            if self._process is None:
                self._start()
            self._lock.notify_all()

    @property
    def pid(self) -> int | None:
        process = self._process
        return None if process is None else process.pid

    def close(self) -> None:
        with self._lock:
            self._closed = True
            process = self._process
            self._lock.notify_all()
        if process is not None:
            process.kill()
            process.wait()

    def _start(self) -> None:
        command = [sys.executable, "-m", "deltaviz.scene.workspace.process"]
        process = self._process = subprocess.Popen(
            command, stdin=subprocess.PIPE, stdout=subprocess.PIPE
        )
        for run in (self._write, self._read):
            threading.Thread(target=run, args=(process,), name="workspace", daemon=True).start()

    def _write(self, process: subprocess.Popen[bytes]) -> None:
        while True:
            with self._lock:
                while not self._waiting and self._process is process and not self._closed:
                    self._lock.wait()
                if self._process is not process or self._closed:
                    return
                orders = list(self._waiting.values())
                self._waiting.clear()
            try:
                for order in orders:
                    write(cast(BinaryIO, process.stdin), order)
            except OSError:
                return

    def _read(self, process: subprocess.Popen[bytes]) -> None:
        try:
            while True:
                reply = read(cast(BinaryIO, process.stdout))
                assert isinstance(reply, Reply)
                if self._is_newest(reply):
                    self._take(reply)
        except (EOFError, OSError, ValueError):
            self._ended(process)

    def _is_newest(self, reply: Reply) -> bool:
        with self._lock:
            return self._numbers.get(reply.key) == reply.number

    def _ended(self, process: subprocess.Popen[bytes]) -> None:
        process.wait()
        with self._lock:
            self._process = None
            lost = [] if self._closed else list(self._numbers.items())
            self._lock.notify_all()
        for key, number in lost:
            self._take(Reply(key, number, _ENDED))
