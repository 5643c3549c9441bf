"""`deltaviz verify`: whether a robot's kinematics agrees with itself and with other methods."""

from __future__ import annotations

import json
import math
from typing import Any

from deltaviz.robots.verification import Branches, Check, Verification


def text(found: Verification) -> str:
    if not found.poses:
        return f"{found.robot}: no pose within its limits was found: there is nothing to verify."
    width = max(len(_name(check)) for check in found.checks)
    lines = [
        f"{found.robot}: {found.poses} poses within its limits (seed {found.seed})",
        "",
        f"{'difference':<{width}}      worst     median   at most",
        *(_row(check, width) for check in found.checks),
        "",
        *_branches(found.branches),
        "",
        _verdict(found),
    ]
    return "\n".join(lines)


def as_json(found: Verification) -> str:
    """NaN, which JSON has not, becomes null."""
    branches = found.branches
    return json.dumps(
        {
            "robot": found.robot,
            "poses": found.poses,
            "seed": found.seed,
            "agrees": found.agrees,
            "checks": [_check(check) for check in found.checks],
            "angles_within_the_joint_limits": {
                "tried": branches.tried,
                "closes": branches.closes,
                "elbow_inside": branches.elbow_inside,
                "forearms_apart": branches.apart,
            },
        }
    )


def _name(check: Check) -> str:
    return f"{check.what}: {check.method}" if check.method else check.what


def _row(check: Check, width: int) -> str:
    name = f"{_name(check):<{width}}"
    if check.not_for is not None:
        return f"{name}  does not apply: {check.not_for}"
    verdict = "" if check.agrees else "   DISAGREES"
    if math.isnan(check.worst):
        return f"{name}  a pose without a solution{verdict}"
    worst, median = f"{check.worst:.1e}", f"{check.median:.1e}"
    return f"{name}  {worst:>9}  {median:>9}   {check.tolerance:.0e} {check.unit}{verdict}"


def _branches(branches: Branches) -> list[str]:
    lines = [
        f"Of all angles within the joint limits, {branches.closes:.2%} come back from "
        "inverse(forward(θ)).",
    ]
    if branches.elbow_inside:
        lines.append(
            f"{branches.elbow_inside:.2%} have an elbow inside: the effector is then also reached "
            "with it outside,\nand that is what the inverse answers. The limits exclude such poses."
        )
    if branches.apart:
        lines.append(f"With {branches.apart:.2%} the forearms cannot meet.")
    return lines


def _verdict(found: Verification) -> str:
    wrong = [check for check in found.checks if not check.agrees]
    if not wrong:
        return "All agree."
    return f"{len(wrong)} of {len(found.checks)} disagree: do not trust this robot's kinematics."


def _check(check: Check) -> dict[str, Any]:
    return {
        "what": check.what,
        "method": check.method or "round trip",
        "unit": check.unit,
        "tolerance": check.tolerance,
        "worst": _number(check.worst),
        "median": _number(check.median),
        "agrees": check.agrees,
        "not_for": check.not_for,
    }


def _number(value: float) -> float | None:
    return None if math.isnan(value) else value
