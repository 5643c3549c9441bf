"""The table of the sources' mistakes, each with what it does to a number."""

from __future__ import annotations

import math

import numpy as np

from source_tables import mistakes

DRAWS = 5


def tables() -> str:
    missed, exact, lost = mistakes.rounded_tan30()
    whole, too_long = _lean_ignored(mistakes.of_scan())
    rows = [
        (
            "Trossen", "forward: the quadratic's middle term `a1 + a2(b2 − y1)`",
            "`a1·b1 + a2(b2 − y1) − z1`", mistakes.middle_term(),
        ),
        ("Trossen", "forward: “x0 = 0”", "x1 = 0: it speaks of the first elbow", ""),
        (
            "Trossen", "inverse: θ = atan(zJ / (yF − yJ))",
            "atan(−zJ / (yF − yJ)), as its code has it", "every angle has the other sign",
        ),
        (
            "Trossen", "0.57735 for tan 30° in the inverse, the exact one in the forward",
            "one exact value in both",
            f"the round trip misses by {missed:.0e} mm (median) instead of {_about(exact)}; "
            f"{lost} of {mistakes.COUNT} reachable points are refused",
        ),
        (
            "Trossen", "inverse: divides by z", "one atan2",
            "no answer in the plane of the motors",
        ),
        (
            "Zheng, Chen", "equation 12, read from the left", "D₁D₂ × (D₂D₃ × D₁D₃)",
            f"median {mistakes.equation_12():.1f} mm off",
        ),
        (
            "Zheng, Chen", "equation 15: the sign of the height", "the other one",
            f"the solution above the elbows, median {mistakes.equation_15():.0f} mm away",
        ),
        (
            "Zheng, Chen", "equations 9 to 12: length FE without a sign",
            "with the sign of the cosine at D₃",
            f"stm32 at (42°, 42°, 90°): {mistakes.unsigned_middle():.1f} mm off",
        ),
        ("Zheng, Chen", "equation 20: α_i", "ω_i", ""),
        (
            "Zheng, Chen", "“take the smaller angle”", "always the minus root",
            f"an elbow goes inside in {mistakes.smaller_angle():.0%} of the poses",
        ),
        (
            "Zheng, Chen", "equation 21 where A → 0", "2C / (−B + √(B² − 4AC))",
            "a billionth of a mm beside A = 0: up to about "
            f"{_about(mistakes.half_angle_digits())}° off, and at it 0/0",
        ),
        (
            "STM32", "the forearm's whole length in the rule of cosines",
            "√(L2² − y²): what the lean leaves",
            f"over its scan: {whole} off",
        ),
        (
            "STM32", "the distance d in space", "in the arm's plane",
            f"over its scan: {too_long} off",
        ),
        ("Planar", "θ1 with + L2²", "− L2²", mistakes.plus_square()),
        ("Planar", "L2 = 2 L1 is required", "it is not", ""),
        (
            "Planar", "arc cosines that divide by f", "atan2",
            "no answer with f = 0; z and −z look the same",
        ),
        (
            "Planar", "the platform ignored", "f − p for f",
            f"preset fivebar: up to {mistakes.platform_ignored():.0f}° off",
        ),
    ]  # fmt: skip
    lines = ["| source | as printed | right | what it does |", "| --- | --- | --- | --- |"]
    shown = (" | ".join(row).replace("e-", "e−") for row in rows)
    return "\n".join([*lines, *(f"| {row} |" for row in shown)])


def elsewhere() -> str:
    """Those of the numbers that depend most on which poses are taken, over others."""
    places = {
        "over its scan": mistakes.of_scan(),
        "over its scan, joints from −45° to 90°": mistakes.of_scan(mistakes.JOINTS_DEG),
        "angles even in −45° to 90°": mistakes.of_angles(*mistakes.JOINTS_DEG),
        "angles even in −90° to 90°": mistakes.of_angles(-90, 90),
    }
    lines = [
        "| STM32 | the forearm's whole length | the distance d in space |",
        "| --- | --- | --- |",
    ]
    for where, xyz in places.items():
        lines.append(f"| {where} | " + " | ".join(_lean_ignored(xyz)) + " |")
    medians = [mistakes.equation_12(seed) for seed in range(DRAWS)]
    return "\n".join(lines) + (
        f"\n\nThe platform ignored costs up to {mistakes.platform_ignored():.0f}° over all angles "
        f"and up to {mistakes.platform_ignored(zone=True):.0f}° over the preset's zone. The median "
        f"for equation 12\nis {min(medians):.1f} to {max(medians):.1f} mm in {DRAWS} draws of "
        f"{mistakes.COUNT} poses each."
    )


def _lean_ignored(xyz: np.ndarray) -> tuple[str, str]:
    """Of the STM32 library's two slips."""
    whole, too_long = (mistakes.lean_ignored(xyz, planar=planar) for planar in (True, False))
    return _spread(whole), _spread(too_long)


def _spread(degrees: tuple[float, float]) -> str:
    return f"median {degrees[0]:.0f}°, worst {degrees[1]:.0f}°"


def _about(value: float) -> str:
    """The nearest power of ten: of what rounding makes, no digit is the same everywhere."""
    return f"{10.0 ** round(math.log10(value)):.0e}"
