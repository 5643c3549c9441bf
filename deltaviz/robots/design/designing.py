"""From a wish to a robot file that is proved to grant it."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

from deltaviz.robots.design.candidate import Ranges
from deltaviz.robots.design.proof import Proof, prove
from deltaviz.robots.design.robot_file import designed_file
from deltaviz.robots.design.score import Task
from deltaviz.robots.design.search import Found, Mapper, NothingReaches, search
from deltaviz.robots.load import parse_robot

ROUNDS = 4
MORE = 0.2  # mm of reserve beyond what a proof found missing


@dataclass(frozen=True, slots=True)
class Designed:
    """`text` is the robot file, and `proof` is of the robot that it describes."""

    found: Found
    proof: Proof
    text: str


def design(
    task: Task,
    ranges: Ranges,
    *,
    template_text: str,
    name: str,
    notes: Sequence[str] = (),
    seed: int = 0,
    generations: int = 80,
    mapper: Mapper = map,
    progress: Callable[[int, float], None] = lambda generation, best: None,
) -> Designed:
    """Searches again with a larger reserve while the proof does not hold: the search sees points
    only, and between two of them a little may be missing.

    Raises NothingReaches, and RobotFileError where the template's other numbers (its homing
    switches, say) do not suit the lengths. After all rounds `Designed.proof` may still not hold.
    """
    best: Designed | None = None
    for _ in range(ROUNDS):
        try:
            found = search(
                task, ranges, seed=seed, generations=generations, mapper=mapper, progress=progress
            )
        except NothingReaches:
            if best is None:
                raise
            return best  # with more reserve there is none
        best = _written(task, found, template_text, name, notes)
        if best.proof.holds:
            return best
        missing = best.proof.fit.uncertain - best.proof.fit.clearance
        task = replace(task, reserve=task.reserve + missing + MORE)
    assert best is not None
    return best


def _written(
    task: Task, found: Found, template_text: str, name: str, notes: Sequence[str]
) -> Designed:
    """The proof is of what is read back from the file's text."""
    text = designed_file(
        template_text,
        task.template,
        name=name,
        lengths=found.lengths,
        wish=task.wish,
        notes=notes,
    )
    robot = parse_robot(text, source=name)
    return Designed(found, prove(robot, task.wish, found.lengths.floor), text)
