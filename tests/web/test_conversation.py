"""What a page says, message by message: intents out, or a sentence back; never a wait."""

from __future__ import annotations

import json
import logging
import math
from collections.abc import Callable
from typing import Any

import pytest

from deltaviz.machine import intent
from deltaviz.machine.intent import JogFrame, RefusalKind, Refused
from deltaviz.web.conversation import MAX_MESSAGE, Conversation, Verdict
from deltaviz.web.once import OncePerMinute

NOW = 1000.0
START = {"type": "jog_start", "id": "p1", "frame": "base", "v_mm_s": [10, 0, -5]}
BEAT = {"type": "jog", "id": "p1", "seq": 1, "t_ms": 12.5, "v_mm_s": [10, 0, -5]}


class Page:
    def __init__(self, machine: Any, scene: Any) -> None:
        self.told_back: list[dict[str, Any]] = []
        self.conversation = Conversation(
            machine=machine,
            client="me",
            reply=self.told_back.append,
            scene=scene,
            logged=OncePerMinute(),
        )

    def says(self, *messages: Any, now: float = NOW) -> Verdict:
        verdicts = [
            self.conversation.hear(m if isinstance(m, str | None) else json.dumps(m), now)
            for m in messages
        ]
        return verdicts[-1]


@pytest.fixture
def page(machine: Any, scene: Any) -> Page:
    return Page(machine, scene)


@pytest.mark.parametrize(
    ("message", "told"),
    [
        ({"type": "stop"}, ("stop", "me")),
        ({"type": "estop"}, ("estop", "me")),
        ({"type": "stop", "id": "p1", "t_ms": -1}, ("stop", "me")),
        ({"type": "estop", "why": None}, ("estop", "me")),
        (START, intent.JogStart("me", "p1", JogFrame.BASE, (10, 0, -5), NOW)),
        (
            {"type": "jog_start", "id": "a-b_C", "frame": "joints", "v_deg_s": [0, 180, 0]},
            intent.JogStart("me", "a-b_C", JogFrame.JOINTS, (0, math.pi, 0), NOW),
        ),
        ({"type": "jog_end", "id": "p1"}, intent.JogEnd("me", "p1")),
        ({"type": "override", "value": 1.5}, intent.SetOverride("me", 1.5)),
        ({"type": "override", "value": 0}, intent.SetOverride("me", 0)),
        ({"type": "control", "action": "request"}, intent.RequestControl("me")),
        ({"type": "control", "action": "release"}, intent.ReleaseControl("me")),
    ],
)
def test_a_message_becomes_an_intent(page: Page, machine: Any, message: Any, told: Any) -> None:
    assert page.says(message) is Verdict.GO_ON
    assert machine.told == [told]
    assert page.told_back == []


def test_signs_of_life_carry_the_page_s_clock_and_ours(page: Page, machine: Any) -> None:
    page.says(START, BEAT, {"type": "drag_alive", "seq": 3, "t_ms": 99.5})
    _, beat, drag = machine.told
    assert (beat.id, beat.seq, beat.sent_ms, beat.at) == ("p1", 1, 12.5, NOW)
    assert beat.velocity == (10, 0, -5)
    assert (drag.seq, drag.sent_ms, drag.at) == (3, 99.5, NOW)
    assert beat.clock == drag.clock


def test_two_tabs_of_a_session_have_two_clocks(machine: Any, scene: Any) -> None:
    for tab in (Page(machine, scene), Page(machine, scene)):
        tab.says({"type": "drag_alive", "seq": 1, "t_ms": 5})
    one, other = machine.told
    assert one.client == other.client
    assert one.clock != other.clock


def test_a_beat_keeps_the_frame_of_its_press(page: Page, machine: Any) -> None:
    page.says({"type": "jog_start", "id": "j", "frame": "joints", "v_deg_s": [1, 0, 0]})
    page.says({**BEAT, "id": "j"})
    assert page.told_back[-1]["type"] == "refused"
    assert len(machine.told) == 1


def test_a_beat_without_a_press_is_refused(page: Page, machine: Any) -> None:
    page.says(BEAT)
    page.says(START, {"type": "jog_end", "id": "p1"}, BEAT)
    assert [told["to"] for told in page.told_back] == ["jog", "jog"]
    assert not machine.told_of(intent.JogBeat)


@pytest.mark.parametrize(
    ("yaw_deg", "seen", "meant"),
    [
        (0, [1, 2, 3], [1, 2, 3]),
        (90, [1, 0, 0], [0, 1, 0]),  # the viewer's right is the base's +Y
        (90, [0, 1, 0], [-1, 0, 0]),
        (180, [5, 0, 7], [-5, 0, 7]),
        (-30, [0, 10, 0], [5, 10 * math.cos(math.radians(30)), 0]),
    ],
)
def test_the_camera_s_frame_is_turned_into_the_base_s(
    page: Page, machine: Any, scene: Any, yaw_deg: float, seen: list[float], meant: list[float]
) -> None:
    scene.yaw = math.radians(yaw_deg)
    page.says({"type": "jog_start", "id": "p1", "frame": "camera", "v_mm_s": seen})
    scene.yaw = 1.0  # the view turns on; the held jog does not
    page.says({**BEAT, "v_mm_s": seen})
    assert machine.told[0].frame is JogFrame.BASE
    for told in machine.told:
        assert told.velocity == pytest.approx(meant, abs=1e-9)


def test_without_a_view_there_is_no_camera_frame(page: Page, machine: Any) -> None:
    page.says({"type": "jog_start", "id": "p1", "frame": "camera", "v_mm_s": [1, 0, 0]})
    assert machine.told == []
    assert page.told_back[0]["to"] == "jog_start"
    assert page.told_back[0]["id"] == "p1"


def test_the_theme_is_the_scene_s(page: Page, scene: Any, machine: Any) -> None:
    page.says({"type": "theme", "dark": True})
    assert scene.themes == [("me", True)]
    assert machine.told == []


@pytest.mark.parametrize("value", [True, False, 0, -12.5, "", "0 0 -300"])
def test_what_the_view_is_to_show_is_chosen_in_the_scene(
    page: Page, scene: Any, machine: Any, value: object
) -> None:
    page.says({"type": "show", "item": "Workspace: Reach", "value": value})
    ((session, key, chosen),) = scene.chosen
    assert (session, key) == ("me", "Workspace: Reach")
    assert chosen == value
    assert isinstance(chosen, bool) == isinstance(value, bool)
    assert page.told_back == []
    assert machine.told == []


def test_what_the_scene_does_not_take_is_refused_with_its_words(page: Page, scene: Any) -> None:
    scene.refusal = "The scene is not open."
    page.says({"type": "show", "item": "Workspace: Reach", "value": True})
    (told,) = page.told_back
    assert (told["type"], told["to"]) == ("refused", "show")
    assert told["detail"] == "The scene is not open."


def test_a_refusal_comes_back_with_what_it_answers(page: Page, machine: Any) -> None:
    machine.answer = Refused(RefusalKind.CONTROL, "Another page controls the robot.")
    page.says(START)
    assert page.told_back == [
        {
            "type": "refused",
            "to": "jog_start",
            "id": "p1",
            "detail": "Another page controls the robot.",
        }
    ]


def test_a_dead_controller_is_told(page: Page, machine: Any) -> None:
    machine.answer = BrokenPipeError()
    page.says({"type": "override", "value": 1})
    assert "controller" in page.told_back[0]["detail"]


MALFORMED: list[tuple[str | None, str]] = [
    (None, "text"),
    ("", "JSON"),
    ("{", "JSON"),
    ("[" * 9000, "JSON"),
    ("nonsense", "JSON"),
    ("null", "object"),
    ("[]", "object"),
    ("7", "object"),
    ('"stop"', "object"),
    ("{}", "'type' must be one of"),
    ('{"type": "fly"}', "'type' must be one of"),
    ('{"type": 7}', "'type' must be one of"),
    ('{"type": null}', "'type' must be one of"),
    ('{"type": "jog_end", "id": "a", "why": 1}', "why"),
    ('{"type": "jog_start"}', "id"),
    (json.dumps({**START, "id": ""}), "id"),
    (json.dumps({**START, "id": "a" * 65}), "id"),
    (json.dumps({**START, "id": "a b"}), "id"),
    (json.dumps({**START, "id": 7}), "id"),
    (json.dumps({**START, "frame": "world"}), "frame"),
    (json.dumps({**START, "frame": "joints"}), "v_deg_s"),
    (json.dumps({**START, "v_mm_s": [1, 2]}), "v_mm_s"),
    (json.dumps({**START, "v_mm_s": [1, 2, 3, 4]}), "v_mm_s"),
    (json.dumps({**START, "v_mm_s": [1, 2, math.nan]}), "v_mm_s[2]"),
    (json.dumps({**START, "v_mm_s": [1, 2, math.inf]}), "v_mm_s[2]"),
    (json.dumps({**START, "v_mm_s": [1, 2, 1e300]}), "v_mm_s[2]"),
    (json.dumps({**START, "v_mm_s": [1, 2, "3"]}), "v_mm_s[2]"),
    (json.dumps({**START, "v_mm_s": [1, 2, True]}), "v_mm_s[2]"),
    (json.dumps({**START, "v_deg_s": [1, 2, 3]}), "either"),
    (json.dumps({**BEAT, "seq": -1}), "seq"),
    (json.dumps({**BEAT, "seq": 1.5}), "seq"),
    (json.dumps({**BEAT, "t_ms": math.nan}), "t_ms"),
    (json.dumps({**BEAT, "t_ms": None}), "t_ms"),
    ('{"type": "override", "value": 1.51}', "value"),
    ('{"type": "override", "value": -0.1}', "value"),
    ('{"type": "override", "value": NaN}', "value"),
    ('{"type": "override"}', "value"),
    ('{"type": "control", "action": "steal"}', "action"),
    ('{"type": "theme", "dark": 1}', "dark"),
    ('{"type": "show", "item": "Reach"}', "value"),
    ('{"type": "show", "item": "Reach", "value": null}', "value"),
    ('{"type": "show", "item": "Reach", "value": NaN}', "value"),
    ('{"type": "show", "item": "Reach", "value": Infinity}', "value"),
    ('{"type": "show", "item": "Reach", "value": [1]}', "value"),
    (json.dumps({"type": "show", "item": "Point", "value": "1" * 201}), "value"),
    ('{"type": "show", "item": "", "value": true}', "item"),
    (json.dumps({"type": "show", "item": "a" * 81, "value": True}), "item"),
    ('{"type": "show", "item": 3, "value": true}', "item"),
    ('{"type": "jog_end", "id": "' + "a" * MAX_MESSAGE + '"}', "KiB"),
]


@pytest.mark.parametrize(("text", "named"), MALFORMED)
def test_malformed_is_told_and_reaches_nobody(
    page: Page, machine: Any, text: str | None, named: str
) -> None:
    assert page.says(text) is Verdict.GO_ON
    (told,) = page.told_back
    assert told.keys() == {"type", "detail"}
    assert told["type"] == "error"
    assert named in told["detail"]
    assert len(told["detail"]) < 300
    assert machine.told == []


def test_the_number_of_joints_is_the_robot_s(page: Page, machine: Any) -> None:
    page.says({"type": "jog_start", "id": "p", "frame": "joints", "v_deg_s": [1, 2]})
    assert machine.told == []
    assert "3 numbers" in page.told_back[0]["detail"]


def test_errors_without_end_hang_up_and_are_logged_once(
    page: Page, caplog: pytest.LogCaptureFixture
) -> None:
    with caplog.at_level(logging.WARNING):
        verdicts = [page.says("nonsense", now=NOW + n / 1000) for n in range(100)]
    assert verdicts[0] is Verdict.GO_ON
    assert verdicts[-1] is Verdict.HANG_UP
    assert len(caplog.records) == 1


def test_an_error_now_and_then_is_borne(page: Page) -> None:
    for n in range(1000):
        assert page.says("nonsense", now=NOW + 2 * n) is Verdict.GO_ON


FLOODS: list[Callable[[int], Any]] = [
    lambda n: {"type": "override", "value": 1},
    lambda n: {"type": "control", "action": "request"},
    lambda n: {**BEAT, "seq": n},
    lambda n: {**START, "id": f"{n}-stop"},  # which is none
    lambda n: {"type": "jog_end", "id": "estop"},
    lambda n: "nonsense",
]


def flooded(page: Page, machine: Any, flood: Callable[[int], Any]) -> int:
    """The stops that arrive of fifty, among 5000 other messages in one second."""
    page.says(START)
    for n in range(5000):
        page.says(flood(n), now=NOW + n / 5000)
        if n % 100 == 99:
            page.says({"type": "stop"}, now=NOW + n / 5000)
    return machine.told.count(("stop", "me"))


@pytest.mark.parametrize("flood", FLOODS)
def test_a_flood_reaches_the_controller_as_a_trickle_and_every_stop_does(
    page: Page, machine: Any, flood: Callable[[int], Any]
) -> None:
    assert flooded(page, machine, flood) == 50
    assert len(machine.told) - 50 < 500
    assert len(page.told_back) < 1000


def test_a_stop_that_had_to_wait_its_turn_would_be_seen(
    page: Page, machine: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    in_turn = lambda self, text, now: self._messages.take(now)  # noqa: E731
    monkeypatch.setattr(Conversation, "_has_room", in_turn)
    assert flooded(page, machine, FLOODS[0]) < 50


def test_a_flood_does_not_starve_a_held_jog(page: Page, machine: Any) -> None:
    page.says(START)
    for n in range(5000):
        page.says({"type": "override", "value": 1}, now=NOW + n / 5000)
        if n % 250 == 0:
            page.says({**BEAT, "seq": n}, now=NOW + n / 5000)
    assert len(machine.told_of(intent.JogBeat)) == 20


def test_a_stop_is_told_before_hear_returns(page: Page, machine: Any) -> None:
    machine.answer = None  # the controller answers nothing
    page.says({"type": "override", "value": 1}, {"type": "stop"})
    assert machine.told[-1] == ("stop", "me")


def test_what_was_logged_is_logged_again_after_a_minute() -> None:
    now = [0.0]
    once = OncePerMinute(clock=lambda: now[0])
    assert once.may_say("a")
    assert once.may_say("b")
    for now[0], may in ((1.0, False), (59.9, False), (60.0, True), (60.1, False)):
        assert once.may_say("a") is may
    for kind in range(10_000):  # what is remembered is bounded
        once.may_say(kind)
    assert once.may_say("a")
