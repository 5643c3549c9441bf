from __future__ import annotations

from deltaviz.scene.sliders import HELD, Wish


def test_moving_one_slider_keeps_the_others_where_they_are_shown() -> None:
    wish = Wish((0.0, 0.0, 0.0))
    wish.show((1.0, 2.0, 3.0))
    assert wish.change(1, 5.0, now=10.0) == (1.0, 5.0, 3.0)


def test_two_sliders_moved_at_once_both_count() -> None:
    wish = Wish((0.0, 0.0, 0.0))
    wish.change(0, 4.0, now=10.0)
    wish.show((0.1, 0.0, 0.0))  # the controller has not caught up
    assert wish.change(1, 5.0, now=10.0 + HELD / 2) == (4.0, 5.0, 0.0)


def test_an_old_wish_is_forgotten() -> None:
    wish = Wish((0.0, 0.0, 0.0))
    wish.change(0, 4.0, now=10.0)
    wish.show((2.0, 0.0, 0.0))  # held back by a limit
    assert wish.change(1, 5.0, now=10.0 + HELD) == (2.0, 5.0, 0.0)


def test_a_slider_belongs_to_whoever_moves_it_for_a_moment() -> None:
    wish = Wish((0.0, 0.0))
    wish.change(0, 4.0, now=10.0)
    assert not wish.free(0, now=10.0 + HELD - 0.001)
    assert wish.free(0, now=10.0 + HELD)
    assert wish.free(1, now=10.0)
