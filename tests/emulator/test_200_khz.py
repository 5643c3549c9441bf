"""The ticks of silicon, for a second: what leaves the pins is as right at 200 kHz as at 40."""

from __future__ import annotations

from deltaviz.link.emulator.firmware import built
from tests.emulator import judge


def test_a_second_at_200_khz(emulated_board, steady):
    board = emulated_board(image=built("emulator-200khz.elf"))
    board.connect()
    assert board.tick_hz == 200_000
    board.enable()
    path = board.drive(steady(board, seconds=0.7, speed=0.08, rests=True))
    board.until(lambda: board.telemetry.now >= board.tick_hz, "a second")
    counts = board.telemetry.counts
    pulses = board.finish()
    assert pulses.faults == ()
    assert board.last_tick >= 200_000
    assert max(judge.position_error(pulses, path)) < 1.0
    assert abs(counts[0]) > 15
