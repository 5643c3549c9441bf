"""What one page's socket says, turned into intents. No waiting happens here.

`hear` is called for each message as it is read. A stop is acted on within that call; all else
is posted and answered later, so nothing that the controller does delays the next message.
"""

from __future__ import annotations

import logging
import secrets
import time
from collections import OrderedDict
from collections.abc import Callable
from concurrent.futures import Future
from dataclasses import dataclass
from enum import Enum, auto
from typing import Any

from pydantic import ValidationError

from deltaviz.machine import intent
from deltaviz.machine.port import MachinePort
from deltaviz.web import messages
from deltaviz.web.axes import AxesError, from_camera, to_robot_angles, to_robot_point
from deltaviz.web.faults import sentence
from deltaviz.web.once import OncePerMinute
from deltaviz.web.pace import Allowance
from deltaviz.web.scene_port import ScenePort

log = logging.getLogger(__name__)

MAX_MESSAGE = 16 * 1024  # characters
MESSAGES_BURST, MESSAGES_PER_SECOND = 200.0, 200.0  # a page sends a few a second
BEATS_BURST, BEATS_PER_SECOND = 100.0, 100.0  # and 20 signs of life while something is held
ERRORS_BURST, ERRORS_PER_SECOND = 30.0, 1.0
_PRESSES_KEPT = 8
_STOP = 'stop"'  # in every text that a page sends as one
_STOP_PAGE, _ESTOP_PAGE = "Stop was pressed", "E-stop was pressed"

Reply = dict[str, Any]


class Verdict(Enum):
    GO_ON = auto()
    HANG_UP = auto()  # this page sends nothing but errors


@dataclass(frozen=True)
class Press:
    """A held jog: in which frame, and the camera's yaw (rad) when it began."""

    frame: messages.Frame
    yaw: float


class Conversation:
    """One socket's side of the talk.

    `reply` is called from any thread with what the page is to be told.
    """

    def __init__(
        self,
        *,
        machine: MachinePort,
        client: str,
        reply: Callable[[Reply], None],
        scene: ScenePort,
        logged: OncePerMinute,
    ) -> None:
        self._machine = machine
        self._client = client
        self._reply = reply
        self._scene = scene
        self._logged = logged
        self._messages = Allowance(burst=MESSAGES_BURST, per_second=MESSAGES_PER_SECOND)
        self._beats = Allowance(burst=BEATS_BURST, per_second=BEATS_PER_SECOND)
        self._errors = Allowance(burst=ERRORS_BURST, per_second=ERRORS_PER_SECOND)
        self._complaints = Allowance(burst=1, per_second=1)
        self._clock = secrets.token_hex(8)  # two tabs of a session have two clocks
        self._presses: OrderedDict[str, Press] = OrderedDict()

    def hear(self, text: str | None, now: float | None = None) -> Verdict:
        """Act on one message; None is one that was not text. `now`: monotonic time, s."""
        now = time.monotonic() if now is None else now
        if not self._has_room(text, now):
            self._complain(now)
            return Verdict.GO_ON
        if text is None or len(text) > MAX_MESSAGE:
            return self._malformed(f"Send text of at most {MAX_MESSAGE // 1024} KiB.", now)
        try:
            message = messages.PAGE_MESSAGE.validate_json(text)
        except ValidationError as error:
            return self._malformed(_what_is_wrong(error), now)
        if self._only_looked_like_a_stop(text, message) and not self._has_turn(text, now):
            self._complain(now)
            return Verdict.GO_ON
        try:
            self._act(message, now)
        except AxesError as error:
            self._refused(message, str(error))
        return Verdict.GO_ON

    def _has_room(self, text: str | None, now: float) -> bool:
        """A flood of anything delays no stop: what looks like one is read before it is counted."""
        start = (text or "")[:MAX_MESSAGE]
        return _STOP in start or self._has_turn(start, now)

    def _has_turn(self, text: str, now: float) -> bool:
        """Nor does it starve a held jog of its beats."""
        is_beat = '"jog' in text or '"drag_alive' in text
        return (self._beats if is_beat else self._messages).take(now)

    def _only_looked_like_a_stop(self, text: str, message: messages.PageMessage) -> bool:
        return _STOP in text and not isinstance(message, messages.Stop | messages.EStop)

    def _act(self, message: messages.PageMessage, now: float) -> None:
        client = self._client
        match message:
            case messages.Stop():
                self._machine.stop(client, _STOP_PAGE)
            case messages.EStop():
                self._machine.estop(client, _ESTOP_PAGE)
            case messages.JogStart():
                self._begin_jog(message, now)
            case messages.Jog():
                self._beat(message, now)
            case messages.JogEnd():
                self._presses.pop(message.id, None)
                self._post(message, intent.JogEnd(client, message.id))
            case messages.DragAlive():
                clock = self._clock
                beat = intent.DragAlive(client, message.seq, message.t_ms, now, clock)
                self._post(message, beat)
            case messages.SetOverride():
                self._post(message, intent.SetOverride(client, message.value))
            case messages.Theme():
                self._scene.set_theme(client, message.dark)
            case messages.Show():
                self._scene.choose(
                    client, message.item, message.value, lambda why: self._refused(message, why)
                )
            case messages.Control(action="request"):
                self._post(message, intent.RequestControl(client))
            case messages.Control():
                self._post(message, intent.ReleaseControl(client))

    def _begin_jog(self, message: messages.JogStart, now: float) -> None:
        yaw = self._scene.camera_yaw(self._client) if message.frame == "camera" else 0.0
        if yaw is None:
            self._refused(message, "The scene is not open, so it has no view; jog along the base.")
            return
        press = Press(message.frame, yaw)
        velocity = self._velocity(message, press)
        self._presses[message.id] = press
        if len(self._presses) > _PRESSES_KEPT:
            self._presses.popitem(last=False)
        frame = intent.JogFrame.JOINTS if press.frame == "joints" else intent.JogFrame.BASE
        self._post(message, intent.JogStart(self._client, message.id, frame, velocity, now))

    def _beat(self, message: messages.Jog, now: float) -> None:
        press = self._presses.get(message.id)
        if press is None:
            self._refused(message, "This jog is over, or never began; press again.")
            return
        velocity = self._velocity(message, press)
        self._post(
            message,
            intent.JogBeat(
                self._client, message.id, message.seq, message.t_ms, velocity, now, self._clock
            ),
        )

    def _velocity(
        self, message: messages.JogStart | messages.Jog, press: Press
    ) -> tuple[float, ...]:
        robot = self._machine.robot
        if press.frame == "joints":
            if message.v_deg_s is None:
                raise AxesError("v_deg_s is missing: this jog began in the frame 'joints'.")
            return to_robot_angles(robot, message.v_deg_s, field="v_deg_s")
        if message.v_mm_s is None:
            raise AxesError(f"v_mm_s is missing: this jog began in the frame '{press.frame}'.")
        velocity = from_camera(robot, message.v_mm_s, press.yaw)
        return to_robot_point(robot, velocity, field="v_mm_s")

    def _post(self, message: messages.PageMessage, wish: intent.Intent) -> None:
        def answered(future: Future[intent.Answer]) -> None:
            if future.cancelled() or future.exception() is not None:
                self._refused(message, "The controller does not answer.")
                return
            answer = future.result()
            if isinstance(answer, intent.Refused):
                self._refused(message, answer.detail)

        self._machine.post(wish).add_done_callback(answered)

    def _refused(self, message: messages.PageMessage, detail: str) -> None:
        to = getattr(message, "id", None)
        self._reply({"type": "refused", "to": message.type, "id": to, "detail": detail})

    def _malformed(self, detail: str, now: float) -> Verdict:
        if self._logged.may_say((self._client, "malformed")):
            log.warning("A page sent a message that cannot be read: %s", detail)
        self._reply({"type": "error", "detail": detail})
        return Verdict.GO_ON if self._errors.take(now) else Verdict.HANG_UP

    def _complain(self, now: float) -> None:
        if not self._complaints.take(now):
            return
        if self._logged.may_say((self._client, "flood")):
            log.warning("A page sends too much; all but its stops is dropped.")
        detail = f"Too many messages; about {MESSAGES_PER_SECOND:g} a second are read."
        self._reply({"type": "error", "detail": detail})


def _what_is_wrong(error: ValidationError) -> str:
    first = error.errors(include_url=False)
    if first[0]["type"] in ("union_tag_invalid", "union_tag_not_found"):
        return f"'type' must be one of {', '.join(messages.TYPES)}."
    return sentence(first, tags=messages.TYPES)
