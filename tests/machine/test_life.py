"""The machine's life as a person meets it, and what each mode answers to each wish."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest

from deltaviz.link import messages as m
from deltaviz.link.board import SimulatedBoard
from deltaviz.machine import intent as i
from deltaviz.machine.mode import Mode
from deltaviz.machine.transitions import AT_REST, Event, after
from deltaviz.robots import Robot, load_robot

ME, YOU = "me", "you"
STEP = 0.002  # s; one turn of the bench
ACCEPTED = i.Accepted()


def bring_to(bench: Any, mode: Mode) -> None:
    """Lead a bench from idle to `mode` by what people and boards do."""
    x, y, z = bench.snapshot.xyz
    match mode:
        case Mode.IDLE:
            pass
        case Mode.OFFLINE:
            assert bench.do(i.Disconnect(ME)) == ACCEPTED
        case Mode.DISABLED:
            assert bench.do(i.Disable(ME)) == ACCEPTED
        case Mode.UNHOMED:
            bring_to(bench, Mode.DISABLED)
            bench.run(0.02)
            assert bench.do(i.Enable(ME)) == ACCEPTED
        case Mode.HOMING:
            assert bench.do(i.Home(ME)) == ACCEPTED
        case Mode.JOGGING:
            assert bench.do(i.StepPoint(ME, (60.0, 0.0, 0.0))) == ACCEPTED
            bench.run(0.05)
        case Mode.MOVING | Mode.RUNNING:
            assert bench.do(i.MoveToPoint(ME, (x + 60, y, z), 1.0)) == ACCEPTED
            bench.run(0.05)
        case Mode.PAUSED:
            bring_to(bench, Mode.MOVING)
            assert bench.do(i.Pause(ME)) == ACCEPTED
        case Mode.STOPPING:
            bring_to(bench, Mode.MOVING)
            assert bench.do(i.Stop(YOU, "Stop pressed")) == ACCEPTED
            bench.run(0.01)
        case Mode.FAULT:
            bench.board.plant.force_switch(0, True)
            bring_to(bench, Mode.HOMING)
            bench.run_until(lambda: bench.mode is Mode.FAULT, within=30)
        case Mode.ESTOP:
            assert bench.do(i.EStop(YOU, "E-stop pressed")) == ACCEPTED
    if mode not in (Mode.PAUSED, Mode.STOPPING):
        bench.run(0.03)
    if mode is Mode.RUNNING:
        bench.controller.mode = mode  # programs come later
    assert bench.mode is mode


WISHES: dict[Event, Callable[[Any], i.Intent]] = {
    Event.CONNECT: lambda _: i.Connect(ME, "sim"),
    Event.DISCONNECT: lambda _: i.Disconnect(ME),
    Event.SELECT_ROBOT: lambda _: i.SelectRobot(ME, "first"),
    Event.ENABLE: lambda _: i.Enable(ME),
    Event.DISABLE: lambda _: i.Disable(ME),
    Event.HOME: lambda _: i.Home(ME),
    Event.RESET: lambda _: i.Reset(ME),
    Event.JOG: lambda b: i.JogStart(ME, "x", i.JogFrame.BASE, (10.0, 0.0, 0.0), b.now),
    Event.JOG_JOINTS: lambda b: i.JogStart(ME, "x", i.JogFrame.JOINTS, (0.05, 0.0, 0.0), b.now),
    Event.STEP: lambda _: i.StepPoint(ME, (1.0, 0.0, 0.0)),
    Event.DRAG: lambda b: i.DragStart(ME, b.now),
    Event.FOLLOW: lambda _: i.FollowAngles(ME, (0.1, 0.1, 0.1)),
    Event.MOVE: lambda _: i.MoveToAngles(ME, (0.1, 0.1, 0.1), 1.0),
    Event.PAUSE: lambda _: i.Pause(ME),
    Event.RESUME: lambda _: i.Resume(ME),
    Event.STOP: lambda _: i.Stop(ME, "Stop pressed"),
    Event.ESTOP: lambda _: i.EStop(ME, "E-stop pressed"),
}


@pytest.mark.parametrize("mode", Mode)
@pytest.mark.parametrize("event", WISHES)
def test_every_mode_answers_every_wish_as_the_table_says(
    bench: Any, mode: Mode, event: Event
) -> None:
    bench.do(i.ClientHere(ME))
    bring_to(bench, mode)
    answer = bench.do(WISHES[event](bench))
    target = after(mode, event)
    if target is None:
        assert isinstance(answer, i.Refused)
        assert answer.kind is i.RefusalKind.MODE
        assert bench.mode is mode, "a refusal changes nothing"
    else:
        assert answer == ACCEPTED
        assert bench.mode is target


@pytest.mark.parametrize("mode", Mode)
def test_a_stop_from_anyone_works_in_every_mode_and_nothing_resumes(bench: Any, mode: Mode) -> None:
    bring_to(bench, mode)
    assert bench.do(i.Stop(YOU, "Stop pressed by another page")) == ACCEPTED
    bench.run_until(lambda: bench.mode in AT_REST, within=1.0)
    bench.run(0.05)
    rested = bench.now
    bench.run(0.3)
    assert bench.mode in AT_REST
    if bench.board.positions:
        assert bench.distance_moved(rested) == 0
    if mode not in (Mode.FAULT, Mode.ESTOP, Mode.STOPPING):
        assert bench.snapshot.stop_reason == "Stop pressed by another page"
    bench.check_limits()


@pytest.mark.parametrize("mode", sorted(set(Mode) - {Mode.OFFLINE}))
def test_an_estop_from_anyone_works_in_every_mode(bench: Any, mode: Mode) -> None:
    bring_to(bench, mode)
    assert bench.do(i.EStop(YOU, "E-stop pressed")) == ACCEPTED
    bench.run(0.02)
    assert bench.mode is Mode.ESTOP
    assert bench.board.state is m.BoardState.ESTOP
    assert not bench.snapshot.homed
    assert bench.do(i.Reset(YOU if bench.snapshot.holder is None else ME)) == ACCEPTED
    bench.run(0.02)
    assert bench.mode is Mode.DISABLED


def test_the_button_of_the_board_is_named_and_so_is_that_it_is_still_pressed(bench: Any) -> None:
    bench.board.press_estop(True)
    bench.run(0.02)
    assert bench.mode is Mode.ESTOP
    assert "hardware emergency stop was pressed" in bench.snapshot.stop_reason
    assert bench.do(i.Reset(ME)) == ACCEPTED
    bench.run(0.05)
    assert bench.mode is Mode.ESTOP
    assert "still pressed" in bench.snapshot.stop_reason


def test_a_board_that_is_switched_on_with_its_button_pressed_is_reset_and_connected(
    make_bench: Any,
) -> None:
    """It knows no robot yet, and takes none while it is e-stopped."""
    bench = make_bench(load_robot("stm32"), homed=False)
    assert bench.do(i.Disconnect(ME)) == ACCEPTED
    bench.board = SimulatedBoard()
    bench.board.press_estop(True)
    bench.reconnect_same_board()
    bench.run(0.1)
    assert bench.mode is Mode.ESTOP
    assert "hardware emergency stop was pressed" in bench.snapshot.stop_reason
    assert "reset" in bench.snapshot.next_step
    assert bench.do(i.Reset(ME)) == ACCEPTED
    bench.run(0.1)
    assert bench.mode is Mode.ESTOP
    assert "still pressed" in bench.snapshot.stop_reason
    bench.board.press_estop(False)
    bench.run(0.1)
    assert bench.mode is Mode.ESTOP, "nothing resets it but a person"
    assert bench.do(i.Reset(ME)) == ACCEPTED
    bench.run(0.1)
    assert bench.mode is Mode.DISABLED
    assert bench.snapshot.link.connected


@pytest.mark.parametrize("link_is_open", [False, True])
def test_an_estop_while_the_link_comes_up_reaches_the_board(bench: Any, link_is_open: bool) -> None:
    assert bench.do(i.Connect(ME, "sim")) == ACCEPTED
    if link_is_open:
        bench.run(STEP)
    assert bench.mode is Mode.OFFLINE
    assert bench.do(i.EStop(YOU, "E-stop pressed")) == ACCEPTED
    bench.run(0.1)
    assert bench.board.state is m.BoardState.ESTOP
    assert bench.mode is Mode.ESTOP
    assert bench.do(i.Reset(ME)) == ACCEPTED
    bench.run(0.1)
    assert bench.mode is Mode.DISABLED


@pytest.mark.parametrize("wanted", [True, False])
def test_a_robot_chosen_while_the_link_comes_up_is_connected(
    make_bench: Any, stm32: Robot, wanted: bool
) -> None:
    bench = make_bench(robots={"second": lambda: stm32})
    assert bench.do(i.Disconnect(ME)) == ACCEPTED
    bench.run(STEP)
    if wanted:
        assert bench.do(i.Connect(ME, "sim")) == ACCEPTED
    assert bench.do(i.SelectRobot(ME, "second")) == ACCEPTED
    bench.run(0.1)
    assert bench.snapshot.robot == "second"
    assert bench.snapshot.link.connected is wanted


def test_an_estop_without_any_link_is_not_kept_for_a_later_one(bench: Any) -> None:
    assert bench.do(i.Disconnect(ME)) == ACCEPTED
    bench.run(STEP)
    assert bench.do(i.EStop(YOU, "E-stop pressed")) == ACCEPTED
    assert bench.do(i.Connect(ME, "sim")) == ACCEPTED
    bench.run(0.1)
    assert bench.mode is Mode.IDLE


def test_an_estop_for_a_link_that_was_given_up_is_not_kept_for_a_later_one(bench: Any) -> None:
    assert bench.do(i.Connect(ME, "sim")) == ACCEPTED
    assert bench.do(i.EStop(YOU, "E-stop pressed")) == ACCEPTED
    assert bench.do(i.Disconnect(ME)) == ACCEPTED
    bench.run(STEP)
    assert bench.do(i.Connect(ME, "sim")) == ACCEPTED
    bench.run(0.1)
    assert bench.mode is Mode.IDLE


def test_the_simulated_board_starts_idle_at_the_ready_pose(bench: Any) -> None:
    state = bench.snapshot
    assert state.mode is Mode.IDLE
    assert state.homed
    assert state.link.connected
    assert state.theta == pytest.approx(bench.robot.homing.ready, abs=2e-3)
    assert state.stop_reason is None
    assert str(state.next_step).startswith("Jog")
    assert not bench.segments()
    assert not [x for x in bench.sent if isinstance(x, m.Arm)], "it never arms by itself"


def test_from_switched_on_to_idle(make_bench: Callable[..., Any]) -> None:
    bench: Any = make_bench(homed=False)
    steps = [bench.snapshot.next_step]
    assert bench.mode is Mode.DISABLED
    assert not bench.snapshot.xyz
    assert bench.do(i.Home(ME)).kind is i.RefusalKind.MODE
    assert bench.do(i.Enable(ME)) == ACCEPTED
    bench.run(0.02)
    assert bench.mode is Mode.UNHOMED
    assert bench.do(i.Enable(ME)) == ACCEPTED, "again: no effect"
    steps.append(bench.snapshot.next_step)
    assert bench.do(i.Home(ME)) == ACCEPTED
    assert bench.mode is Mode.HOMING
    bench.run_until(lambda: bench.mode is not Mode.HOMING, within=60)
    assert bench.mode is Mode.IDLE
    assert bench.snapshot.homed
    assert bench.snapshot.theta == pytest.approx(bench.robot.homing.ready, abs=2e-3)
    assert bench.board.plant.theta == pytest.approx(bench.robot.homing.ready, abs=0.02)
    steps.append(bench.snapshot.next_step)
    assert [str(step).split()[0] for step in steps] == ["Enable", "Home", "Jog"]
    bench.check_limits()
    bench.jog((30.0, 0.0, 0.0), 0.2)
    assert bench.mode is Mode.JOGGING
    assert bench.snapshot.xyz[0] > 2.0


def test_disable_loses_the_homing(bench: Any) -> None:
    bring_to(bench, Mode.UNHOMED)
    assert not bench.snapshot.homed
    assert bench.snapshot.xyz is None


def test_unhomed_only_single_joints_slowly(make_bench: Callable[..., Any]) -> None:
    bench = make_bench(homed=False)
    bench.do(i.Enable(ME))
    bench.run(0.02)
    began = bench.now
    start = i.JogStart(ME, "1", i.JogFrame.JOINTS, (3.0, 0.0, 0.0), bench.now)
    assert bench.do(start) == ACCEPTED
    bench.hold((3.0, 0.0, 0.0), 0.5, press="1")
    assert bench.mode is Mode.JOGGING
    for wish in (Event.JOG, Event.STEP, Event.DRAG, Event.FOLLOW, Event.MOVE, Event.HOME):
        answer = bench.do(WISHES[wish](bench))
        assert isinstance(answer, i.Refused)
        assert answer.kind is i.RefusalKind.MODE
    scale = bench.robot.drive.microsteps_per_rad[0]
    slow = bench.robot.limits.joint.unhomed_velocity[0]
    assert 0.3 * slow < bench.distance_moved(began) / scale / 0.5 <= slow
    assert not any(isinstance(x, m.Refused) for x in bench.heard)
    bench.do(i.JogEnd(ME, "1"))
    bench.run_until(lambda: bench.mode is Mode.UNHOMED, within=0.5)
    assert bench.snapshot.stop_reason is None


def test_a_failed_homing_says_what_to_look_at(bench: Any) -> None:
    bring_to(bench, Mode.FAULT)
    assert "switch" in str(bench.snapshot.fault)
    assert "reset" in str(bench.snapshot.next_step).lower()


def test_robots_change_at_rest_with_a_new_board(make_bench: Callable[..., Any]) -> None:
    bench = make_bench(robots={"trossen": lambda: load_robot("trossen")})
    bring_to(bench, Mode.JOGGING)
    assert isinstance(bench.do(i.SelectRobot(ME, "trossen")), i.Refused)
    bench.run_to_rest()
    assert bench.do(i.SelectRobot(ME, "trossen")) == ACCEPTED
    bench.run(0.03)
    assert bench.mode is Mode.IDLE
    assert bench.snapshot.robot == "trossen"
    assert len(bench.boards) == 2
    assert bench.snapshot.theta == pytest.approx(bench.robot.homing.ready, abs=5e-3)
    refused = bench.do(i.SelectRobot(ME, "../etc/passwd"))
    assert refused.kind is i.RefusalKind.VALUE
    assert "trossen" in refused.detail
    assert bench.mode is Mode.IDLE


def test_links_go_by_id(bench: Any) -> None:
    for url in ("file:///etc/passwd", "/dev/ttyUSB0", "sim://", ""):
        assert bench.do(i.Connect(ME, url)).kind is i.RefusalKind.VALUE
    assert bench.mode is Mode.IDLE
    assert bench.do(i.Disconnect(ME)) == ACCEPTED
    bench.run(0.02)
    assert bench.mode is Mode.OFFLINE
    assert str(bench.snapshot.next_step).startswith("Connect")
    assert not bench.snapshot.link.connected
    assert bench.do(i.Connect(ME, "sim")) == ACCEPTED
    bench.run(0.03)
    assert bench.mode is Mode.IDLE


def test_one_controls_and_everyone_may_stop(bench: Any) -> None:
    for client in (ME, YOU):
        bench.do(i.ClientHere(client))
    bench.jog((30.0, 0.0, 0.0), 0.1)
    assert bench.snapshot.holder == ME
    for wish in (
        i.JogStart(YOU, "1", i.JogFrame.BASE, (1.0, 0.0, 0.0), bench.now),
        i.StepPoint(YOU, (1.0, 0.0, 0.0)),
        i.Home(YOU),
        i.Pause(YOU),
        i.SetOverride(YOU, 0.5),
        i.RequestControl(YOU),
        i.SelectRobot(YOU, "first"),
    ):
        answer = bench.do(wish)
        assert isinstance(answer, i.Refused)
        assert answer.kind is i.RefusalKind.CONTROL
    assert bench.mode is Mode.JOGGING
    assert bench.do(i.Stop(YOU, "Stop pressed")) == ACCEPTED
    assert bench.do(i.RequestControl(YOU)).kind is i.RefusalKind.CONTROL
    bench.run_to_rest()
    assert bench.snapshot.holder == ME, "at rest a page still holds it"
    assert bench.do(i.RequestControl(YOU)) == ACCEPTED
    assert bench.do(i.StepPoint(ME, (1.0, 0.0, 0.0))).kind is i.RefusalKind.CONTROL
    assert bench.do(i.ReleaseControl(YOU)) == ACCEPTED
    assert bench.do(i.StepPoint(ME, (1.0, 0.0, 0.0))) == ACCEPTED


def test_a_program_holds_control_for_its_motion_only(bench: Any) -> None:
    x, y, z = bench.snapshot.xyz
    assert bench.do(i.MoveToPoint("curl", (x + 20, y, z), 1.0)) == ACCEPTED
    bench.run(0.03)
    assert bench.snapshot.holder == "curl"
    assert bench.do(i.StepPoint(ME, (1.0, 0.0, 0.0))).kind is i.RefusalKind.CONTROL
    bench.run_to_rest()
    assert bench.snapshot.holder is None
    assert bench.do(i.StepPoint(ME, (1.0, 0.0, 0.0))) == ACCEPTED


def test_a_refused_wish_takes_no_control(bench: Any) -> None:
    bench.do(i.ClientHere(YOU))
    assert isinstance(bench.do(i.Resume(YOU)), i.Refused)
    assert isinstance(bench.do(i.MoveToPoint(YOU, (0.0, 0.0, 99.0), 1.0)), i.Refused)
    assert bench.snapshot.holder is None


def test_other_numbers_of_joints(slide_robot: Robot, make_bench: Any) -> None:
    joints = slide_robot.joint_count
    bench = make_bench(slide_robot)
    assert bench.mode is Mode.IDLE
    far = tuple(40.0 + axis for axis in range(joints))
    assert bench.do(i.MoveToPoint(ME, far, 1.0)) == ACCEPTED
    bench.run_to_rest()
    assert bench.mode is Mode.IDLE
    assert bench.snapshot.xyz == pytest.approx(far, abs=0.25)
    assert bench.do(i.MoveToPoint(ME, (0.0, 0.0, 0.0), 1.0)).kind is i.RefusalKind.VALUE
    bench.jog(tuple(-50.0 for _ in far), 0.3)
    bench.do(i.Stop(ME, "Stop pressed"))
    bench.run_to_rest()
    bench.check_limits()
    assert bench.do(i.Home(ME)) == ACCEPTED
    bench.run_until(lambda: bench.mode is Mode.IDLE, within=60)
