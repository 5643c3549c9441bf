"""A session that tests lead where they want it, and what the board says to it."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from deltaviz.link import messages as m
from deltaviz.link.session import Session

DIGEST = 1234
TICK_HZ = 200_000
MS = TICK_HZ // 1000
TURN = 0.02  # s, of the control loop at rest
SCALE = (500.0, 300.0)
CONFIGURATION = m.Configure(
    kind=m.RobotKind.JOINTS_ONLY, options=m.Options.NONE, homing_direction=-1,
    joint_min=(-1000, -1000), joint_max=(1000, 1000), velocity=(5, 5), acceleration=(50, 50),
    unhomed_velocity=(1, 1), microsteps_per_rad=SCALE, inverted=(False, False),
    homing_switch=(-1, -1), homing_fast=(1, 1), homing_slow=(1, 1), homing_backoff=(1, 1),
    homing_max_travel=(1, 1), ready=(0, 0), base_radius=(0.0, 0.0), effector_radius=(0.0, 0.0),
    upper_arm=(0.0, 0.0), forearm=(0.0, 0.0), azimuth=(0.0, 0.0), tool_offset=(0.0, 0.0, 0.0),
    workspace_x=(-1.0, 1.0), workspace_y=(-1.0, 1.0), workspace_z=(-1.0, 1.0),
    workspace_radius=1.0,
)  # fmt: skip
HELLO = m.HelloReply(
    version=m.PROTOCOL_VERSION, board="b", build="1", joints=2, tick_hz=TICK_HZ, queue_places=64,
    boot=1, last_epoch=65534, homed=True, configuration=0, last_stop=m.StopCause.BOOT,
)  # fmt: skip
HOMED = m.TelemetryFlags.HOMED | m.TelemetryFlags.CONFIGURED


def telemetry(**changes: Any) -> m.Telemetry:
    base = m.Telemetry(
        now=1000, state=m.BoardState.HALTED, fault=m.Fault.NONE, epoch=65534, last_index=0xFFFF,
        t_queue_end=1000, free=64, inputs=m.Inputs.NONE, flags=HOMED, counts=(100, -60),
    )  # fmt: skip
    return replace(base, **changes)


def new_session(now: float = 0.0, **options: Any) -> Session:
    return Session(
        configuration=CONFIGURATION, digest=DIGEST, microsteps_per_rad=SCALE, now=now, **options
    )


def ready_session() -> Session:
    """One that has just become ready, at 10 s."""
    new = new_session(9.9)
    new.receive(HELLO, 10.0)
    new.receive(m.Configured(DIGEST), 10.0)
    new.receive(telemetry(), 10.0)
    new.take()
    return new


def listen(session: Session, *, since: float, until: float) -> None:
    """What the control loop does while nothing comes."""
    while since < until:
        since = min(since + TURN, until)
        session.tick(since)
