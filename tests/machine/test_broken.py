"""Things that break in the middle of a motion: the robot rests, within limits, with a reason,
and nothing moves again until somebody presses again.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import pytest

from deltaviz.link import messages as m
from deltaviz.link.board import SimulatedBoard
from deltaviz.link.timing import STALE
from deltaviz.machine import intent as i
from deltaviz.machine.core import Core
from deltaviz.machine.fresh_press import PAUSE
from deltaviz.machine.jog_lease import LEASE, JogLease
from deltaviz.machine.mode import Mode
from deltaviz.machine.presses import Presses
from deltaviz.machine.transitions import AT_REST

ME, YOU = "me", "you"
ACCEPTED = i.Accepted()
FAST = (300.0, 0.0, 0.0)


def drag_alive(bench: Any) -> None:
    ms = bench.now * 1000
    bench.do(i.DragAlive(ME, round(ms), ms, bench.now))


def along_x(bench: Any, x: float) -> tuple[float, ...]:
    """A vector of the robot's own axes."""
    return (x, *(0.0,) * (len(bench.robot.axes) - 1))


def beside(bench: Any) -> tuple[float, ...]:
    x, *others, z = bench.snapshot.xyz
    return (x + 80.0, *others, z - 20.0)


def jogging(bench: Any) -> None:
    bench.jog(along_x(bench, 300.0), 0.15)


def stepping(bench: Any) -> None:
    assert bench.do(i.StepPoint(ME, along_x(bench, 80.0))) == ACCEPTED


def dragging(bench: Any) -> None:
    drag_alive(bench)
    assert bench.do(i.DragStart(ME, bench.now)) == ACCEPTED
    assert bench.do(i.DragTo(ME, beside(bench), bench.now)) == ACCEPTED


def sliding(bench: Any) -> None:
    theta = [angle + 0.1 for angle in bench.snapshot.theta]
    assert bench.do(i.FollowAngles(ME, (theta[0] + 0.5, *theta[1:]))) == ACCEPTED


def moving(bench: Any) -> None:
    assert bench.do(i.MoveToPoint(ME, beside(bench), 1.0)) == ACCEPTED


def homing(bench: Any) -> None:
    assert bench.do(i.Home(ME)) == ACCEPTED
    bench.run(0.5)


def turning_the_tool(bench: Any) -> None:
    rates = (0.0, 0.0, 0.0, 8.0)
    assert bench.do(i.JogStart(ME, "p", i.JogFrame.JOINTS, rates, bench.now)) == ACCEPTED
    bench.hold(rates, 0.15)


def moving_with_a_turn(bench: Any) -> None:
    assert bench.do(i.MoveToPoint(ME, beside(bench), 1.0, tool=2.5)) == ACCEPTED


WAYS = [
    *(("stm32", way) for way in (jogging, stepping, dragging, sliding, moving, homing)),
    *(("fivebar", way) for way in (jogging, stepping, dragging, sliding, moving, homing)),
    *(("stm32-tool", way) for way in (turning_the_tool, moving_with_a_turn, homing)),
]


@pytest.fixture(params=WAYS, ids=lambda way: f"{way[0]} {way[1].__name__}")
def in_motion(request: pytest.FixtureRequest, make_bench: Any, named_robot: Any) -> Any:
    """A bench in the middle of each way of moving, for a page that has said it is here."""
    name, way = request.param
    bench = make_bench(named_robot(name))
    bench.do(i.ClientHere(ME))
    way(bench)
    bench.run(0.1)
    assert bench.board.moving
    return bench


def assert_rests(bench: Any, *, within: float) -> None:
    bench.run_until(lambda: not bench.board.moving, within=within)
    bench.check_limits()


def assert_stays(bench: Any, seconds: float = 0.5) -> None:
    bench.run(0.02)
    rested = bench.now
    bench.run(seconds)
    assert not bench.path or bench.now - bench.path[-1][0] < 0.01
    assert bench.distance_moved(rested) == 0


def test_the_plug_is_pulled(in_motion: Any) -> None:
    bench = in_motion
    bench.cut = True
    assert_rests(bench, within=0.45)  # the lease, and the brake
    bench.run(1.2)
    assert bench.mode is Mode.OFFLINE
    assert "connect" in str(bench.snapshot.link.problem)
    assert bench.snapshot.xyz is None
    bench.reconnect_same_board()
    bench.run(0.1)
    assert bench.mode in (Mode.IDLE, Mode.UNHOMED)
    assert_stays(bench)
    if bench.mode is Mode.IDLE:  # the board never lost its counts
        bench.jog(along_x(bench, -30.0), 0.2, press="fresh")
        assert bench.board.moving
        epochs = [x.epoch for x in bench.sent if isinstance(x, m.Arm)]
        assert len(set(epochs)) == len(epochs), "no epoch twice"


def test_what_was_sent_before_the_plug_was_pulled_never_runs_twice(bench: Any) -> None:
    """The old session's bytes come out of the cable after the new session has begun."""
    jogging(bench)
    bench.cut = True
    seen = len(bench.sent)
    bench.hold(FAST, 0.14)
    late = bench.sent[seen:]
    bench.run(1.5)
    bench.reconnect_same_board()
    bench.run(0.1)
    rested = bench.now
    for message in late:
        bench.board.receive(message)
    bench.run(0.3)
    assert bench.distance_moved(rested) == 0


def test_the_page_in_control_is_gone(in_motion: Any) -> None:
    bench = in_motion
    bench.do(i.ClientGone(ME))
    assert_rests(bench, within=0.3)
    bench.run(0.05)
    assert bench.mode in AT_REST
    assert "page" in str(bench.snapshot.stop_reason)
    assert bench.snapshot.holder is None
    assert_stays(bench)


def test_a_watching_page_that_goes_changes_nothing(in_motion: Any) -> None:
    bench = in_motion
    mode = bench.mode
    bench.do(i.ClientHere(YOU))
    bench.do(i.ClientGone(YOU))
    bench.run(0.002)
    assert bench.mode is mode
    assert bench.snapshot.holder == ME


def test_a_stop_from_another_page(in_motion: Any) -> None:
    bench = in_motion
    bench.do(i.Stop(YOU, "Stop pressed"))
    assert_rests(bench, within=0.3)
    bench.run(0.02)
    assert bench.mode in AT_REST
    assert bench.snapshot.stop_reason == "Stop pressed"
    drag_alive(bench)
    assert isinstance(bench.beat(along_x(bench, 300.0)), i.Refused)
    assert isinstance(bench.do(i.DragTo(ME, along_x(bench, 5.0), bench.now)), i.Refused)
    assert_stays(bench)


def test_an_estop_takes_the_drivers_off_at_once(in_motion: Any) -> None:
    bench = in_motion
    bench.do(i.EStop(YOU, "E-stop pressed"))
    bench.run(0.004)
    assert not bench.board.moving
    bench.run(0.02)
    assert bench.mode is Mode.ESTOP


@pytest.mark.parametrize("lost", [1, 3, 8])
def test_a_stop_is_repeated_until_it_is_answered(bench: Any, lost: int) -> None:
    jogging(bench)
    bench.cut = True
    bench.do(i.Stop(ME, "Stop pressed"))
    bench.run(0.010 * lost - 0.004)
    bench.cut = False
    bench.run(0.012)
    assert bench.board.state in (m.BoardState.BRAKING, m.BoardState.HALTED)
    bench.run_to_rest()
    assert bench.mode is Mode.IDLE
    stops = sum(isinstance(x, m.Stop) for x in bench.sent)
    bench.run(0.1)
    assert stops == sum(isinstance(x, m.Stop) for x in bench.sent), "then it is quiet"


def test_a_page_that_falls_silent_mid_jog_slows_the_robot_within_250_ms(bench: Any) -> None:
    bench.jog((100.0, 0.0, 0.0), 0.4)
    bench.beat((100.0, 0.0, 0.0))
    last = bench.now
    bench.run(LEASE - 0.004)
    assert bench.mode is Mode.JOGGING, "one tick before"
    bench.run(0.006)
    assert bench.mode is Mode.STOPPING, "one tick after"
    bench.run_until(lambda: bench.board.state is m.BoardState.BRAKING, within=0.05)
    assert bench.now - last < 0.250
    bench.run_to_rest()
    assert "sign of life" in str(bench.snapshot.stop_reason)
    assert_stays(bench)


def test_a_burst_of_held_up_beats_revives_nothing(bench: Any) -> None:
    bench.jog((100.0, 0.0, 0.0), 0.4)
    sent = bench.now
    bench.run_to_rest()
    rested = bench.now
    for k in range(20):
        ms = (sent + 0.05 * k) * 1000
        answer = bench.do(i.JogBeat(ME, "p", round(ms), ms, (100.0, 0.0, 0.0), bench.now))
        assert isinstance(answer, i.Refused)
    late = i.JogStart(ME, "p", i.JogFrame.BASE, (100.0, 0.0, 0.0), bench.now)
    assert isinstance(bench.do(late), i.Refused), "an ended id never lives again"
    bench.run(0.3)
    assert bench.distance_moved(rested) == 0


def test_a_burst_in_the_middle_of_a_jog_does_not_prolong_it(bench: Any) -> None:
    """Beats sent 50 ms apart, all delivered 190 ms after the first: the last counts, as sent."""
    bench.jog((100.0, 0.0, 0.0), 0.4)
    bench.beat((100.0, 0.0, 0.0))
    sent = bench.now
    bench.run(0.190)
    for k in range(1, 4):
        ms = (sent + 0.001 * k) * 1000
        bench.do(i.JogBeat(ME, "p", round(ms) + k, ms, (100.0, 0.0, 0.0), bench.now))
    bench.run(0.018)
    assert bench.mode is Mode.STOPPING


def test_a_drag_whose_page_falls_silent_brakes(bench: Any) -> None:
    dragging(bench)
    bench.run(0.1)
    drag_alive(bench)
    last = bench.now
    x, y, z = bench.snapshot.xyz

    def pull() -> None:  # the scene still sends, the console does not
        bench.do(i.DragTo(ME, (x + 60, y, z), bench.now))

    bench.run(LEASE - 0.004, each=pull)
    assert bench.mode is Mode.JOGGING
    bench.run(0.006, each=pull)
    assert bench.mode is Mode.STOPPING
    assert bench.now - last < 0.250
    bench.run(0.3, each=pull)
    assert bench.mode is Mode.IDLE
    assert "drag" in str(bench.snapshot.stop_reason)


def a_pull_stopped(bench: Any) -> Callable[[], None]:
    """A slider that is pulled on and on, when Stop has just been pressed."""
    target = 0.0

    def pull() -> None:
        nonlocal target
        target += 0.001
        bench.do(i.FollowAngles(ME, (target, 0.0, 0.0)))

    bench.run(0.3, each=pull)
    bench.do(i.Stop(YOU, "Stop pressed"))
    return pull


def test_a_slider_pulled_through_a_stop_does_not_resume(bench: Any) -> None:
    pull = a_pull_stopped(bench)
    bench.run(0.3, each=pull)
    rested = bench.now
    bench.run(0.7, each=pull)
    assert bench.mode is Mode.IDLE
    assert bench.distance_moved(rested) == 0
    bench.run(0.5)
    assert bench.do(i.FollowAngles(ME, (0.5, 0.0, 0.0))) == ACCEPTED


def test_a_slider_pulled_through_a_long_stop_does_not_resume(bench: Any) -> None:
    """What is refused while the robot still brakes belongs to the same pull."""
    pull = a_pull_stopped(bench)
    bench.cut = True
    bench.run(PAUSE + 0.1, each=pull)
    assert bench.mode is Mode.STOPPING
    bench.cut = False
    bench.run(0.1, each=pull)
    rested = bench.now
    bench.run(0.3, each=pull)
    assert bench.mode is Mode.IDLE
    assert bench.distance_moved(rested) == 0


def test_a_press_that_a_silent_board_refuses_leaves_no_jog_without_a_hand(bench: Any) -> None:
    """The new press has ended the one before, so nothing keeps the first one's motion alive."""
    velocity = (40.0, 0.0, 0.0)
    bench.do(i.SetOverride(ME, 0.0))
    bench.jog(velocity, 0.3, press="first")
    bench.cut = True
    bench.hold(velocity, STALE + 0.02, press="first")
    assert bench.mode is Mode.JOGGING
    second = i.JogStart(ME, "second", i.JogFrame.BASE, velocity, bench.now)
    assert "silent" in bench.do(second).detail
    bench.cut = False
    bench.run_to_rest()
    assert bench.mode is Mode.IDLE
    before = bench.now
    bench.do(i.SetOverride(ME, 1.0))
    bench.run(0.5)
    assert bench.distance_moved(before) == 0


def test_a_grab_that_a_silent_board_refuses_leaves_no_drag_without_a_hand(bench: Any) -> None:
    dragging(bench)
    bench.run(1.0, each=lambda: drag_alive(bench))
    assert not bench.board.moving
    bench.cut = True
    bench.run(STALE + 0.02, each=lambda: drag_alive(bench))
    assert bench.mode is Mode.JOGGING
    assert "silent" in bench.do(i.DragStart(ME, bench.now)).detail
    bench.cut = False
    bench.run_to_rest()
    assert bench.mode is Mode.IDLE


def test_a_late_answer_to_an_earlier_stop_does_not_end_this_one(bench: Any) -> None:
    """Each repetition of a stop is answered, so one more answer may be on its way."""
    moving(bench)
    bench.run(0.1)
    bench.do(i.Stop(YOU, "Stop pressed"))
    bench.run_to_rest()
    answer = next(heard for heard in reversed(bench.heard) if isinstance(heard, m.Stopped))
    assert bench.do(i.Home(ME)) == ACCEPTED
    bench.run(0.1)
    assert bench.board.state is m.BoardState.HOMING
    bench.cut = True
    bench.do(i.Stop(YOU, "Stop pressed again"))
    bench.run(0.002)
    bench.controller.receive([answer], bench.now)
    bench.cut = False
    bench.run(0.2)
    assert bench.board.state is m.BoardState.HALTED
    assert bench.mode is Mode.UNHOMED
    assert bench.snapshot.stop_reason == "Stop pressed again"


def test_after_a_refused_homing_the_robot_can_be_moved_again(
    bench: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The board still has the epoch of the motion before, and is armed for no other."""
    stepping(bench)
    bench.run_to_rest()
    assert bench.board.state is m.BoardState.ARMED
    receive = bench.board.receive

    def without_lease(message: m.HostMessage) -> None:
        if not isinstance(message, m.Keep):  # lost on its way
            receive(message)

    bench.run(0.2)
    monkeypatch.setattr(bench.board, "receive", without_lease)
    assert bench.do(i.Home(ME)) == ACCEPTED
    bench.run(0.1)
    assert bench.mode is Mode.IDLE
    assert "refused 'home'" in bench.snapshot.stop_reason
    monkeypatch.undo()
    assert bench.do(i.StepPoint(ME, along_x(bench, -5.0))) == ACCEPTED


@pytest.mark.parametrize(
    "intent",
    [
        i.StepPoint(ME, (5.0, 0.0, 0.0)),
        i.StepAngles(ME, (0.1, 0.0, 0.0)),
        i.MoveToPoint(ME, (0.0, 0.0, -300.0), 1.0),
        i.MoveToAngles(ME, (0.1, 0.1, 0.1), 1.0),
        i.FollowPoint(ME, (0.0, 0.0, -300.0)),
        i.FollowAngles(ME, (0.1, 0.1, 0.1)),
    ],
    ids=lambda intent: type(intent).__name__,
)
def test_what_is_asked_in_the_moment_in_which_the_pose_is_lost(
    bench: Any, intent: i.Intent
) -> None:
    """Intents are read after the board's news, and before the mode follows from them."""
    bench.board.press_estop(True)
    bench.board.advance(1000)
    bench.controller.receive(bench.board.take(), bench.now)
    answer = bench.do(intent)
    assert isinstance(answer, i.Refused)
    assert answer.kind is i.RefusalKind.MODE
    assert "pose" in answer.detail
    bench.run(0.02)
    assert bench.mode is Mode.ESTOP


def test_a_board_that_counts_other_joints_is_not_moved(bench: Any) -> None:
    telemetry = next(x for x in reversed(bench.heard) if isinstance(x, m.Telemetry))
    flags = telemetry.flags & ~m.TelemetryFlags.HOMED
    bench.controller.receive([replace(telemetry, counts=(1, 2), flags=flags)], bench.now)
    bench.controller.tick(bench.now)
    assert bench.mode is Mode.UNHOMED
    press = i.JogStart(ME, "p", i.JogFrame.JOINTS, (0.05, 0.0, 0.0), bench.now)
    assert isinstance(bench.do(press), i.Refused)


def test_a_board_that_brakes_by_itself_says_why(bench: Any) -> None:
    """The host stalls for longer than the horizon: the board runs out and brakes."""
    moving(bench)
    bench.run(0.08)
    for _ in range(60):
        bench.now += 0.002
        bench._advance_board()
    bench.run_to_rest()
    assert bench.mode is Mode.IDLE
    assert "slow" in str(bench.snapshot.stop_reason)
    assert bench.snapshot.underruns == 1
    assert_stays(bench)
    bench.check_limits()


def test_a_board_that_restarts_is_not_believed_to_be_homed(bench: Any) -> None:
    jogging(bench)
    bench.board = SimulatedBoard(boot=9)
    bench.run(0.1)
    assert bench.mode is Mode.OFFLINE
    assert "restarted" in str(bench.snapshot.link.problem)
    assert not bench.snapshot.homed


def test_a_segment_that_the_board_refuses_stops_with_its_words(bench: Any) -> None:
    """The board judges for itself: here the host's guard and limits are of another robot."""
    jogging(bench)
    bench.board.receive(
        m.Segment(
            epoch=bench.segments()[-1].epoch,
            index=(bench.segments()[-1].index + 1) & 0xFFFF,
            t_end=(bench.segments()[-1].t_end + 2000) & 0xFFFF_FFFF,
            duration=2000,
            seen=bench.board.now,
            p=(10**9,) * 3,
            v=(0,) * 3,
        )
    )
    bench.run(0.01)
    bench.run_to_rest()
    assert bench.mode is Mode.IDLE
    assert str(bench.snapshot.stop_reason).startswith("The board refused a motion")
    bench.check_limits()


def test_a_board_that_halted_and_was_not_heard_saying_so(bench: Any, monkeypatch: Any) -> None:
    """What is heard of the whole brake is that the board is halted, and not by whom."""
    jogging(bench)
    take, said = bench.board.take, []

    def lost() -> list[m.BoardMessage]:
        said.extend(take())
        return []

    with monkeypatch.context() as patch:
        patch.setattr(bench.board, "take", lost)
        bench.board.receive(m.Stop())
        bench.run(0.002)
        bench.run_until(lambda: not bench.board.moving)
    bench.run(0.05)
    assert any(isinstance(x, m.Stopped) for x in said)
    assert bench.mode is Mode.IDLE
    assert_stays(bench)


def test_homing_waits_for_the_answer_to_a_stop(bench: Any, monkeypatch: Any) -> None:
    """Its answers are lost, while the board was enabled: the stop is still repeated."""
    bench.do(i.Disable(ME))
    bench.run(0.02)
    take = bench.board.take
    lost = lambda: [x for x in take() if not isinstance(x, m.Stopped)]  # noqa: E731
    monkeypatch.setattr(bench.board, "take", lost)
    bench.do(i.Stop(ME, "Stop pressed"))
    assert bench.do(i.Enable(ME)) == ACCEPTED
    bench.run_until(lambda: bench.mode is Mode.UNHOMED)
    refused = bench.do(i.Home(ME))
    assert isinstance(refused, i.Refused)
    assert "not ready" in refused.detail
    monkeypatch.setattr(bench.board, "take", take)
    bench.run(0.02)
    assert bench.do(i.Home(ME)) == ACCEPTED


# The same tests with a check taken out must fail: they do see what they claim to see.


@pytest.mark.parametrize(
    ("owner", "name", "without", "test"),
    [
        (
            JogLease,
            "expired",
            lambda *_: False,
            test_a_page_that_falls_silent_mid_jog_slows_the_robot_within_250_ms,
        ),
        (
            Presses,
            "admits_value",
            lambda *_: True,
            test_a_slider_pulled_through_a_stop_does_not_resume,
        ),
        (Core, "_watch_presses", lambda *_: None, test_a_drag_whose_page_falls_silent_brakes),
    ],
)
def test_the_tests_notice_a_missing_check(
    bench: Any,
    monkeypatch: pytest.MonkeyPatch,
    owner: type,
    name: str,
    without: Callable[..., Any],
    test: Callable[[Any], None],
) -> None:
    monkeypatch.setattr(owner, name, without)
    with pytest.raises(AssertionError):
        test(bench)
