"""`deltaviz design`: lengths that reach what is wanted, saved as a robot file."""

from __future__ import annotations

import argparse
import contextlib
import json
import math
import os
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

from deltaviz.terminal.design_options import WrongWish, ranges, wish
from deltaviz.terminal.files import first_unwritable
from deltaviz.terminal.status import BAD_USAGE, FAILED, OK

if TYPE_CHECKING:
    from deltaviz.robots import Robot
    from deltaviz.robots.design import Designed, Lengths, Preference, Ranges, Wish
    from deltaviz.robots.design.search import Mapper


def run(template: Robot, template_text: str, options: argparse.Namespace) -> int:
    """Status 1 if nothing within the size limits reaches it, or the file cannot be written."""
    out: Path = options.out or Path("designed.toml")
    try:
        wished = wish(template, options)
        sizes = ranges(template, wished, options)
    except (WrongWish, ValueError) as error:
        print(f"deltaviz: {error}", file=sys.stderr)
        return BAD_USAGE
    if out.suffix != ".toml":
        print(f"deltaviz: --out {out}: a robot file ends in .toml", file=sys.stderr)
        return BAD_USAGE
    if out.exists() and not options.overwrite:
        print(f"deltaviz: {out} is there already; --overwrite writes over it", file=sys.stderr)
        return FAILED
    wrong = first_unwritable({"--out": str(out)})  # asked before the search, which takes minutes
    if wrong is not None:
        print(f"deltaviz: {wrong}", file=sys.stderr)
        return FAILED
    designed = _designed(template, template_text, wished, sizes, out, options)
    if designed is None:
        return FAILED
    try:
        out.write_text(designed.text, encoding="utf-8")
    except OSError as error:
        print(f"deltaviz: {out}: {error.strerror or error}", file=sys.stderr)
        return FAILED
    print(as_json(designed, out) if options.json else text(designed, out))
    return OK


def _designed(
    template: Robot,
    template_text: str,
    wished: Wish,
    sizes: Ranges,
    out: Path,
    options: argparse.Namespace,
) -> Designed | None:
    """None, with the reason on stderr, if there is none that is proved."""
    from deltaviz.robots import RobotFileError
    from deltaviz.robots.design import NothingReaches, Preference, Task, design
    from deltaviz.robots.design.workers import NoScheduler

    task = Task(template, wished, Preference(options.prefer), options.grain, options.reserve)
    try:
        with (
            _mapper(options) as mapper,
            _progress(options.generations, task.preference) as progress,
        ):
            designed = design(
                task,
                sizes,
                template_text=template_text,
                name=out.stem[:64],
                notes=_notes(template, wished, options),
                seed=options.seed,
                generations=options.generations,
                mapper=mapper,
                progress=progress,
            )
    except NothingReaches as error:
        print(f"deltaviz: {error}\n{_nearest(error.best, sizes)}", file=sys.stderr)
        return None
    except (NoScheduler, RobotFileError, ImportError) as error:
        print(f"deltaviz: {_needed(error)}", file=sys.stderr)
        return None
    if not designed.proof.holds:
        fit = designed.proof.fit
        print(
            f"deltaviz: the best that was found misses by {-fit.clearance:.2f} mm ({fit.limit}); "
            "try more --generations, another --seed, or wider size limits",
            file=sys.stderr,
        )
        return None
    return designed


def _notes(template: Robot, wished: Wish, options: argparse.Namespace) -> list[str]:
    sizes = [
        f"--{name.replace('_', '-')} {value:g}"
        for name in ("max_base", "max_upper_arm", "max_forearm", "max_depth")
        if (value := getattr(options, name)) is not None
    ]
    at = "" if wished.floor is None else f" at Z {wished.floor:g}"
    body = str(wished.at(0.0)).rsplit(", Z", 1)[0]
    return [
        f"Designed by `deltaviz design` to reach a {body}{at}; seed {options.seed}"
        f"{', ' if sizes else ''}{' '.join(sizes)}.",
        f"Joints, limits, drive, thicknesses and masses are those of {template.name}: see whether "
        "they suit.",
    ]


@contextlib.contextmanager
def _mapper(options: argparse.Namespace) -> Iterator[Mapper]:
    from deltaviz.robots.design.workers import cluster, here

    if options.scheduler is not None:
        with cluster(options.scheduler) as mapper:
            yield mapper
    else:
        with here(options.workers or os.cpu_count() or 1) as mapper:
            yield mapper


@contextlib.contextmanager
def _progress(generations: int, preference: Preference) -> Iterator[Callable[[int, float], None]]:
    """A bar on stderr, if a person looks at it."""
    from tqdm import tqdm

    bar: Any = tqdm(total=generations, unit="generation", file=sys.stderr, disable=None)

    def told(generation: int, best: float) -> None:
        if generation < bar.n:  # another round, with a larger reserve
            bar.reset()
        bar.set_postfix_str(_best(best, preference), refresh=False)
        bar.update(generation - bar.n)

    with bar:
        yield told


def _best(score: float, preference: Preference) -> str:
    from deltaviz.robots.design.score import UNREACHED

    if score >= UNREACHED:
        return f"misses by {score - UNREACHED:.1f} mm"
    return f"worst {' x '.join(preference.measures)} {math.exp(score):.3g}"


def text(designed: Designed, out: Path) -> str:
    lengths, proof, found = designed.found.lengths, designed.proof, designed.found
    return "\n".join(
        [
            _sizes(lengths),
            f"Reaches, as is proved: {proof.fit.shape}.",
            f"  It could grow by {proof.fit.clearance - proof.fit.uncertain:.2f} mm on all sides"
            + (f" (then: {proof.fit.limit})." if proof.fit.limit is not None else "."),
            f"  There conditioning is at worst {proof.condition:.3g}, resolution "
            f"{proof.resolution:.3g} mm per microstep.",
            f"{found.candidates} candidates in {found.generations} generations; written to {out}",
        ]
    )


def as_json(designed: Designed, out: Path) -> str:
    from deltaviz.robots.workspace.report import shape_json

    lengths, proof = designed.found.lengths, designed.proof
    return json.dumps(
        {
            "file": str(out),
            "base_mm": lengths.base,
            "upper_arm_mm": lengths.upper_arm,
            "forearm_mm": lengths.forearm,
            "reaches": shape_json(proof.fit.shape),
            "clearance_mm": proof.fit.clearance - proof.fit.uncertain,
            "limit": None if proof.fit.limit is None else str(proof.fit.limit),
            "condition": proof.condition,
            "resolution_mm": proof.resolution,
            "generations": designed.found.generations,
            "candidates": designed.found.candidates,
        }
    )


def _nearest(best: Lengths, sizes: Ranges) -> str:
    at_most = [
        name.replace("_", " ")
        for name in ("base", "upper_arm", "forearm")
        if getattr(best, name) > 0.98 * getattr(sizes, name)[1]
    ]
    told = (
        f"  The best: base {best.base:g}, upper arm {best.upper_arm:g}, forearm {best.forearm:g} mm"
    )
    return f"{told}; {' and '.join(at_most)} at the limit." if at_most else f"{told}."


def _needed(error: Exception) -> str:
    if isinstance(error, ImportError):
        return f"{error}; a design needs `pip install 'deltaviz[design]'`"
    return str(error)


def _sizes(lengths: Lengths) -> str:
    return f"base {lengths.base:g}, upper arm {lengths.upper_arm:g}, forearm {lengths.forearm:g} mm"
