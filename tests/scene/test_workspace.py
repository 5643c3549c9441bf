"""The workspace in the scene, spoken by hand through the gateway: what is shown, and that nothing
of it moves the robot."""

from __future__ import annotations

import contextlib
import dataclasses
import importlib
import io
import itertools
import math
import sys
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import trimesh
import viser

from deltaviz.mechanism import RotaryDelta
from deltaviz.robots import Robot
from deltaviz.robots.workspace import Cylinder
from deltaviz.scene.workspace.draw import Drawing
from deltaviz.scene.workspace.measures import coloured
from deltaviz.scene.workspace.orders import Reply
from deltaviz.scene.workspace.pictures import Failed, Fitted, Section, Skin, Surface
from deltaviz.scene.workspace.tasks import Coarse, Cut, Fit
from deltaviz.scene.workspace.text import how_near
from deltaviz.scene.workspace.worker import Worker

Visit = Callable[[str | None], Any]
LONG = 120.0  # s; a process that computes has to load first


def choose(visitor: Any, label: str, value: Any) -> None:
    visitor.send(type="GuiUpdateMessage", uuid=visitor.input(label), updates={"value": value})


def drawn(name: str) -> Callable[[dict[str, Any]], bool]:
    """Itself, or a picture in its place."""
    return lambda m: m.get("name") in (name, f"{name}/a", f"{name}/b") and "props" in m


def told(text: str) -> Callable[[dict[str, Any]], bool]:
    return lambda m: text in str(m.get("updates", {}).get("content"))


@pytest.fixture
def viewer(stand: Any, visit: Visit) -> Any:
    """Of one that only watches: looking is for everyone."""
    stand.machine.be_held_by("anna")
    visitor = visit("boris")
    visitor.look()
    stand.eventually(lambda: stand.server.get_clients())
    return visitor


def test_the_boundary_is_shown_at_once_then_refined_and_the_robot_stays(
    stand: Any, viewer: Any
) -> None:
    choose(viewer, "Reach", True)
    coarse = viewer.read(drawn("/reach/boundary"), LONG)
    fine = viewer.read(drawn("/reach/boundary"), LONG)
    for mesh in (coarse, fine):
        assert 0.0 < mesh["props"]["opacity"] < 0.5
    viewer.read(told("drawn within"), LONG)
    choose(viewer, "Reach", False)
    viewer.read(lambda m: m["type"] == "RemoveSceneNodeMessage" and m["name"] == "/reach/boundary")
    assert stand.machine.posted == []


def test_sections_follow_their_sliders_in_a_colour_that_has_a_key(stand: Any, viewer: Any) -> None:
    choose(viewer, "Colours", "Resolution")
    choose(viewer, "Section Z", True)
    viewer.read(drawn("/reach/section_z"), LONG)
    viewer.read(told("Resolution, mm per microstep"), LONG)
    for level in (-300.0, -320.0):
        choose(viewer, "mm along Z", level)
        viewer.read(drawn("/reach/section_z"), LONG)
    assert stand.machine.posted == []


def drag(visitor: Any, message: dict[str, Any], *places: tuple[float, float]) -> None:
    """Grab at the first of these places of the screen, move over the others, let go at the last."""
    first, *others = places
    message = message | {"start_screen_pos": first, "end_screen_pos": first}
    visitor.send(**message)
    for place in others:
        visitor.send(**(message | {"phase": "update", "end_screen_pos": place}))
    visitor.send(**(message | {"phase": "end", "end_screen_pos": places[-1]}))


def slid(visitor: Any, label: str) -> float:
    """The next value that a slider is told to show."""
    uuid = visitor.input(label)
    found = visitor.read(lambda m: m.get("uuid") == uuid and "value" in m.get("updates", {}))
    return found["updates"]["value"]


def test_a_section_is_dragged_by_who_only_watches(
    stand: Any, viewer: Any, camera_message: dict[str, Any], drag_message: dict[str, Any]
) -> None:
    """The camera looks up along Z from (0.9, -1.1, 0.3) m, X to the right; a metre above it the
    picture is 2 tan(fov / 2) m high."""
    choose(viewer, "Section X", True)
    grip = viewer.read(drawn("/reach/grip_x"), LONG)
    at = drag_message | {"name": grip["name"], "owner": grip["owner"]}
    at["start_position"] = (0.9, -1.1, 1.3)
    width = 2 * math.tan(camera_message["fov"] / 2) * 648 / 752
    drag(viewer, at, (0.5, 0.5), (0.6, 0.55))
    assert slid(viewer, "mm along X") == round(100 * width)
    moved = viewer.read(lambda m: m["type"] == "SetPositionMessage" and "grip" in m["name"])
    assert moved["position"] == pytest.approx((round(100 * width) / 1000, 0, 0))
    viewer.read(drawn("/reach/section_x"), LONG)
    drag(viewer, at, (0.5, 0.5), (9.0, 0.5))
    (cut,) = Cut(stand.machine.robot, 0, 0.0, "One colour", (2,)).pictures()
    assert isinstance(cut, Section)
    assert slid(viewer, "mm along X") == pytest.approx(cut.span[1], abs=1.0)
    assert stand.machine.posted == []


def height(mesh: dict[str, Any]) -> float:
    """Of a level picture, mm."""
    scene = trimesh.load_scene(io.BytesIO(mesh["props"]["glb_data"]), file_type="glb")
    return float(scene.bounds[:, 2].mean()) * 1000


def test_a_section_that_moves_on_and_on_is_seen_on_its_way(viewer: Any) -> None:
    """An order breaks off the one before it, so the next waits until a picture has come."""
    choose(viewer, "Colours", "Conditioning")
    choose(viewer, "Section Z", True)
    viewer.read(drawn("/reach/section_z"), LONG)
    seen: set[float] = set()
    levels = itertools.cycle(np.arange(-350.0, -250.0).tolist())
    level, deadline = 0.0, time.monotonic() + LONG
    while len(seen) < 4:
        assert time.monotonic() < deadline
        choose(viewer, "mm along Z", level := next(levels))
        with contextlib.suppress(TimeoutError):  # slower than a hand, quicker than a picture
            seen.add(height(viewer.read(drawn("/reach/section_z"), 0.03)))
    viewer.read(lambda m: drawn("/reach/section_z")(m) and abs(height(m) - level) < 0.1, LONG)


@pytest.mark.parametrize(
    "change",
    [{"name": "/reach/grip_q"}, {"name": "/reach/section_x"}, {"end_screen_pos": (math.nan, 0.5)}],
)
def test_nothing_else_of_the_workspace_is_dragged(
    stand: Any, viewer: Any, drag_message: dict[str, Any], change: dict[str, Any]
) -> None:
    viewer.send(**(drag_message | {"name": "/reach/grip_x"} | change))
    assert viewer.closed()[0] == 1008
    assert stand.machine.posted == []


def test_singularities_are_shown_and_told(stand: Any, viewer: Any) -> None:
    choose(viewer, "Singularities", True)
    for name in ("/reach/type_1", "/reach/type_2"):
        assert viewer.read(drawn(name), LONG)["props"]["opacity"] < 0.6
    words = viewer.read(told("Type 1"), LONG)["updates"]["content"]
    assert words.count("mm of the workspace") == 2
    choose(viewer, "Singularities", False)
    viewer.read(lambda m: m["type"] == "RemoveSceneNodeMessage" and m["name"] == "/reach/type_2")
    assert stand.machine.posted == []


@pytest.mark.parametrize(
    ("distance", "words"),
    [
        (11.2, "comes to within 12 mm of the workspace."),
        (None, "none within 60 mm of the workspace."),
        (0.0, "goes through the workspace."),
    ],
)
def test_how_near_a_singularity_comes_is_said(distance: float | None, words: str) -> None:
    nothing = np.empty((0, 3), np.float32)
    surface = Surface(nothing, nothing.astype(np.uint32), nothing, distance, 60.0)
    assert how_near(surface) == words


def test_the_boundary_has_a_section_s_colours(robot: Robot) -> None:
    (skin,) = Coarse(robot, "Resolution").pictures()
    assert isinstance(skin, Skin)
    assert skin.share is not None
    assert skin.share.max() - skin.share.min() > 0.5
    for vertex in range(100, len(skin.vertices), len(skin.vertices) // 6):
        x, y, z = skin.vertices[vertex].astype(float)
        (cut,) = Cut(robot, 2, z * 1000, "Resolution").pictures()
        assert isinstance(cut, Section)
        assert cut.scale == skin.scale
        rows, columns = cut.image.shape[:2]
        share = (np.array((x, y)) - cut.low[:2]) / (cut.high - cut.low)[:2]
        column, row = np.floor(share * (columns, rows)).astype(int)
        around = cut.image[max(row - 1, 0) : row + 2, max(column - 1, 0) : column + 2]
        seen = around[around[..., 3] > 0][:, :3].astype(int)
        expected = coloured(skin.share[vertex]).astype(int)
        assert np.abs(seen - expected).max(axis=-1).min() <= 12, vertex


@pytest.mark.parametrize(
    ("label", "value"),
    [
        ("Reach", 1.0),
        ("Reach", "yes"),
        ("Colours", "Beauty"),
        ("Colours", 3),
        ("mm along X", math.nan),
        ("mm along X", 1e4),
        ("mm along X", True),
        ("Section X", "x"),
    ],
)
def test_garbage_for_the_workspace_closes_the_socket(
    stand: Any, viewer: Any, label: str, value: Any
) -> None:
    choose(viewer, label, value)
    assert viewer.closed()[0] == 1008
    assert stand.machine.posted == []


def test_one_browser_s_workspace_is_not_another_s(stand: Any, viewer: Any, visit: Visit) -> None:
    other = visit("clara")
    other.look()
    stand.eventually(lambda: len(stand.server.get_clients()) == 2)
    uuid = viewer.input("Reach")
    other.send(type="GuiUpdateMessage", uuid=uuid, updates={"value": True})
    choose(viewer, "Section X", True)
    viewer.read(drawn("/reach/section_x"), LONG)
    assert not [m for m in viewer.seen if m.get("name") == "/reach/boundary"]


def test_a_planar_robot_shows_its_outline_in_its_plane(planar_robot: Robot) -> None:
    (skin,) = Coarse(planar_robot).pictures()
    assert isinstance(skin, Skin)
    assert not skin.vertices[:, 1].any()
    corners = skin.vertices[skin.faces].astype(float)
    areas = np.linalg.norm(np.cross(*np.diff(corners, axis=1).transpose(1, 0, 2)), axis=-1) / 2
    assert areas.sum() * 1e6 == pytest.approx(skin.size, rel=0.03)
    assert np.isin(skin.edges.reshape(-1, 3), skin.vertices).all()
    (cut,) = Cut(planar_robot, 1, 0.0, "Conditioning").pictures()
    assert isinstance(cut, Section)
    pixel = np.prod((cut.high - cut.low)[[0, 2]] * 1000) / cut.image[..., 3].size
    assert (cut.image[..., 3] > 127).sum() * pixel == pytest.approx(skin.size, rel=0.03)


def test_in_a_plane_the_colours_take_the_place_of_the_fill(
    scene_api: viser.SceneApi, planar_robot: Robot
) -> None:
    """Two surfaces in one place would flicker."""
    drawing = Drawing(scene_api)
    (skin,) = Coarse(planar_robot).pictures()
    (cut,) = Cut(planar_robot, 1, 0.0, "Conditioning").pictures()
    assert isinstance(skin, Skin)
    assert isinstance(cut, Section)

    def filled() -> bool:
        return scene_api.get_handle_by_name("/reach/boundary") is not None

    drawing.skin(skin)
    assert filled()
    drawing.section(cut)
    assert not filled()
    drawing.skin(skin)
    assert not filled()
    drawing.no_section(1)
    assert filled()
    drawing.clear()
    assert not filled()


def test_a_section_is_filled_where_the_robot_reaches(robot: Robot) -> None:
    (cut,) = Cut(robot, 2, -330.0, "One colour").pictures()
    assert isinstance(cut, Section)
    rows, columns = cut.image.shape[:2]
    for x, y in ((0, 0), (150, -40), (-120, 90), (400, 0), (-300, 300)):
        share = (np.array((x, y)) / 1000 - cut.low[:2]) / (cut.high - cut.low)[:2]
        column, row = np.floor(share * (columns, rows)).astype(int)
        if 0 <= row < rows and 0 <= column < columns:
            theta = robot.inverse((x, y, -330.0))
            reaches = bool(np.isfinite(theta).all())
            assert (cut.image[row, column, 3] > 127) == reaches


def test_an_empty_workspace_has_a_reason(robot: Robot) -> None:
    short = RotaryDelta(
        base_radius=115, effector_radius=75, upper_arm=20, forearm=21, azimuths_deg=(0, 120, 240)
    )
    (skin,) = Coarse(dataclasses.replace(robot, mechanism=short)).pictures()
    assert isinstance(skin, Skin)
    assert not len(skin.faces)
    assert skin.reason
    assert skin.reason.endswith(".")


def test_the_largest_cylinder_is_the_analysis_s(robot: Robot) -> None:
    (fitted,) = Fit(robot).pictures()
    assert isinstance(fitted, Fitted)
    assert fitted.shape is not None
    body = fitted.shape
    assert isinstance(body, Cylinder)
    turns = np.linspace(0, 2 * np.pi, 60)
    heights = np.array((0.5, body.height - 0.5)) + body.floor
    for share, within in ((0.995, True), (1.03, False)):
        radius = share * body.diameter / 2
        rim = [(radius * np.cos(t), radius * np.sin(t), z) for t in turns for z in heights]
        theta = robot.inverse(rim)
        legal = (theta >= robot.joints.min) & (theta <= robot.joints.max)
        assert bool(legal.all()) == within


@dataclasses.dataclass(frozen=True)
class Endless:
    """Computes until it is told not to."""

    def pictures(self) -> Iterator[Fitted]:
        yield Fitted(None)
        while True:
            pass


LOADS_ONCE = """
import builtins, signal, time
assert not hasattr(builtins, "half_loaded"), "loaded twice"
builtins.half_loaded = True
interrupts, handler = [], signal.getsignal(signal.SIGINT)
def counting(number, frame):
    interrupts.append(number)
    handler(number, frame)
signal.signal(signal.SIGINT, counting)
print("loading", flush=True)
while len(interrupts) < 3:
    time.sleep(0.001)
signal.signal(signal.SIGINT, handler)
"""


@dataclasses.dataclass(frozen=True)
class Loading:
    """Needs a library that cannot be loaded a second time once it is broken off, and that loads
    until somebody has tried to break it off three times."""

    folder: str

    def pictures(self) -> Iterator[Fitted]:
        sys.path.insert(0, self.folder)
        importlib.import_module("loads_once")
        yield Fitted(None)


@dataclasses.dataclass(frozen=True)
class Broken:
    def pictures(self) -> Iterator[Fitted]:
        raise ValueError("no such thing")
        yield Fitted(None)


@pytest.fixture
def worker(stand: Any, monkeypatch: pytest.MonkeyPatch) -> Iterator[tuple[Worker, list[Reply]]]:
    monkeypatch.setenv("PYTHONPATH", __file__.rpartition("/")[0])
    replies: list[Reply] = []
    worker = Worker(replies.append)
    yield worker, replies
    worker.close()


def test_a_computation_is_broken_off_by_the_next_of_its_kind(
    stand: Any, worker: tuple[Worker, list[Reply]]
) -> None:
    work, replies = worker
    for number in (1, 2, 3):
        work.order((7, "reach"), Endless())
        stand.eventually(lambda number=number: len(replies) == number, LONG)
    work.order((7, "reach"), None)
    work.order((8, "reach"), Broken())
    stand.eventually(lambda: len(replies) == 4, LONG)
    assert [reply.number for reply in replies] == [1, 2, 3, 1]
    assert isinstance(replies[-1].picture, Failed)
    assert "no such thing" in replies[-1].picture.text


def test_a_library_that_loads_is_not_broken_off(
    stand: Any,
    worker: tuple[Worker, list[Reply]],
    tmp_path: Path,
    capfd: pytest.CaptureFixture[str],
) -> None:
    """As numba once was by a length dragged just after the start: nothing was computed any more."""
    (tmp_path / "loads_once.py").write_text(LOADS_ONCE)
    work, replies = worker
    work.order((7, "reach"), Loading(str(tmp_path)))
    stand.eventually(lambda: "loading" in capfd.readouterr().err, LONG)
    work.order((7, "reach"), Loading(str(tmp_path)))
    stand.eventually(lambda: replies, LONG)
    assert [(reply.number, reply.picture) for reply in replies] == [(2, Fitted(None))]


def test_a_process_that_dies_is_said_and_replaced(
    stand: Any, worker: tuple[Worker, list[Reply]]
) -> None:
    work, replies = worker
    work.order((7, "reach"), Endless())
    stand.eventually(lambda: replies, LONG)
    first = work._process
    assert first is not None
    first.kill()
    stand.eventually(lambda: isinstance(replies[-1].picture, Failed), LONG)
    work.order((7, "reach"), Endless())
    stand.eventually(lambda: isinstance(replies[-1].picture, Fitted), LONG)
    assert work.pid != first.pid
