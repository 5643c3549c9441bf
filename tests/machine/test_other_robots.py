"""The five-bar and the robot with a tool that turns, exactly like their big brother."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import pytest

from deltaviz.machine import intent as i
from deltaviz.machine.mode import Mode

ME = "me"
ACCEPTED = i.Accepted()


@pytest.fixture
def planar(make_bench: Callable[..., Any], named_robot: Any) -> Any:
    return make_bench(named_robot("fivebar"))


@pytest.fixture
def turning(make_bench: Callable[..., Any], named_robot: Any) -> Any:
    return make_bench(named_robot("stm32-tool"))


def drag_alive(bench: Any) -> None:
    ms = bench.now * 1000
    bench.do(i.DragAlive(ME, round(ms), ms, bench.now))


def jog_joints(bench: Any, rates: tuple[float, ...], seconds: float) -> None:
    answer = bench.do(i.JogStart(ME, "j", i.JogFrame.JOINTS, rates, bench.now))
    assert answer == ACCEPTED, answer
    bench.hold(rates, seconds, press="j")


class TestFiveBar:
    def test_it_begins_at_rest_at_its_ready_pose(self, planar: Any) -> None:
        assert planar.mode is Mode.IDLE
        robot = planar.robot
        assert planar.snapshot.xyz == pytest.approx(robot.forward(robot.homing.ready), abs=0.1)
        assert len(planar.snapshot.theta) == len(planar.snapshot.margins) == 2

    @pytest.mark.parametrize("way", [(80.0, 0.0), (0.0, -80.0), (60.0, -60.0)])
    def test_jog(self, planar: Any, way: tuple[float, float]) -> None:
        x, z = planar.snapshot.xyz
        planar.jog(way, 0.4)
        assert planar.snapshot.xyz_speed == pytest.approx(way, abs=12)
        planar.do(i.JogEnd(ME, "p"))
        planar.run_until(lambda: planar.mode is Mode.IDLE)
        moved = planar.snapshot.xyz[0] - x, planar.snapshot.xyz[1] - z
        assert math.dist(moved, (0, 0)) > 25
        assert moved[0] * way[1] == pytest.approx(moved[1] * way[0], abs=0.3 * 80)
        planar.check_limits()

    def test_a_drag_in_the_plane(self, planar: Any) -> None:
        x, z = planar.snapshot.xyz
        drag_alive(planar)
        assert planar.do(i.DragStart(ME, planar.now)) == ACCEPTED
        for k in range(1, 11):
            planar.do(i.DragTo(ME, (x + 5.0 * k, z - 4.0 * k), planar.now))
            drag_alive(planar)
            planar.run(0.05)
        assert planar.snapshot.target_xyz == pytest.approx((x + 50, z - 40))
        planar.do(i.DragEnd(ME))
        planar.run_until(lambda: planar.mode is Mode.IDLE)
        assert planar.snapshot.xyz == pytest.approx((x + 50, z - 40), abs=0.1)
        planar.check_limits()

    def test_a_drag_out_of_reach_slides_along_and_says_what_holds_it(self, planar: Any) -> None:
        x, z = planar.snapshot.xyz
        drag_alive(planar)
        planar.do(i.DragStart(ME, planar.now))
        for _ in range(40):
            planar.do(i.DragTo(ME, (x + 300.0, z), planar.now))
            drag_alive(planar)
            planar.run(0.05)
        assert planar.snapshot.xyz[0] == pytest.approx(100, abs=0.5)
        (held,) = planar.snapshot.held_by
        assert held.limit == "At the workspace's end (X 100.0 mm)"
        assert held.way_out == ("-X",)
        planar.check_limits()

    def test_a_move_is_straight_and_what_breaks_a_limit_is_refused(self, planar: Any) -> None:
        assert planar.do(i.MoveToPoint(ME, (70.0, -200.0), 1.0)) == ACCEPTED
        planar.run_until(lambda: planar.mode is Mode.IDLE)
        assert planar.snapshot.command_xyz == pytest.approx((70.0, -200.0), abs=1e-6)
        refused = planar.do(i.MoveToPoint(ME, (0.0, -300.0), 1.0))
        assert "below the workspace (-240 to -130 mm)" in refused.detail
        three = planar.do(i.MoveToPoint(ME, (0.0, 0.0, -200.0), 1.0))
        assert "fivebar takes 2: X, Z" in three.detail
        turned = planar.do(i.MoveToPoint(ME, (0.0, -200.0), 1.0, tool=1.0))
        assert turned.detail == "fivebar has no tool that turns."
        assert planar.do(i.MoveToAngles(ME, (0.3, 0.6), 1.0)) == ACCEPTED
        planar.run_until(lambda: planar.mode is Mode.IDLE)
        assert planar.snapshot.theta == pytest.approx((0.3, 0.6), abs=2e-3)
        planar.check_limits()

    def test_from_power_up_to_ready(self, make_bench: Any, named_robot: Any) -> None:
        bench = make_bench(named_robot("fivebar"), homed=False)
        assert bench.mode is Mode.DISABLED
        assert bench.snapshot.xyz is None
        bench.do(i.Enable(ME))
        bench.run_until(lambda: bench.mode is Mode.UNHOMED)
        jog_joints(bench, (0.0, 0.05), 0.3)
        bench.do(i.JogEnd(ME, "j"))
        bench.run_until(lambda: bench.mode is Mode.UNHOMED)
        assert isinstance(bench.do(i.StepPoint(ME, (1.0, 0.0))), i.Refused)
        bench.do(i.Home(ME))
        bench.run_until(lambda: bench.mode is Mode.IDLE, within=60)
        assert bench.board.plant.theta == pytest.approx(bench.robot.homing.ready, abs=2e-3)

    def test_another_robot_and_back(self, make_bench: Any, named_robot: Any) -> None:
        bench = make_bench(robots={"plane": lambda: named_robot("fivebar")})
        assert bench.do(i.SelectRobot(ME, "plane")) == ACCEPTED
        bench.run_until(lambda: bench.mode is Mode.IDLE)
        assert (bench.robot.name, len(bench.snapshot.xyz)) == ("fivebar", 2)
        assert bench.do(i.SelectRobot(ME, "first")) == ACCEPTED
        bench.run_until(lambda: bench.mode is Mode.IDLE)
        assert len(bench.snapshot.xyz) == 3


class TestTurningTool:
    def test_it_is_the_last_angle(self, turning: Any) -> None:
        assert len(turning.snapshot.theta) == len(turning.snapshot.margins) == 4
        assert len(turning.snapshot.xyz) == 3
        assert len(turning.snapshot.counts) == 4

    def test_a_jog_turns_it_and_nothing_else(self, turning: Any) -> None:
        before, place = turning.snapshot.theta, turning.snapshot.xyz
        jog_joints(turning, (0.0, 0.0, 0.0, 3.0), 0.4)
        assert turning.snapshot.theta_speed[3] == pytest.approx(3.0, rel=0.1)
        turning.do(i.JogEnd(ME, "j"))
        turning.run_until(lambda: turning.mode is Mode.IDLE)
        assert turning.snapshot.theta[3] > before[3] + 0.9
        assert turning.snapshot.theta[:3] == before[:3]
        assert turning.snapshot.xyz == place
        turning.check_limits()

    def test_a_straight_move_may_turn_it(self, turning: Any) -> None:
        x, y, z = turning.snapshot.xyz
        assert turning.do(i.MoveToPoint(ME, (x + 40, y, z), 1.0, tool=1.5)) == ACCEPTED
        turning.run_until(lambda: turning.mode is Mode.IDLE)
        assert turning.snapshot.xyz == pytest.approx((x + 40, y, z), abs=0.25)
        assert turning.snapshot.theta[3] == pytest.approx(1.5, abs=2e-3)
        assert turning.do(i.MoveToPoint(ME, (x, y, z), 1.0)) == ACCEPTED
        turning.run_until(lambda: turning.mode is Mode.IDLE)
        assert turning.snapshot.theta[3] == pytest.approx(1.5, abs=2e-3), "it stays"
        turning.check_limits()

    def test_beyond_its_limits_is_refused_in_words(self, turning: Any) -> None:
        xyz = turning.snapshot.xyz
        for wish in (
            i.MoveToPoint(ME, xyz, 1.0, tool=3.2),
            i.MoveToAngles(ME, (0.0, 0.0, 0.0, 3.2), 1.0),
            i.StepAngles(ME, (0.0, 0.0, 0.0, 3.2)),
            i.FollowAngles(ME, (0.0, 0.0, 0.0, 3.2)),
        ):
            assert turning.do(wish).detail == (
                "The tool would stand at 183.35°; its limits are -175° and 175°."
            )
        assert "takes 4" in turning.do(i.MoveToAngles(ME, (0.0, 0.0, 0.0), 1.0)).detail

    def test_near_its_limit_its_joint_is_marked(self, turning: Any) -> None:
        assert turning.do(i.MoveToAngles(ME, (0.0, 0.0, 0.0, 3.05), 1.0)) == ACCEPTED
        turning.run_until(lambda: turning.mode is Mode.IDLE)
        *arms, tool = turning.snapshot.margins
        assert tool < 0.05
        assert min(arms) == 1.0

    def test_it_homes_to_its_own_switch(self, make_bench: Any, named_robot: Any) -> None:
        bench = make_bench(named_robot("stm32-tool"), homed=False)
        bench.do(i.Enable(ME))
        bench.run_until(lambda: bench.mode is Mode.UNHOMED)
        jog_joints(bench, (0.0, 0.0, 0.0, 1.0), 0.5)
        assert abs(bench.controller._drive.follower.velocity[3]) <= math.radians(10) + 1e-9
        bench.do(i.JogEnd(ME, "j"))
        bench.run_until(lambda: bench.mode is Mode.UNHOMED)
        bench.do(i.Home(ME))
        bench.run_until(lambda: bench.mode is Mode.IDLE, within=90)
        assert bench.board.plant.theta == pytest.approx((0, 0, 0, 0), abs=2e-3)

    def test_without_its_switch_homing_fails_and_says_so(
        self, make_bench: Any, named_robot: Any
    ) -> None:
        bench = make_bench(named_robot("stm32-tool"), homed=False)
        bench.do(i.Enable(ME))
        bench.run_until(lambda: bench.mode is Mode.UNHOMED)
        bench.board.plant.force_switch(3, False)
        bench.do(i.Home(ME))
        bench.run_until(lambda: bench.mode is Mode.FAULT, within=90)
        assert "no end switch" in bench.snapshot.fault
