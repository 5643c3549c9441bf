"""What breaks in the middle of a session: the wire, the host, the board, or the peace on it."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cache
from itertools import pairwise
from random import Random

from deltaviz.link.messages import Stop
from deltaviz.link.wire.codec import encode
from deltaviz.link.wire.frames import write_frame
from deltaviz.machine import intent as i
from deltaviz.machine.mode import Mode
from deltaviz.machine.sentences import NEVER_BEGAN
from deltaviz.machine.snapshot import LinkPhase
from deltaviz.machine.transitions import AT_REST
from tests.faults.executed import Sample
from tests.faults.faulty_line import FRAME_END
from tests.faults.judge import Judge, Verdict
from tests.faults.operator import Operator
from tests.faults.phases import ME, PHASES, SPEED, quick_robot
from tests.faults.wire_bench import LINK, WireBench

TURN = 0.002  # s
FLOODED = 0.4  # s
LOST = 1.5  # s: longer than a silence that the host puts up with

Break = Callable[[WireBench, Random], None]


def wire_gone_for_a_moment(bench: WireBench, _random: Random) -> None:
    bench.cut = True
    go_on(bench, 0.1)
    bench.cut = False
    go_on(bench, 0.1)


def wire_gone(bench: WireBench, _random: Random) -> None:
    bench.cut = True
    go_on(bench, LOST)


def unplugged(bench: WireBench, _random: Random) -> None:
    bench.unplug()
    go_on(bench, LOST)


def wire_to_board_gone(bench: WireBench, _random: Random) -> None:
    """One of the two wires: the host still hears."""
    bench.deaf = True
    go_on(bench, LOST)
    bench.deaf = False


def power_gone(bench: WireBench, _random: Random) -> None:
    """Of the board, for a moment: it comes back as it starts."""
    bench.reset_board()
    go_on(bench, LOST)


def host_stalled(seconds: float) -> Break:
    def stall(bench: WireBench, _random: Random) -> None:
        bench.stall(seconds)
        go_on(bench, 0.3)

    return stall


def flooded_with_noise(bench: WireBench, random: Random) -> None:
    go_on(bench, FLOODED, each=lambda: bench.flood(random.randbytes(100)))


def flooded_with_old_frames(bench: WireBench, random: Random) -> None:
    """All that the host has ever said, again and in any order."""
    told = [frame for frame in bench.told if frame.endswith(FRAME_END)]
    go_on(bench, FLOODED, each=lambda: bench.flood(b"".join(random.choices(told, k=6))))


def flooded_with_stops(bench: WireBench, _random: Random) -> None:
    stop = write_frame(encode(Stop())[0], 0, b"")
    go_on(bench, FLOODED, each=lambda: bench.flood(stop * 10))


def flooded_host(bench: WireBench, random: Random) -> None:
    """With noise, and with all that the board has ever said."""
    told = list(bench.heard_bytes)

    def flood() -> None:
        bench.flood_host(random.randbytes(20) + FRAME_END)
        bench.flood_host(b"".join(random.choices(told, k=4)))

    go_on(bench, FLOODED, each=flood)
    go_on(bench, 0.1)  # until it has heard its board again


BREAKS: dict[str, Break] = {
    "the wire gone for 100 ms": wire_gone_for_a_moment,
    "the wire gone, unnoticed": wire_gone,
    "the wire to the board gone": wire_to_board_gone,
    "the plug pulled": unplugged,
    "the board's power gone for a moment": power_gone,
    "the host stalled for 20 ms": host_stalled(0.020),
    "the host stalled for 300 ms": host_stalled(0.300),
    "the host stalled for 1 s": host_stalled(1.0),
    "noise to the board": flooded_with_noise,
    "old frames to the board": flooded_with_old_frames,
    "5000 stops a second to the board": flooded_with_stops,
    "noise and old frames to the host": flooded_host,
}


def go_on(bench: WireBench, seconds: float, *, each: Callable[[], None] = lambda: None) -> None:
    """A person who holds a jog goes on holding it."""
    turns = 0

    def turn() -> None:
        nonlocal turns
        turns += 1
        each()
        if turns % 25 == 0 and bench.mode is Mode.JOGGING:
            bench.beat(SPEED)

    bench.run(seconds, each=turn)


@dataclass(frozen=True)
class Outcome:
    """What came of a break; times are seconds of the board's time from the break on."""

    moving: bool  # when it broke
    stopped: bool  # a motion was not carried on
    rested: float  # until nothing moved any more, if it was stopped
    told: str | None
    end: Mode  # before anybody did anything
    verdicts: tuple[Verdict, ...]

    @property
    def wrong(self) -> list[str]:
        return [text for verdict in self.verdicts for text in verdict.wrong]


def break_at(phase: str, how: str, *, seed: int) -> Outcome:
    """Leads a bench to a phase, breaks it there, mends it, and lets a person begin anew. Raises
    AssertionError if it does not come to rest, or does not work afterwards.
    """
    random = Random(f"{phase} {how} {seed}")
    bench = WireBench(quick_robot(), seed=seed)
    PHASES[phase](bench)
    bench.run(TURN * random.randrange(10))
    hurt, before = bench.executed[-1], len(bench.executed[-1].samples)
    was_moving = bench.board.moving
    BREAKS[how](bench, random)
    stopped = was_moving and bench.mode not in (Mode.JOGGING, Mode.MOVING, Mode.HOMING)
    bench.do(i.JogEnd(ME, "p"))
    bench.run_until(lambda: _is_settled(bench), within=12.0)
    snapshot = bench.snapshot
    told = snapshot.stop_reason or snapshot.link.problem
    rested = _last_motion(hurt.samples[before:]) if stopped else 0.0
    bench.plug_in()
    wrong = _resumes(bench) if stopped else []
    _begin_anew(bench)
    verdicts = tuple(judge()(executed) for executed in bench.executed)
    verdicts[-1].wrong.extend(wrong)
    return Outcome(was_moving, stopped, rested, told, snapshot.mode, verdicts)


def _is_settled(bench: WireBench) -> bool:
    """Nothing moves, and the link is up or was given up."""
    link = bench.snapshot.link.phase in (LinkPhase.READY, LinkPhase.CLOSED)
    return link and bench.mode in AT_REST and not bench.board.moving


def _last_motion(samples: Sequence[Sample]) -> float:
    moved = [k for k, (a, b) in enumerate(pairwise(samples)) if a.counts != b.counts]
    return (moved[-1] + 2) / 1000 if moved else 0.0


def _resumes(bench: WireBench) -> list[str]:
    """What moves although nobody asks for it, when all is mended and connected again."""
    if bench.mode is Mode.OFFLINE:
        assert bench.do(i.Connect(ME, LINK)) == i.Accepted()
    bench.beat(SPEED)  # the hand is still where it was
    before = bench.board.counts
    bench.run(0.5)
    same = bench.board.counts == before or not before
    return [] if same else ["moves again, and nobody has asked for it"]


def _begin_anew(bench: WireBench) -> None:
    """A person gets it going again. An old Hello, come late, makes the board deaf to the numbers of
    this session's commands; then the page says to connect anew.
    """
    bench.run(0.05)  # what is old is over
    if not _steps(bench):
        assert bench.do(i.Connect(ME, LINK)) == i.Accepted()
        assert _steps(bench), bench.snapshot.stop_reason
    bench.run_to_rest()


def _steps(bench: WireBench) -> bool:
    Operator(bench).get_ready(within=12.0)
    start = bench.board.counts
    assert bench.do(i.StepPoint(ME, (0.0, 10.0, 0.0))) == i.Accepted()
    bench.run_until(lambda: bench.mode is Mode.IDLE)
    told = bench.snapshot.stop_reason
    if told is not None:
        assert told == NEVER_BEGAN
        return False
    return bench.board.counts != start


@cache
def judge() -> Judge:
    return Judge()
