"""The board's own C for kinematics and checks, compiled for this machine, behind plain calls."""

from __future__ import annotations

import ctypes as c
import subprocess
import tempfile
from collections.abc import Sequence
from functools import cache
from math import inf, radians
from pathlib import Path
from typing import Any

from deltaviz.link.messages import Configure, Options, RobotKind
from deltaviz.link.wire.description import MessageDescription, load_description
from deltaviz.mechanism import RotaryDelta

CORE = Path(__file__).parents[2] / "firmware" / "core"
NAMES = ("kinematics", "rotary_delta", "five_bar", "parameters", "real_cubic", "limits", "checks")
NAMES += ("tip", "tip_checks")
SOURCES = [CORE / f"{name}.c" for name in NAMES]
STRICT_C = [
    *("-std=c11", "-Wall", "-Wextra", "-pedantic", "-Wconversion", "-Wdouble-promotion"),
    *("-Wshadow", "-Werror", f"-I{CORE}", f"-I{CORE.parent / 'hal'}"),
]

_C_TYPES: dict[str, Any] = {
    "u16": c.c_uint16,
    "u32": c.c_uint32,
    "i8": c.c_int8,
    "i32": c.c_int32,
    "f32": c.c_float,
    "bool": c.c_bool,
}  # else uint8_t
_JOINTS_MAX = load_description().joints_max


def _structure(message: MessageDescription) -> type[c.Structure]:
    fields: list[tuple[str, Any]] = []
    for field in message.fields:
        parsed = field.parsed
        plain = _C_TYPES.get(parsed.base, c.c_uint8)
        count = _JOINTS_MAX if parsed.count == "joints" else parsed.count
        fields.append((field.name, plain * count if count else plain))
    return type(message.name, (c.Structure,), {"_fields_": fields})


_messages = {message.name: message for message in load_description().message}
CConfigure = _structure(_messages["Configure"])


class CKnot(c.Structure):
    """`struct dv_knot`."""

    _fields_ = [
        ("p", c.c_int32 * _JOINTS_MAX),
        ("v", c.c_int32 * _JOINTS_MAX),
        ("cartesian", c.c_bool),
    ]


class CCase(c.Structure):
    """What judge_cases.c reads."""

    _fields_ = [
        ("configure", CConfigure),
        ("tick_hz", c.c_uint32),
        ("start", CKnot),
        ("end", CKnot),
        ("ticks", c.c_uint32),
        ("pose", c.c_float * 3),
    ]


class CLimb(c.Structure):
    _fields_ = [
        (name, c.c_float)
        for name in ("offset", "upper_arm", "forearm", "cos_azimuth", "sin_azimuth")
    ]


class CParameters(c.Structure):
    """`struct dv_parameters`."""

    _fields_ = [
        ("configure", CConfigure),
        ("accelerations", c.c_int64 * _JOINTS_MAX),
        ("acceleration", c.c_float * _JOINTS_MAX),
        ("velocity", c.c_float * _JOINTS_MAX),
        ("unhomed_velocity", c.c_float * _JOINTS_MAX),
        ("arms", c.c_uint8),
        ("handedness", c.c_float),
        ("limb", CLimb * 3),
    ]


class CObjection(c.Structure):
    _fields_ = [("reason", c.c_uint8), ("joint", c.c_int8)]


class CLeeway(c.Structure):
    _fields_ = [("began", c.c_int32 * _JOINTS_MAX), ("outside", c.c_float)]

    @classmethod
    def of(cls, began: Sequence[int], outside: float) -> CLeeway:
        return cls((c.c_int32 * _JOINTS_MAX)(*began), outside)


class CRealCubic(c.Structure):
    _fields_ = [(name, c.c_float) for name in ("distance", "v0", "v1", "a0", "a1", "seconds")]


def compile_c(target: Path, sources: Sequence[Path], *options: str) -> None:
    """Fails, with what the compiler said, unless it compiles without a warning."""
    command = ["gcc", "-O2", *STRICT_C, *options, "-o", str(target), *map(str, sources), "-lm"]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr


@cache
def _library() -> c.CDLL:
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "core.so"
        compile_c(path, SOURCES, "-shared", "-fPIC")
        library = c.CDLL(str(path))
    for name in ("dv_parameters_from", "dv_forward", "dv_inverse", "dv_joint_motions"):
        getattr(library, name).restype = c.c_bool
    library.dv_check_segment.restype = CObjection
    library.dv_joint_cubic.restype = CRealCubic
    library.dv_tip_cubic.restype = CRealCubic
    library.dv_check_tip_segment.restype = CObjection
    for name in ("dv_real_cubic_top_speed", "dv_real_cubic_position"):
        getattr(library, name).restype = c.c_float
    return library


def c_configure(configure: Configure) -> Any:
    """The C form of the message."""
    values: Any = CConfigure()
    for name, *_ in CConfigure._fields_:
        value = len(configure.ready) if name == "joints" else getattr(configure, name)
        if isinstance(value, tuple):
            getattr(values, name)[: len(value)] = value
        else:
            setattr(values, name, value)
    return values


def c_knot(p: Sequence[int], v: Sequence[int], *, cartesian: bool = False) -> CKnot:
    numbers = c.c_int32 * _JOINTS_MAX
    return CKnot(numbers(*p), numbers(*v), cartesian)


def parameters_from(configure: Configure, *, tick_hz: int) -> CParameters | None:
    """What C makes of a Configure."""
    parameters = CParameters()
    given = c_configure(configure)
    if not _library().dv_parameters_from(c.byref(parameters), c.byref(given), c.c_uint32(tick_hz)):
        return None
    return parameters


def forward(parameters: CParameters, theta: Sequence[float]) -> tuple[float, ...] | None:
    tip = (c.c_float * 3)()
    found = _library().dv_forward(c.byref(parameters), (c.c_float * 3)(*theta), tip)
    return tuple(tip) if found else None


def inverse(parameters: CParameters, tip: Sequence[float]) -> tuple[float, ...] | None:
    theta = (c.c_float * 3)()
    found = _library().dv_inverse(c.byref(parameters), (c.c_float * 3)(*tip), theta)
    return tuple(theta[: parameters.arms]) if found else None


class CJointMotion(c.Structure):
    _fields_ = [(name, c.c_float) for name in ("angle", "rate", "acceleration", "gain")]


def joint_motions(
    parameters: CParameters,
    tip: Sequence[float],
    velocity: Sequence[float],
    acceleration: Sequence[float],
) -> list[CJointMotion] | None:
    motions = (CJointMotion * 3)()
    given = [(c.c_float * 3)(*numbers) for numbers in (tip, velocity, acceleration)]
    found = _library().dv_joint_motions(c.byref(parameters), *given, motions)
    return list(motions[: parameters.arms]) if found else None


def check_segment(
    parameters: CParameters,
    *,
    tick_hz: int,
    start: tuple[Sequence[int], Sequence[int]],
    end: tuple[Sequence[int], Sequence[int]],
    ticks: int,
    homed: bool,
    outside: float,
) -> tuple[int, int]:
    """(reason, joint): (0, -1) for a segment without fault."""
    found = _library().dv_check_segment(
        c.byref(parameters),
        c.c_uint32(tick_hz),
        c.byref(c_knot(*start)),
        c.byref(c_knot(*end)),
        c.c_uint32(ticks),
        c.c_bool(homed),
        c.c_float(outside),
    )
    return found.reason, found.joint


def check_tip_segment(
    parameters: CParameters,
    *,
    tick_hz: int,
    start: tuple[Sequence[int], Sequence[int]],
    end: tuple[Sequence[int], Sequence[int]],
    ticks: int,
    began: Sequence[int],
    outside: float,
) -> tuple[int, int]:
    """The same for Cartesian knots."""
    found = _library().dv_check_tip_segment(
        c.byref(parameters),
        c.c_uint32(tick_hz),
        c.byref(c_knot(*start, cartesian=True)),
        c.byref(c_knot(*end, cartesian=True)),
        c.c_uint32(ticks),
        c.byref(CLeeway.of(began, outside)),
    )
    return found.reason, found.joint


def delta_configure(mechanism: RotaryDelta, **changes: Any) -> Configure:
    """A configuration for arms alone: the rest is wide open."""
    unbounded = (-inf, inf)
    values: dict[str, Any] = {
        "kind": RobotKind.ROTARY_DELTA,
        "options": Options.NONE,
        "homing_direction": -1,
        "joint_min": (-(1 << 30),) * 3,
        "joint_max": (1 << 30,) * 3,
        "velocity": (65536,) * 3,
        "acceleration": (1 << 24,) * 3,
        "unhomed_velocity": (6554,) * 3,
        "microsteps_per_rad": (1000.0,) * 3,
        "inverted": (False,) * 3,
        "homing_switch": (-1000,) * 3,
        "homing_fast": (6554,) * 3,
        "homing_slow": (655,) * 3,
        "homing_backoff": (50,) * 3,
        "homing_max_travel": (4000,) * 3,
        "ready": (600,) * 3,
        "base_radius": mechanism.base_radius,
        "effector_radius": mechanism.effector_radius,
        "upper_arm": mechanism.upper_arm,
        "forearm": mechanism.forearm,
        "azimuth": tuple(map(radians, mechanism.azimuths_deg)),
        "tool_offset": (0.0, 0.0, 0.0),
        "workspace_x": unbounded,
        "workspace_y": unbounded,
        "workspace_z": unbounded,
        "workspace_radius": inf,
    }
    return Configure(**(values | changes))


def joint_cubic(p0: int, p1: int, v0: int, v1: int, *, ticks: int, tick_hz: int) -> CRealCubic:
    knots = map(c.c_int32, (p0, p1, v0, v1))
    return _library().dv_joint_cubic(*knots, c.c_uint32(ticks), c.c_uint32(tick_hz))


def top_speed(cubic: CRealCubic) -> float:
    return _library().dv_real_cubic_top_speed(c.byref(cubic))


def position(cubic: CRealCubic, part: float) -> float:
    return _library().dv_real_cubic_position(c.byref(cubic), c.c_float(part))
