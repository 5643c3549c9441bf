"""What passes between the scene and a computing process, and how it is written."""

from __future__ import annotations

import pickle
from collections.abc import Callable
from dataclasses import dataclass
from typing import BinaryIO

from deltaviz.scene.workspace.pictures import Picture
from deltaviz.scene.workspace.tasks import Task

Key = tuple[int, str]
"""Whose it is (a browser's number) and what: a newer order takes the place of one alike."""

Send = Callable[[Key, Task | None], None]
Topical = Callable[[str, Task | None], None]
"""The same for one browser, by the topic alone."""


@dataclass(frozen=True)
class Order:
    """`task` None: what was ordered is not wanted any more."""

    key: Key
    number: int
    task: Task | None


@dataclass(frozen=True)
class Reply:
    key: Key
    number: int
    picture: Picture


def write(stream: BinaryIO, value: Order | Reply) -> None:
    pickle.dump(value, stream, protocol=pickle.HIGHEST_PROTOCOL)
    stream.flush()


def read(stream: BinaryIO) -> Order | Reply:
    """Only ever from a process of our own. Raises EOFError at its end."""
    return pickle.load(stream)
