"""The machine towards its board: state, ticks, stops, and the picture of it all.

Pure: messages and the time in, messages out. What people ask for comes in `controller`.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass

from deltaviz.link.configuration import configuration_hash, configure_from
from deltaviz.link.messages import BoardMessage, Fault, HostMessage, StopCause
from deltaviz.link.report import LinkReport
from deltaviz.link.session import Session
from deltaviz.machine import sentences
from deltaviz.machine.acquaintance import Acquaintance
from deltaviz.machine.activity import Activity, Kind
from deltaviz.machine.board_watch import reported
from deltaviz.machine.control_lease import ControlLease
from deltaviz.machine.drive import Drive, FollowerMaker, make_follower
from deltaviz.machine.horizon import Horizon
from deltaviz.machine.link_status import link_status, waiting_for_answer
from deltaviz.machine.mode import Mode
from deltaviz.machine.picture import Speedometer, finite
from deltaviz.machine.picture import reported as reported_pose
from deltaviz.machine.presses import Presses
from deltaviz.machine.snapshot import LinkStatus, Snapshot
from deltaviz.machine.transitions import AT_REST, MOVING, Event, after
from deltaviz.motion.goal import Rest, ToAngles, ToPoint
from deltaviz.robots import Robot

ARRIVED_XYZ = 0.05  # mm
ARRIVED_THETA = 1e-4  # rad
GIVES_UP_AFTER = 25  # tries without motion, short of the target


@dataclass(frozen=True, slots=True)
class OpenLink:
    """Close the link that is open, if any, and open this one for `robot`."""

    link: str
    robot: Robot


@dataclass(frozen=True, slots=True)
class CloseLink:
    pass


LinkAction = OpenLink | CloseLink


class Core:
    """`robots` loads each robot that may be chosen by its id.

    The caller opens `link`, an id, as `link_action` says. `robot_of` names the robot that has a
    configuration of this hash. Everything that takes `now` takes the same monotonic clock, in
    seconds.
    """

    def __init__(
        self,
        robot: Robot,
        *,
        link: str,
        robots: Mapping[str, Callable[[], Robot]],
        robot_id: str,
        follower: FollowerMaker = make_follower,
        robot_of: Callable[[int], str | None] = lambda _: None,
    ) -> None:
        self.mode = Mode.OFFLINE
        self.robot = robot
        self._robot_id = robot_id
        self._robots = robots
        self._robot_of = robot_of
        self._link = link
        self._link_problem: str | None = None
        self._link_action: LinkAction | None = OpenLink(link, robot)
        self._link_report = LinkReport()
        self._opening = True
        self._estop_owed = False  # to the board that is being connected
        self._acquaintance = Acquaintance()
        self._greeted = False  # the board of this session
        self._note: str | None = None
        self._session: Session | None = None
        self._follower = follower
        self._drive: Drive | None = None
        self._activity: Activity | None = None
        self._aims = False  # the last activity had a target, which a jog has not
        self._control = ControlLease()
        self._presses = Presses()
        self._speeds = Speedometer(robot)
        self._horizon = Horizon()
        self._stop_reason: str | None = None
        self._override = 1.0
        self._underruns = 0
        self._farewell: list[HostMessage] = []

    # The link, which the caller opens and closes.

    def link_action(self) -> LinkAction | None:
        """What the caller is to do with the link now, told once."""
        action, self._link_action = self._link_action, None
        return action

    def link_opened(self, now: float) -> None:
        self._opening = False
        self._greeted = False
        configuration = configure_from(self.robot)
        self._session = Session(
            configuration=configuration,
            digest=configuration_hash(configuration),
            microsteps_per_rad=self.robot.drive.microsteps_per_rad,
            now=now,
            robot_of=self._robot_of,
        )
        self._speeds = Speedometer(self.robot)
        if self._estop_owed:
            self._session.estop(now)
        self._estop_owed = False

    def link_failed(self, problem: str, now: float) -> None:
        """The link could not be opened, or has closed. `problem` says what to do, too."""
        self._opening = self._estop_owed = False
        self._lose(problem, now)

    def receive(
        self, messages: list[BoardMessage], now: float, report: LinkReport | None = None
    ) -> None:
        session = self._session
        self._link_report = report or self._link_report
        if session is None:
            return
        session.impression = self._link_report.impression
        for message in messages:
            session.receive(message, now)
        if session.theta is not None and session.board_time is not None:
            self._speeds.report(session.board_time, session.theta)

    # Stops.

    def stop(self, reason: str, now: float) -> None:
        """A controlled stop, in every mode. The first reason stands until the next motion."""
        if self.mode is not Mode.STOPPING or self._stop_reason is None:
            self._stop_reason = reason
        self._drop_motion(now)
        if self._session is not None:
            self._session.stop(now)
        self._enter(Event.STOP)

    def estop(self, reason: str, now: float) -> None:
        """Drivers off, in every mode; while a link is being opened, as soon as it is."""
        self._stop_reason = reason
        self._drop_motion(now)
        if self._session is not None:
            self._session.estop(now)
        else:
            self._estop_owed = self._opening
        self._enter(Event.ESTOP)

    def _drop_motion(self, now: float) -> None:
        self._presses.stopped(now)
        self._activity = None
        self._drive = None

    def _enter(self, event: Event) -> bool:
        """Take `event` as the table says; whether it was taken."""
        target = after(self.mode, event)
        if target is not None:
            self.mode = target
        return target is not None

    # The control tick.

    def tick(self, now: float) -> list[HostMessage]:
        """One turn of the control loop: the messages to send, in order. Makes one knot at most;
        `hungry` tells whether the next tick is due at once."""
        session = self._session
        self._horizon.turn(now, moving=self.mode in MOVING)
        if session is not None:
            session.tick(now)
            self._watch_board(session, now)
        if self._session is not None:
            self._watch_presses(now)
            self._advance(self._session, now)
            if self.mode in MOVING or self._session.moving:
                self._session.keep(now)
            self._farewell += self._session.take()
        if self.mode in AT_REST:
            self._control.rested()
        out, self._farewell = self._farewell, []
        return out

    def hungry(self, now: float) -> bool:
        if self._drive is None or self.mode not in MOVING:
            return False
        return self._drive.hungry(now, horizon=self._horizon.seconds)

    @property
    def at_rest(self) -> bool:
        """Nothing moves as far as is known, and no stop is waiting for its answer."""
        return self.mode in AT_REST and (self._session is None or not self._session.stopping)

    def _watch_board(self, session: Session, now: float) -> None:
        if session.problem is not None:
            self._lose(session.problem, now)
            return
        if session.refused is not None:
            self._board_refused(session, now)
        if session.never_began:
            self.stop(sentences.NEVER_BEGAN, now)
        if session.ready:
            self._meet(session)
        if (session.ready or session.awaits_reset) and session.settled:
            event = reported(session)
            if event is not None:
                self._board_says(event, session, now)

    def _meet(self, session: Session) -> None:
        if not self._greeted:
            self._greeted = True
            self._note = self._acquaintance.greet(self._link, session)
        self._acquaintance.note(self._link, session)

    def _board_refused(self, session: Session, now: float) -> None:
        refused, session.refused = session.refused, None
        assert refused is not None
        text = sentences.board_refused(refused)
        if refused.command in ("arm", "home") or refused.of_segment:
            self.stop(text, now)  # an epoch that is still open must not outlive it
        else:
            self._stop_reason = text

    def _board_says(self, event: Event, session: Session, now: float) -> None:
        if event in (Event.RESTS_HOMED, Event.RESTS_UNHOMED):
            self._board_rests(event, session, now)
        elif event is Event.BRAKES:
            if self.mode is not Mode.STOPPING:
                self._board_braked(session, now)
            elif not session.stopping:
                session.stop(now)  # what was taken for its answer was a late one, to a stop before
        elif after(self.mode, event) is not self.mode and self._enter(event):
            if event is Event.IS_ESTOPPED:
                self._stop_reason = self._estopped_by(session)
            self._drop_motion(now)

    def _estopped_by(self, session: Session) -> str:
        """Of an e-stop that nobody has asked this program for."""
        telemetry = session.telemetry
        if telemetry is not None and telemetry.fault is Fault.ESTOP_INPUT:
            return sentences.ESTOP_BY_INPUT
        return sentences.STOPPED_BY[StopCause.ESTOP]

    def _board_rests(self, event: Event, session: Session, now: float) -> None:
        if self._drive is not None and session.flight is None and self.mode in MOVING:
            self._board_braked(session, now)  # it halted between two reports
        elif self.mode is Mode.STOPPING:
            if not session.stopping:
                if self._stop_reason is None and session.stopped is not None:
                    cause = session.stopped.cause
                    self._stop_reason = sentences.stopped_by(cause, lossy=session.lossy)
                self._enter(event)
        elif self.mode not in MOVING or self.mode is Mode.HOMING:
            if session.flight is None:
                self._drive = None
            if self.mode is Mode.HOMING and session.stopped is not None:
                self._stop_reason = sentences.stopped_by(session.stopped.cause, lossy=False)
            self._enter(event)

    def _board_braked(self, session: Session, now: float) -> None:
        """The board stopped by itself: make sure of it, and find out why when it rests."""
        if session.stopped is not None:
            cause = session.stopped.cause
            self._stop_reason = sentences.stopped_by(cause, lossy=session.lossy)
        self._drop_motion(now)
        session.stop(now)
        self._enter(Event.BRAKES)

    def _watch_presses(self, now: float) -> None:
        reason = self._presses.lost(now)
        if reason is not None:
            self.stop(reason, now)

    def _advance(self, session: Session, now: float) -> None:
        drive, activity = self._drive, self._activity
        if drive is None or activity is None or self.mode not in _FOLLOWS:
            return
        goal = Rest() if self.mode is Mode.PAUSED else activity.goal
        refused = drive.pull(goal, override=self._override, horizon=self._horizon.seconds, now=now)
        if refused is not None:
            self.stop(f"The guard refused {refused}.", now)
        elif self.mode is not Mode.PAUSED and not activity.held and session.standing:
            self._finish(drive, activity)

    def _finish(self, drive: Drive, activity: Activity) -> None:
        """End an activity that has arrived, or that cannot get any further."""
        short = _short_of(activity, drive)
        if not drive.still or (short is not None and drive.still < GIVES_UP_AFTER):
            return
        if short is not None and self._override == 0.0:
            return
        if short is not None and activity.kind in (Kind.STEP, Kind.MOVE):
            by = "".join(f" {held.limit}." for held in drive.follower.held_by)
            self._stop_reason = f"The robot came to rest {short} short of its target.{by}"
        self._activity = None
        self._enter(Event.RESTS_HOMED if drive.homed else Event.RESTS_UNHOMED)

    def _lose(self, problem: str, now: float) -> None:
        """Give the link up: a last stop, then it is closed."""
        if self.mode in MOVING:
            self._stop_reason = problem
        self._part(now)
        self._link_problem = problem
        self._link_action = CloseLink()
        self._drop_motion(now)
        self._enter(Event.LOST)

    def _part(self, now: float) -> None:
        """End the session with a last stop."""
        if self._session is not None:
            self._session.stop(now)
            self._farewell += self._session.take()
            self._underruns += self._session.underruns
            self._session = None

    # The picture.

    def snapshot(self, now: float) -> Snapshot:
        session, drive = self._session, self._drive
        seen = reported_pose(self.robot, session, self._speeds)
        command_theta, command_xyz = seen.theta, seen.xyz
        target_theta, target_xyz = seen.theta, seen.xyz
        held_by = ()
        if drive is not None and drive.homed:
            follower = drive.follower
            command_theta, command_xyz = finite(follower.theta), finite(follower.xyz)
            target_theta, target_xyz = command_theta, command_xyz
            if self._aims:
                target_theta = finite(follower.target_theta)
                target_xyz = finite(follower.target_xyz)
            held_by = follower.held_by
        telemetry = None if session is None else session.telemetry
        fault = None if telemetry is None else telemetry.fault
        link = link_status(
            self._link,
            session,
            self._link_report,
            opening=self._opening,
            problem=self._link_problem,
            note=self._note,
            now=now,
        )
        return Snapshot(
            at=now,
            robot=self._robot_id,
            mode=self.mode,
            homed=session is not None and session.homed,
            theta=seen.theta,
            xyz=seen.xyz,
            theta_speed=seen.theta_speed,
            xyz_speed=seen.xyz_speed,
            command_theta=command_theta,
            command_xyz=command_xyz,
            target_theta=target_theta,
            target_xyz=target_xyz,
            margins=seen.margins,
            held_by=held_by,
            link=link,
            holder=self._control.holder,
            stop_reason=self._stop_reason,
            fault=sentences.FAULT[fault] if self.mode is Mode.FAULT and fault else None,
            override=self._override,
            next_step=self._next_step(link),
            board_time=None if session is None else session.board_time,
            underruns=self._underruns + (0 if session is None else session.underruns),
            counts=telemetry.counts if telemetry is not None and telemetry.counts else None,
        )

    def _next_step(self, link: LinkStatus) -> str | None:
        waiting = waiting_for_answer(link) if self.mode is Mode.OFFLINE else None
        return waiting or sentences.NEXT_STEP.get(self.mode)


_FOLLOWS = frozenset({Mode.JOGGING, Mode.MOVING, Mode.RUNNING, Mode.PAUSED})


def _short_of(activity: Activity, drive: Drive) -> str | None:
    """How far the command is from the activity's target, or None when it is there."""
    goal, follower = activity.goal, drive.follower
    angle = 0.0
    if isinstance(goal, ToPoint):
        distance = math.dist(goal.xyz, follower.xyz)
        if distance > ARRIVED_XYZ:
            return f"{distance:.2f} mm"
        angle = 0.0 if goal.tool is None else abs(goal.tool - follower.theta[-1])
    elif isinstance(goal, ToAngles):
        angle = max(abs(a - b) for a, b in zip(goal.theta, follower.theta, strict=True))
    return None if angle <= ARRIVED_THETA else f"{math.degrees(angle):.2f}°"
