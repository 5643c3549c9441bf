"""A picture is there all the time while others take its place."""

from __future__ import annotations

import asyncio
from typing import Any

from deltaviz.scene.workspace.relay import STAYS, Relay


class Node:
    def __init__(self, there: list[Node], name: str) -> None:
        self._there, self.name = there, name
        there[:] = [node for node in there if node.name != name]  # as viser does
        there.append(self)

    def remove(self) -> None:
        if self in self._there:
            self._there.remove(self)


class Loop(asyncio.SelectorEventLoop):
    """Whose time passes when a test says so."""

    now = 0.0

    def time(self) -> float:
        return self.now


def test_the_one_before_stays_beside_the_newest_for_a_moment() -> None:
    there: list[Node] = []
    loop = Loop()

    def add(name: str) -> Any:
        assert name not in [node.name for node in there[-1:]], "what is looked at must stay"
        return Node(there, name)

    async def turn(seconds: float = 0.0) -> None:
        loop.now += seconds
        await asyncio.sleep(0)
        await asyncio.sleep(0)

    async def story() -> None:
        relay = Relay("/picture")
        relay.show(add)
        for _ in range(5):
            relay.show(add)
            await turn(STAYS / 3)
            assert len(there) == 2
        newest = there[-1]
        await turn(STAYS)
        assert there == [newest]
        relay.show(add)
        relay.remove()
        assert there == []

    try:
        loop.run_until_complete(story())
    finally:
        loop.close()
