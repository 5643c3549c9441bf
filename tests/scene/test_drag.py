"""From pointer events to intents, without a browser: events as viser makes them."""

from __future__ import annotations

import asyncio
import dataclasses
from collections.abc import Iterator
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from deltaviz.machine.intent import DragEnd, DragStart, DragTo
from deltaviz.scene import rotations
from deltaviz.scene.drag import Dragging
from deltaviz.scene.listener import SESSION
from deltaviz.scene.pointer import Eye
from deltaviz.scene.units import metres

AHEAD = np.array((0.0, 0.0, -0.33))


class Hand:
    """A pointer over a picture, and the clock on the wall."""

    def __init__(self, machine: Any) -> None:
        self.machine = machine
        self.now = 100.0
        self.told: list[tuple[str, str]] = []
        self.dragging = Dragging(
            machine, lambda session, text: self.told.append((session, text)), lambda: self.now
        )
        # From the south and above, 45 degrees down.
        turn = rotations.about(0, -np.radians(135.0))
        self.eye = Eye(position=np.array((0.0, -1.0, 0.67)), wxyz=turn, fov=0.7, aspect=1.0)
        self.grabbed = AHEAD

    def event(self, phase: str, point: np.ndarray, *, client_id: int = 1) -> Any:
        camera = SimpleNamespace(**vars(self.eye))
        return SimpleNamespace(
            client=SimpleNamespace(camera=camera),
            client_id=client_id,
            phase=phase,
            start_position=tuple(self.grabbed),
            end_screen_pos=self.eye.project(point),
        )

    def does(
        self, phase: str, point: np.ndarray = AHEAD, *, shift: bool = False, client_id: int = 1
    ) -> None:
        handler = self.dragging.on_vertical if shift else self.dragging.on_plane
        asyncio.run(handler(self.event(phase, point, client_id=client_id)))


@pytest.fixture
def hand(machine: Any) -> Iterator[Hand]:
    machine.be_at((0.0, 0.0, -330.0))
    token = SESSION.set("anna")
    yield Hand(machine)
    SESSION.reset(token)


@pytest.fixture
def machine(stand_in: Any) -> Any:
    return stand_in


def test_the_eye_of_these_tests_looks_at_the_robot(hand: Hand) -> None:
    assert hand.eye.project(AHEAD) == pytest.approx((0.5, 0.5))


def test_a_drag_is_a_start_the_places_and_an_end(hand: Hand) -> None:
    hand.does("start")
    hand.does("update", AHEAD + np.array((0.01, 0.02, 0.0)))
    hand.does("end", AHEAD + np.array((0.03, 0.02, 0.0)))
    start, first, last, end = hand.machine.posted
    assert start == DragStart(client="anna", at=100.0)
    assert isinstance(first, DragTo)
    assert first.xyz == pytest.approx((10.0, 20.0, -330.0))
    assert last.xyz == pytest.approx((30.0, 20.0, -330.0))  # the last value always arrives
    assert end == DragEnd(client="anna")


def test_what_was_grabbed_beside_the_tip_stays_under_the_pointer(hand: Hand) -> None:
    hand.grabbed = AHEAD + np.array((0.05, -0.03, 0.01))
    hand.does("start", hand.grabbed)
    hand.does("update", hand.grabbed)
    hand.does("update", hand.grabbed + np.array((0.02, 0.0, 0.0)))
    stayed, moved = hand.machine.of(DragTo)
    assert stayed.xyz == pytest.approx((0.0, 0.0, -330.0))  # no jump
    assert moved.xyz == pytest.approx((20.0, 0.0, -330.0))


def test_shift_moves_up_and_down(hand: Hand) -> None:
    hand.does("start", shift=True)
    hand.does("update", AHEAD + np.array((0.0, 0.0, 0.05)), shift=True)
    (up,) = hand.machine.of(DragTo)
    assert up.xyz == pytest.approx((0.0, 0.0, -280.0))


def test_pressing_shift_goes_on_from_the_target_not_from_the_lagging_robot(hand: Hand) -> None:
    hand.machine.follows = False  # the robot has not moved at all yet
    aside = AHEAD + np.array((0.06, 0.0, 0.0))
    hand.does("start")
    hand.does("end", aside)
    hand.now += 0.1
    hand.does("start", aside, shift=True)
    hand.does("update", aside + np.array((0.0, 0.0, 0.04)), shift=True)
    assert hand.machine.of(DragTo)[-1].xyz == pytest.approx((60.0, 0.0, -290.0))


def test_a_new_grab_later_is_a_new_drag(hand: Hand) -> None:
    hand.machine.follows = False
    hand.does("start")
    hand.does("end", AHEAD + np.array((0.06, 0.0, 0.0)))
    hand.now += 1.0
    hand.does("start")
    hand.does("update")
    assert hand.machine.of(DragTo)[-1].xyz == pytest.approx((0.0, 0.0, -330.0))


def test_lost_control_ends_the_drag(hand: Hand) -> None:
    hand.does("start")
    hand.machine.be_held_by("boris")
    hand.dragging.end_lost(hand.machine.snapshot)
    hand.does("update", AHEAD + np.array((0.05, 0.0, 0.0)))
    hand.does("end", AHEAD + np.array((0.05, 0.0, 0.0)))
    assert [type(intent) for intent in hand.machine.posted] == [DragStart, DragEnd]


def test_control_that_is_still_ours_ends_nothing(hand: Hand) -> None:
    hand.does("start")
    hand.machine.be_held_by("anna")
    hand.dragging.end_lost(hand.machine.snapshot)
    hand.does("update")
    assert len(hand.machine.of(DragTo)) == 1


def test_a_refused_drag_is_over_until_the_next_press(hand: Hand) -> None:
    hand.machine.refusal = "The robot is disabled. Press Enable."
    hand.does("start")
    hand.does("update")
    hand.does("end")
    assert hand.told == [("anna", "The robot is disabled. Press Enable.")]
    assert len(hand.machine.posted) == 1
    hand.machine.refusal = None
    hand.does("start")
    hand.does("update")
    assert len(hand.machine.of(DragTo)) == 1


def test_a_stop_in_the_middle_is_not_dragged_over(hand: Hand) -> None:
    hand.does("start")
    hand.does("update")
    hand.machine.refusal = "Stopped. Press again to go on."
    hand.does("update")
    hand.machine.refusal = None
    count = len(hand.machine.posted)
    hand.does("update")
    hand.does("end")
    assert len(hand.machine.posted) == count


def test_another_browser_of_the_session_does_not_join_a_drag(hand: Hand) -> None:
    hand.does("start", client_id=1)
    hand.does("update", client_id=2)
    assert hand.machine.of(DragTo) == []


def test_an_update_without_a_start_moves_nothing(hand: Hand) -> None:
    hand.does("update")
    hand.does("end")
    assert hand.machine.posted == []


def test_without_a_session_nothing_moves(hand: Hand) -> None:
    token = SESSION.set(None)
    hand.does("start")
    hand.does("update")
    SESSION.reset(token)
    assert hand.machine.posted == []


def test_with_an_unknown_pose_there_is_nothing_to_grab(hand: Hand) -> None:
    hand.machine.snapshot = dataclasses.replace(hand.machine.snapshot, xyz=None, theta=None)
    hand.does("start")
    hand.does("update")
    assert hand.machine.posted == []
    assert hand.told[0][0] == "anna"


def test_above_the_horizon_the_last_target_holds(hand: Hand) -> None:
    hand.eye = dataclasses.replace(hand.eye, wxyz=rotations.about(0, -np.radians(92.0)))
    hand.does("start")
    event = hand.event("update", AHEAD)
    event.end_screen_pos = (0.5, 0.0)
    asyncio.run(hand.dragging.on_plane(event))
    assert hand.machine.of(DragTo) == []
    assert metres((0.0, 0.0, -330.0)) == pytest.approx(AHEAD)


PLANAR_TIP = np.array((0.0, 0.0, -0.185))


@pytest.fixture
def planar_hand(machine: Any, planar_robot: Any) -> Iterator[Hand]:
    machine.become(planar_robot)
    token = SESSION.set("anna")
    hand = Hand(machine)
    hand.grabbed = PLANAR_TIP
    yield hand
    SESSION.reset(token)


def test_a_planar_robot_is_dragged_in_its_plane(planar_hand: Hand) -> None:
    planar_hand.does("start", PLANAR_TIP)
    planar_hand.does("update", PLANAR_TIP)
    planar_hand.does("update", PLANAR_TIP + np.array((0.03, 0.0, 0.02)))
    stayed, moved = planar_hand.machine.of(DragTo)
    assert stayed.xyz == pytest.approx((0.0, -185.0))  # no jump
    assert moved.xyz == pytest.approx((30.0, -165.0))


def test_with_shift_a_planar_robot_keeps_its_x(planar_hand: Hand) -> None:
    planar_hand.does("start", PLANAR_TIP, shift=True)
    planar_hand.does("update", PLANAR_TIP + np.array((0.05, 0.0, 0.02)), shift=True)
    (moved,) = planar_hand.machine.of(DragTo)
    assert moved.xyz == pytest.approx((0.0, -165.0))
