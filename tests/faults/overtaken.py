"""Frames of a motion that was given up come late, in the middle of the next one's beginning."""

from __future__ import annotations

from deltaviz.link.messages import BoardState, Segment
from deltaviz.link.wire.codec import encode
from deltaviz.link.wire.frames import write_frame
from deltaviz.machine import intent as i
from deltaviz.machine.mode import Mode
from tests.faults.breaks import judge
from tests.faults.judge import Verdict
from tests.faults.phases import ME, idle, quick_robot
from tests.faults.wire_bench import WireBench

TURN = 0.002  # s


def overtaken(*, seed: int) -> Verdict:
    """One press, whose segments are held up; a stop; another press, the other way; and when the
    board has taken its Arm, what was held up comes out.
    """
    bench = WireBench(quick_robot(), seed=seed)
    idle(bench)
    bench.withheld = encode(Segment(0, 0, 0, 0, 0, (), ()))[0]
    bench.sent.clear()
    bench.jog((150.0, 0.0, 0.0), 0.02, press="first")
    held = [encode(m) for m in bench.sent if isinstance(m, Segment)]
    assert held
    bench.do(i.Stop(ME, "Stop pressed"))
    bench.run_until(lambda: bench.mode is Mode.IDLE)
    bench.jog((-150.0, 0.0, 0.0), 3 * TURN, press="second")
    assert bench.board.state is BoardState.ARMED
    bench.flood(b"".join(write_frame(type_, 0, payload) for type_, payload in held))
    bench.withheld = None
    bench.hold((-150.0, 0.0, 0.0), 0.2, press="second")
    bench.do(i.JogEnd(ME, "second"))
    bench.run_to_rest()
    return judge()(bench.executed[-1])
