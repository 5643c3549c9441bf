"""Stop in every state; e-stop in every state; what each leaves behind."""

from __future__ import annotations

import pytest

from deltaviz.link.board.states import TRANSITIONS, BoardEvent
from deltaviz.link.messages import (
    BoardState,
    Done,
    Enable,
    EStop,
    Fault,
    Hello,
    HelloReply,
    Home,
    Inputs,
    Keep,
    Refusal,
    Refused,
    Reset,
    Stop,
    StopCause,
    Stopped,
    Telemetry,
    Tool,
)

ACCELERATION = 50_000.0


def disabled(make):
    bench = make(homed=False)
    bench.send(Enable(on=False))
    return bench


def halted(make):
    return make()


def armed(make):
    bench = make()
    bench.arm()
    return bench


def moving(make):
    bench = make()
    bench.speed_up(1500)
    bench.go_on(10)
    bench.run(37)
    return bench


def braking(make):
    bench = moving(make)
    bench.send(Stop())
    bench.run(3)
    return bench


def homing(make):
    bench = make(homed=False)
    bench.send(Keep(bench.now))
    bench.send(Home())
    bench.run(100)
    return bench


def estop(make):
    bench = make()
    bench.send(EStop())
    return bench


def fault(make):
    bench = make()
    bench.speed_up(500)
    bench.run(5)
    bench.board.plant.force_switch(0, True)
    bench.run_to_rest()
    return bench


def unconfigured(make):
    bench = make()
    bench.switch_off_and_on()
    return bench


SITUATIONS = [
    (disabled, BoardState.DISABLED),
    (unconfigured, BoardState.DISABLED),
    (halted, BoardState.HALTED),
    (armed, BoardState.ARMED),
    (moving, BoardState.ARMED),
    (braking, BoardState.BRAKING),
    (homing, BoardState.HOMING),
    (estop, BoardState.ESTOP),
    (fault, BoardState.FAULT),
]
situations = pytest.mark.parametrize(
    ("situation", "state"), SITUATIONS, ids=[situation.__name__ for situation, _ in SITUATIONS]
)

AFTER_STOP = {
    BoardState.DISABLED: BoardState.DISABLED,
    BoardState.HALTED: BoardState.HALTED,
    BoardState.ARMED: BoardState.HALTED,
    BoardState.BRAKING: BoardState.HALTED,
    BoardState.HOMING: BoardState.HALTED,
    BoardState.ESTOP: BoardState.ESTOP,
    BoardState.FAULT: BoardState.FAULT,
}


@situations
def test_stop_works_in_every_state(make_bench, accelerations, situation, state):
    bench = situation(make_bench)
    assert bench.board.state is state
    before = len(bench.said)
    bench.send(Stop())
    if bench.board.moving:
        bench.run_to_rest()
    assert bench.board.state is AFTER_STOP[state]
    assert any(isinstance(message, Stopped) for message in bench.said[before:])
    assert bench.last(Stopped).counts == bench.board.counts
    if bench.board.counts:
        bench.run(20)
    assert accelerations(bench.trace) <= ACCELERATION * 1.02
    assert not bench.board.moving


@situations
def test_stop_is_idempotent_and_always_answered(make_bench, situation, state):
    bench = situation(make_bench)
    bench.send(Stop())
    while bench.board.moving:
        bench.run(1)
        bench.send(Stop())
    cause = bench.board.cause
    for _ in range(3):
        answers = [m for m in bench.send(Stop()) if isinstance(m, Stopped)]
        assert [answer.cause for answer in answers] == [cause]
    assert bench.board.state is AFTER_STOP[state]


@situations
def test_estop_works_in_every_state(make_bench, situation, state):
    bench = situation(make_bench)
    counts = bench.board.counts
    answers = bench.send(EStop())
    assert bench.board.state is BoardState.ESTOP
    assert any(isinstance(m, Stopped) and m.cause is StopCause.ESTOP for m in answers)
    assert not bench.board.moving
    assert not bench.board.homed
    bench.advance(2000)
    assert bench.board.counts == counts


@pytest.mark.parametrize("ms", range(1, 60, 7))
def test_a_stop_while_homing_brakes_and_leaves_it_unhomed(make_bench, accelerations, ms):
    bench = make_bench(homed=False)
    bench.send(Keep(bench.now))
    bench.send(Home())
    bench.run(ms * 40)
    if bench.board.state is not BoardState.HOMING:
        return
    bench.send(Stop())
    bench.run_to_rest()
    bench.run(5)
    assert bench.board.state is BoardState.HALTED
    assert bench.board.cause is StopCause.HOST_STOP
    assert not bench.board.homed


def test_a_stop_drops_what_was_waiting(bench):
    bench.arm()
    bench.segment([1, 100], [0, 0], t_end=(bench.now + 60 * 200) & 0xFFFF_FFFF)
    bench.send(Stop())
    assert bench.board.state is BoardState.HALTED
    bench.run(100)
    assert bench.board.counts == (0, 100)


def test_the_first_cause_is_kept_until_the_next_arming(bench):
    bench.speed_up(1500)
    bench.run(200, keep=False)
    assert bench.board.cause is StopCause.UNDERRUN
    bench.send(Stop())
    assert bench.last(Stopped).cause is StopCause.UNDERRUN
    bench.arm()
    assert bench.board.cause is StopCause.NONE


def test_disabling_in_motion_brakes_first(make_bench, accelerations):
    bench = moving(make_bench)
    assert Done("enable") not in bench.send(Enable(on=False))
    heard = bench.run_to_rest()
    assert bench.board.state is BoardState.DISABLED
    assert Done("enable") in heard
    assert not bench.board.homed
    assert accelerations(bench.trace) <= ACCELERATION * 1.02


def test_after_an_estop_only_reset_helps_and_homing_is_lost(make_bench):
    bench = moving(make_bench)
    bench.send(EStop())
    assert Refused("enable", Refusal.STATE) in bench.send(Enable(on=True))
    assert bench.board.state is BoardState.ESTOP
    assert Done("reset") in bench.send(Reset())
    assert bench.board.state is BoardState.DISABLED
    bench.send(Enable(on=True))
    assert bench.board.state is BoardState.HALTED
    assert not bench.board.homed


def test_the_estop_input_acts_and_holds(make_bench):
    """At the next boundary; the count is where it was cut."""
    bench = moving(make_bench)
    bench.advance(30)
    bench.board.press_estop(True)
    bench.advance(169)
    assert bench.board.state is BoardState.ARMED
    bench.advance(1)
    assert bench.board.state is BoardState.ESTOP
    counts = bench.board.counts
    bench.advance(400)
    assert bench.board.counts == counts
    assert bench.board.fault is Fault.ESTOP_INPUT
    assert Inputs.ESTOP in bench.last(Telemetry).inputs
    assert Refused("reset", Refusal.INPUT) in bench.send(Reset())
    bench.board.press_estop(False)
    bench.run(1)
    assert Inputs.ESTOP not in bench.last(Telemetry).inputs
    assert bench.board.state is BoardState.ESTOP
    bench.send(Reset())
    assert bench.board.state is BoardState.DISABLED
    assert bench.board.fault is Fault.NONE


def test_it_cannot_be_enabled_while_the_estop_input_is_active(make_bench):
    bench = disabled(make_bench)
    bench.board.press_estop(True)
    bench.run(1)
    bench.send(Reset())
    assert Refused("enable", Refusal.INPUT) in bench.send(Enable(on=True))


def test_a_limit_switch_in_motion_brakes_into_fault(make_bench, accelerations):
    bench = moving(make_bench)
    bench.board.plant.force_switch(1, True)
    bench.run(1)
    assert bench.board.state is BoardState.BRAKING
    bench.run_to_rest()
    assert bench.board.state is BoardState.FAULT
    assert bench.board.fault is Fault.LIMIT_SWITCH
    assert bench.last(Stopped).cause is StopCause.LIMIT_SWITCH
    assert Inputs.SWITCH_1 in bench.last(Telemetry).inputs
    assert accelerations(bench.trace) <= ACCELERATION * 1.02
    assert Refused("arm", Refusal.STATE) in bench.arm()


def stood_with_a_broken_switch(make_bench, configure, **options):
    """Its wire broke while the robot stood: it reads as pressed, and is no news when it moves."""
    bench = make_bench(configure, **options)
    bench.run(1)
    bench.board.plant.force_switch(1, True)
    bench.run(5)
    assert bench.board.state is BoardState.HALTED
    bench.arm()
    return bench


@pytest.mark.parametrize("homed", [True, False])
@pytest.mark.parametrize("inwards", [1, -1])
def test_where_a_switch_is_pressed_already_only_the_way_back_is_open(
    make_bench, make_configure, homed, inwards
):
    configure = make_configure(homing_direction=inwards, homing_switch=(1.6 * inwards,) * 2)
    for sign in (-inwards, inwards):
        bench = stood_with_a_broken_switch(make_bench, configure, homed=homed)
        start = bench.board.counts
        bench.segment([start[0], start[1] + sign * 2], [0, 0], ms=50)
        bench.run_to_rest()
        if sign != inwards:
            assert bench.board.state is BoardState.ARMED
            continue
        assert bench.board.state is BoardState.FAULT
        assert bench.board.fault is Fault.LIMIT_SWITCH
        assert bench.last(Stopped).cause is StopCause.LIMIT_SWITCH
        assert bench.board.counts == start


def test_hello_is_a_new_session(make_bench):
    bench = moving(make_bench)
    bench.send(Hello(1))
    bench.run_to_rest()
    assert bench.board.state is BoardState.HALTED
    reply = bench.last(HelloReply)
    assert reply.last_epoch == bench.epoch
    assert reply.homed
    assert reply.configuration != 0


def test_another_version_may_only_stop(make_bench):
    bench = armed(make_bench)
    reply = bench.send(Hello(2))
    assert any(isinstance(m, HelloReply) and m.version == 1 for m in reply)
    assert Refused("arm", Refusal.VERSION) in bench.arm()
    assert any(isinstance(m, Stopped) for m in bench.send(Stop()))
    bench.send(Hello(1))
    assert Done("arm") in bench.arm()


def drivers_off(bench):
    bench.send(Enable(on=False))


def press_estop(bench):
    bench.board.press_estop(True)
    bench.run(1)


@pytest.mark.parametrize("ends", [drivers_off, press_estop, lambda bench: bench.send(EStop())])
def test_the_tool_goes_off_with_the_drivers(bench, ends):
    assert Done("tool") in bench.send(Tool(on=True, servo_angle=0.5))
    bench.send(Stop())
    assert bench.board.tool == Tool(on=True, servo_angle=0.5)
    ends(bench)
    assert bench.board.tool == Tool(on=False, servo_angle=0.5)
    assert Refused("tool", Refusal.STATE) in bench.send(Tool(on=True, servo_angle=0.0))


def test_a_tool_at_no_angle_is_refused(bench):
    assert Refused("tool", Refusal.CONFIGURATION) in bench.send(Tool(True, float("nan")))


def test_the_table_reaches_every_state_and_always_knows_an_estop():
    assert set(TRANSITIONS.values()) == set(BoardState)
    for state in BoardState:
        assert TRANSITIONS[state, BoardEvent.ESTOP] is BoardState.ESTOP
    braking_ends = {
        TRANSITIONS[BoardState.BRAKING, event]
        for event in (BoardEvent.RESTED, BoardEvent.RESTED_FAULT, BoardEvent.RESTED_DISABLE)
    }
    assert BoardState.ARMED not in braking_ends
