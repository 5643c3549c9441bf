"""From a move of the pointer to the simulated board's first step, and the share of each stage.

    python -m benchmarks.latency [--moves N] [--link emulate://]

A real page drags the effector in small moves, at rest between them. What passes is seen in this
process: the pointer's own time stamp, the drag's arrival at the scene, and the machine's
snapshots, which come every 12 ms: single values are that coarse, medians less so. The last stage is
in the board's time, which telemetry tells every 5 ms; in the emulator it is slower than ours.
"""

from __future__ import annotations

import argparse
import statistics
import threading
import time
from concurrent.futures import Future
from dataclasses import dataclass, field

from playwright.sync_api import Page

from benchmarks.hand import Hand
from benchmarks.served import Served, chromium, open_console, served
from deltaviz.machine.intent import Answer, DragTo, Enable, Home, Intent, ReleaseControl
from deltaviz.machine.mode import Mode
from deltaviz.machine.snapshot import Snapshot

CLIENT = "benchmark"
PATIENCE = 30.0  # s
PER_MOVE = 10.0  # s
STEP = 24.0  # pixels

STAMP = """() => {
    const frame = document.querySelector("#scene").contentWindow;
    frame.addEventListener("pointermove", (event) => {
        window.movedAt = frame.performance.timeOrigin + event.timeStamp;
    }, true);
}"""


@dataclass
class Witness:
    """Stamps what passes between the surfaces and the machine, in s of the monotonic clock."""

    running: Served
    drags: list[float] = field(default_factory=list)
    snapshots: list[Snapshot] = field(default_factory=list)
    ended: threading.Event = field(default_factory=threading.Event)

    def watch(self) -> None:
        post = self.running.machine.post

        def noted(intent: Intent) -> Future[Answer]:
            if isinstance(intent, DragTo):
                self.drags.append(intent.at)
            return post(intent)

        self.running.machine.post = noted  # type: ignore[method-assign]
        threading.Thread(target=self._poll, daemon=True).start()

    def _poll(self) -> None:
        while not self.ended.wait(0.001):
            snapshot = self.running.machine.snapshot
            if not self.snapshots or snapshot is not self.snapshots[-1]:
                self.snapshots.append(snapshot)

    def rest(self) -> Snapshot:
        """The first of half a second's snapshots that all stand still."""
        end = time.monotonic() + PATIENCE
        while time.monotonic() < end:
            time.sleep(0.05)
            recent = [s for s in self.snapshots if s.at > self.snapshots[-1].at - 0.5]
            if len(recent) > 3 and len({(s.counts, s.target_xyz) for s in recent}) == 1:
                return recent[-1]
        raise SystemExit("the robot does not come to rest")


def get_ready(running: Served) -> None:
    """Enabled and homed, as a board that was just switched on is not."""
    machine = running.machine
    end = time.monotonic() + 10 * PATIENCE
    while machine.snapshot.mode is not Mode.IDLE:
        if time.monotonic() > end:
            raise SystemExit(f"the robot does not get ready: {machine.snapshot.next_step}")
        if machine.snapshot.mode is Mode.DISABLED:
            machine.post(Enable(CLIENT)).result(PATIENCE)
        elif machine.snapshot.mode is Mode.UNHOMED:
            machine.post(Home(CLIENT)).result(PATIENCE)
        time.sleep(0.2)
    machine.post(ReleaseControl(CLIENT)).result(PATIENCE)


def one_move(
    page: Page, hand: Hand, witness: Witness, dx: float
) -> tuple[float, float, float] | None:
    """Stages of one move, s: to the scene, to the command, to the first step. None: no step."""
    hand.hold()
    before = witness.rest()
    witness.drags.clear()
    to_monotonic = time.monotonic() - time.time()
    hand.move(dx, 0.0)
    after = witness.rest()
    if after.counts == before.counts or not witness.drags:
        return None
    moved = page.evaluate("() => window.movedAt") / 1e3 + to_monotonic
    since = [s for s in witness.snapshots if s.at > before.at]
    commanded = next(s for s in since if s.command_xyz != before.command_xyz)
    stepped = next(s for s in since if s.counts != before.counts)
    assert commanded.board_time is not None
    assert stepped.board_time is not None
    return (
        witness.drags[0] - moved,
        commanded.at - witness.drags[0],
        stepped.board_time - commanded.board_time,
    )


def report(stages: list[tuple[float, float, float]]) -> None:
    names = (
        "pointer to the scene's callback",
        "callback to the command",
        "command to the first step, by the board",
    )
    totals = [sum(s) for s in stages]
    middle = statistics.median(totals)
    print(f"{'pointer move to first step, ms':42}{'p50':>8}{'p99':>8}{'share':>8}")
    for name, column in zip(names, zip(*stages, strict=True), strict=True):
        half, most = statistics.median(column), quantile(column, 0.99)
        print(f"{name:42}{1e3 * half:8.1f}{1e3 * most:8.1f}{half / middle:8.0%}")
    print(f"{'all':42}{1e3 * middle:8.1f}{1e3 * quantile(totals, 0.99):8.1f}{1:8.0%}")
    print(f"{len(stages)} moves")


def quantile(values: list[float] | tuple[float, ...], share: float) -> float:
    ordered = sorted(values)
    return ordered[min(len(ordered) - 1, int(share * len(ordered)))]


def main() -> None:
    parser = argparse.ArgumentParser(description="From a pointer move to the board's first step.")
    parser.add_argument("--moves", type=int, default=60)
    parser.add_argument("--link", default="sim://", help="sim://, or emulate:// (sim://)")
    options = parser.parse_args()
    moves = options.moves
    with served(link=options.link) as running, chromium() as browser:
        get_ready(running)
        page = open_console(browser, running.url)
        witness = Witness(running)
        witness.watch()
        page.evaluate(STAMP)
        stages: list[tuple[float, float, float]] = []
        end = time.monotonic() + PATIENCE + moves * PER_MOVE
        with Hand(page, running) as hand:
            while len(stages) < moves:
                if time.monotonic() > end:
                    raise SystemExit("the drags do not move the robot")
                one = one_move(page, hand, witness, 0.0 if len(stages) % 2 else STEP)
                if one is not None:
                    stages.append(one)
        witness.ended.set()
    report(stages)


if __name__ == "__main__":
    main()
