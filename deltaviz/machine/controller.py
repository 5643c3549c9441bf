"""The owner of what the robot does: takes what people ask for, in the order it comes.

Every intent is checked for control, then for the mode, then for its values; what is refused
changes nothing. Stops are never refused.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace

from deltaviz.link.links import is_link_id
from deltaviz.link.messages import BoardState
from deltaviz.link.report import LinkReport
from deltaviz.link.timing import STALE
from deltaviz.machine import intent as i
from deltaviz.machine.activity import Kind
from deltaviz.machine.core import CloseLink, Core, OpenLink
from deltaviz.machine.drive import Drive
from deltaviz.machine.mode import Mode
from deltaviz.machine.picture import tip
from deltaviz.machine.requests import (
    BadValue,
    MotionIntent,
    Pose,
    activity_for,
    drag_goal,
    event_of,
    jog_goal,
)
from deltaviz.machine.transitions import AT_REST, MOVING, Event, after, refusal
from deltaviz.motion.goal import AtJointVelocity, AtVelocity, Goal
from deltaviz.robots import Robot, RobotFileError

OVERRIDE_MAX = 1.5
ACCEPTED = i.Accepted()
NOT_READY = "The board is not ready yet; press again."
POSE_LOST = "The robot does not know its pose any more; home it, then move it."
ENDED = i.Refused(i.RefusalKind.MODE, "This press has ended; press again.")

Command = (
    i.Enable | i.Disable | i.Home | i.Reset | i.Pause | i.Resume
    | i.Connect | i.Disconnect | i.SelectRobot
)  # fmt: skip
_EVENTS: Mapping[type, Event] = {
    i.Enable: Event.ENABLE,
    i.Disable: Event.DISABLE,
    i.Home: Event.HOME,
    i.Reset: Event.RESET,
    i.Pause: Event.PAUSE,
    i.Resume: Event.RESUME,
    i.Connect: Event.CONNECT,
    i.Disconnect: Event.DISCONNECT,
    i.SelectRobot: Event.SELECT_ROBOT,
}


class Controller(Core):
    def handle(self, intent: i.Intent, now: float) -> i.Answer:
        try:
            return self._handle(intent, now)
        except BadValue as error:
            return i.Refused(i.RefusalKind.VALUE, str(error))

    def _handle(self, intent: i.Intent, now: float) -> i.Answer:
        match intent:
            case i.Stop():
                self.stop(intent.reason, now)
                return ACCEPTED
            case i.EStop():
                self.estop(intent.reason, now)
                return ACCEPTED
            case i.JogBeat():
                return self._jog_beat(intent)
            case i.DragTo():
                return self._drag_to(intent)
            case i.JogEnd() | i.DragEnd() | i.DragAlive():
                self._press_news(intent)
                return ACCEPTED
            case i.ClientHere() | i.ClientGone():
                self._client_news(intent, now)
                return ACCEPTED
            case i.RequestControl() | i.ReleaseControl():
                return self._change_control(intent)
            case i.SetOverride():
                return self._set_override(intent)
            case (
                i.Enable() | i.Disable() | i.Home() | i.Reset() | i.Pause() | i.Resume()
                | i.Connect() | i.Disconnect() | i.SelectRobot()
            ):  # fmt: skip
                return self._command(intent, now)
            case _:
                return self._move(intent, now)

    def _move(self, intent: MotionIntent, now: float) -> i.Answer:
        """Begin, or go over to, what a motion intent asks for."""
        event = event_of(intent)
        fresh = self._is_fresh(intent, now)  # counts what is refused below, too: it is one pull
        refused = self._refusal(intent.client, event) or self._held_refusal(intent)
        if refused is not None:
            return refused
        if not fresh:
            return i.Refused(i.RefusalKind.MODE, "The robot was stopped; let go, then pull again.")
        pose = self._pose()
        if event is not Event.JOG_JOINTS and not pose.known:
            return i.Refused(i.RefusalKind.MODE, POSE_LOST)
        activity = activity_for(intent, self.robot, pose, self._activity)
        if isinstance(intent, i.JogStart | i.DragStart):
            late = self._presses.begin(intent, now)
            if late is not None:
                return i.Refused(i.RefusalKind.MODE, late)
        not_ready = self._open_drive(now)
        if not_ready is not None:
            self._break_off(not_ready, now)
            return i.Refused(i.RefusalKind.MODE, not_ready)
        self._control.take(intent.client)
        self._activity = activity
        self._aims = activity.kind is not Kind.JOG
        self._stop_reason = self._note = None
        self._enter(event)
        return ACCEPTED

    def _is_fresh(self, intent: MotionIntent, now: float) -> bool:
        """Whether no stop came since the pull began that this belongs to."""
        pulled = isinstance(intent, i.FollowPoint | i.FollowAngles)
        return not pulled or self._presses.admits_value(intent.client, now)

    def _break_off(self, reason: str, now: float) -> None:
        """A press that begins nothing has still ended the one before: what that one held has
        nobody to keep it alive or to let it go any more, so it stops."""
        if self._activity is not None and self._activity.held:
            self.stop(reason, now)
        else:
            self._presses.stopped(now)

    def _held_refusal(self, intent: MotionIntent) -> i.Refused | None:
        same = (self._presses.jog.live and isinstance(intent, i.JogStart)) or (
            self._presses.drag.live and isinstance(intent, i.DragStart)
        )
        if not self._presses.held or same:
            return None
        return i.Refused(i.RefusalKind.MODE, "A jog or drag is held; let go first.")

    def _open_drive(self, now: float) -> str | None:
        """A drive to move with: the open one, or one on a new epoch. Why not, or None."""
        session = self._session
        if session is None or session.telemetry is None or (session.age(now) or 0.0) >= STALE:
            return "The board is silent; wait, then press again."
        if self._drive is not None and session.flight is not None:
            return None
        halted = session.telemetry.state is BoardState.HALTED and session.standing
        if not halted or session.theta is None:
            return NOT_READY
        self._drive = Drive(self.robot, session, homed=session.homed, follower=self._follower)
        return None

    def _pose(self) -> Pose:
        """Where the command stands; NaN where the robot does not know."""
        if self._drive is not None and self._drive.homed:
            follower = self._drive.follower
            return Pose(tuple(map(float, follower.xyz)), tuple(map(float, follower.theta)))
        session = self._session
        theta = session.theta if session is not None and session.homed else None
        xyz = None if theta is None else tip(self.robot, theta)
        return Pose(
            xyz or (math.nan,) * len(self.robot.axes),
            theta or (math.nan,) * self.robot.joint_count,
        )

    def _jog_beat(self, beat: i.JogBeat) -> i.Answer:
        if not self._presses.jog_beat(beat):
            live = self._presses.jog.is_live(beat.client, beat.id)
            return ACCEPTED if live else ENDED
        if self._activity is not None and self._activity.kind is Kind.JOG:
            joints = isinstance(self._activity.goal, AtJointVelocity)
            frame = i.JogFrame.JOINTS if joints else i.JogFrame.BASE
            goal = jog_goal(frame, beat.velocity, self.robot)
            self._activity = replace(self._activity, goal=goal)
        return ACCEPTED

    def _drag_to(self, intent: i.DragTo) -> i.Answer:
        if not self._presses.drag.is_live(intent.client) or self._activity is None:
            return ENDED
        self._activity = replace(self._activity, goal=drag_goal(intent.xyz, self.robot))
        return ACCEPTED

    def _press_news(self, intent: i.JogEnd | i.DragEnd | i.DragAlive) -> None:
        """Letting go is no stop: a jog slows down, a drag's last target is still reached."""
        presses, activity = self._presses, self._activity
        match intent:
            case i.DragAlive():
                presses.drag_alive(intent)
            case i.DragEnd():
                if presses.drag.is_live(intent.client) and activity is not None:
                    presses.drag.end()
                    self._activity = replace(activity, held=False)
            case i.JogEnd():
                if presses.jog.is_live(intent.client, intent.id) and activity is not None:
                    presses.jog.end()
                    self._activity = replace(activity, goal=_slowed(activity.goal), held=False)

    def _client_news(self, intent: i.ClientHere | i.ClientGone, now: float) -> None:
        """Who moves the robot and is gone can no longer watch it: it stops."""
        if isinstance(intent, i.ClientHere):
            self._control.here(intent.client)
            self._presses.arrived(intent.client)
            return
        self._presses.forget(intent.client)
        if self._control.gone(intent.client) and self.mode in MOVING:
            self.stop("The page that moved the robot was closed, or lost its connection.", now)

    def _change_control(self, intent: i.RequestControl | i.ReleaseControl) -> i.Answer:
        at_rest = self.mode in AT_REST
        if isinstance(intent, i.RequestControl):
            refused = self._control.request(intent.client, at_rest=at_rest)
        else:
            refused = self._control.release(intent.client, at_rest=at_rest)
        return ACCEPTED if refused is None else i.Refused(i.RefusalKind.CONTROL, refused)

    def _set_override(self, intent: i.SetOverride) -> i.Answer:
        refused = self._control.refusal(intent.client, at_rest=self.mode in AT_REST)
        if refused is not None:
            return i.Refused(i.RefusalKind.CONTROL, refused)
        if not 0.0 <= intent.value <= OVERRIDE_MAX:
            raise BadValue(f"The override is a share from 0 to {OVERRIDE_MAX:g}.")
        self._control.take(intent.client)
        self._override = intent.value
        return ACCEPTED

    def objection(self, intent: i.SelectRobot) -> i.Refused | None:
        """Why another robot may not be chosen now, or None."""
        return self._refusal(intent.client, _EVENTS[type(intent)])

    def _refusal(self, client: str, event: Event) -> i.Refused | None:
        """Why `client` may not ask for `event` now, or None."""
        refused = self._control.refusal(client, at_rest=self.mode in AT_REST)
        if self._control.holder is not None and refused is not None:
            return i.Refused(i.RefusalKind.CONTROL, refused)
        for mode in self._rows():
            if after(mode, event) is None:
                return i.Refused(i.RefusalKind.MODE, refusal(mode, event))
        return None if refused is None else i.Refused(i.RefusalKind.CONTROL, refused)

    def _rows(self) -> tuple[Mode, ...]:
        """The modes that must all take an event: while an unhomed robot creeps, both its own."""
        creeps = self.mode is Mode.JOGGING and self._drive is not None and not self._drive.homed
        return (self.mode, Mode.UNHOMED) if creeps else (self.mode,)

    def _command(self, intent: Command, now: float) -> i.Answer:
        event = _EVENTS[type(intent)]
        refused = self._refusal(intent.client, event)
        if refused is not None:
            return refused
        if isinstance(intent, i.Connect | i.Disconnect | i.SelectRobot):
            self._change_link(intent, now)
        elif isinstance(intent, i.Home) and self._session is not None and self._session.stopping:
            return i.Refused(i.RefusalKind.MODE, NOT_READY)
        else:
            self._command_board(intent, now)
        self._control.take(intent.client)
        self._enter(event)
        return ACCEPTED

    def _command_board(
        self, intent: i.Enable | i.Disable | i.Home | i.Reset | i.Pause | i.Resume, now: float
    ) -> None:
        session = self._session
        if session is None:
            return
        match intent:
            case i.Enable():
                if self.mode is Mode.DISABLED:
                    session.enable(now, on=True)
            case i.Disable():
                self._drop_motion(now)
                session.enable(now, on=False)
            case i.Home():
                self._drop_motion(now)
                self._stop_reason = self._note = None
                session.home(now)
            case i.Reset():
                self._stop_reason = None
                session.reset(now)
            case i.Pause() | i.Resume():
                pass  # the mode says it all

    def _change_link(self, intent: i.Connect | i.Disconnect | i.SelectRobot, now: float) -> None:
        """Raises BadValue, with nothing changed, for a robot that is none or no link's id."""
        action = CloseLink()
        match intent:
            case i.Connect():
                if not is_link_id(intent.link):
                    raise BadValue("A link is chosen by its id, from the list of links.")
                self._link = intent.link
                action = OpenLink(intent.link, self.robot)
            case i.SelectRobot():
                self.robot = self._load(intent.robot)
                self._robot_id = intent.robot
                if self._session is not None or self._opening:
                    action = OpenLink(self._link, self.robot)
            case i.Disconnect():
                pass
        self._drop_motion(now)
        self._part(now)
        self._link_problem = None
        self._link_report = LinkReport()
        self._stop_reason = self._note = None
        self._link_action = action
        self._opening = isinstance(action, OpenLink)
        self._estop_owed = self._estop_owed and self._opening

    def _load(self, robot_id: str) -> Robot:
        load = self._robots.get(robot_id)
        if load is None:
            known = ", ".join(self._robots)
            raise BadValue(f"There is no robot '{robot_id}'; there is: {known}.")
        try:
            return load()
        except RobotFileError as error:
            raise BadValue(str(error)) from error


def _slowed(goal: Goal) -> Goal:
    """What a jog becomes when it is let go."""
    if isinstance(goal, AtJointVelocity):
        return AtJointVelocity(tuple(0.0 for _ in goal.theta))
    if isinstance(goal, AtVelocity):
        return AtVelocity(tuple(0.0 for _ in goal.xyz))
    return goal
