"""Reads a robot: a preset by its name, or a person's own file by its path."""

from __future__ import annotations

import difflib
import os
import tomllib
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, get_args

from deltaviz.robots.errors import Faulty, Inconsistent, RobotFileError
from deltaviz.robots.presets import preset_names, preset_text
from deltaviz.robots.source_lines import key_lines, line_of

if TYPE_CHECKING:
    from pydantic import ValidationError

    from deltaviz.robots.robot import Robot


@dataclass(frozen=True)
class Loaded:
    """A robot, and the text of the file that it was read from."""

    robot: Robot
    text: str


def load_robot(robot: str | os.PathLike[str]) -> Robot:
    """A preset by name, or a robot file by its path (anything with a separator or ".toml").

    Raises RobotFileError, which names the field, its value, the line and what would be legal.
    """
    return load_with_text(robot).robot


def load_with_text(robot: str | os.PathLike[str]) -> Loaded:
    """As `load_robot`."""
    text, source = robot_text(robot)
    return Loaded(parse_robot(text, source=source), text)


def robot_text(robot: str | os.PathLike[str]) -> tuple[str, str]:
    """The text of a preset or a robot file, and what to call it in errors. Raises RobotFileError if
    there is none."""
    name = os.fspath(robot)
    if _is_path(name) or not isinstance(robot, str):
        return _read(name), name
    if name not in preset_names():
        raise RobotFileError(_unknown_preset(name))
    return preset_text(name), f"preset {name}"


def parse_robot(text: str, *, source: str = "robot file") -> Robot:
    """A robot from the text of a robot file; `source` names it in errors."""
    try:
        data = tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise RobotFileError(f"{source}: not valid TOML: {error}") from error
    try:
        return robot_of(data)
    except Faulty as error:
        lines = key_lines(text)
        located = sorted((line_of(lines, field) or 0, said) for field, said in error.problems)
    raise RobotFileError(
        "\n".join(
            f"{source}, line {line}: {text}" if line else f"{source}: {text}"
            for line, text in located
        )
    )


def robot_of(data: dict[str, Any]) -> Robot:
    """A robot from what a robot file holds, in about a millisecond. Raises Faulty."""
    from pydantic import ValidationError

    from deltaviz.robots.build import build
    from deltaviz.robots.schema import FORMS

    form, arms = FORMS.get(str(data.get("kind")), (None, 0))
    if form is None:
        raise Faulty([("kind", _no_kind(data, tuple(FORMS)))])
    try:
        return build(form.model_validate(data, context={"arms": arms}))
    except ValidationError as error:
        raise Faulty(_problems(error, form)) from error
    except Inconsistent as error:
        raise Faulty([(error.field, str(error))]) from error


def _is_path(name: str) -> bool:
    separators = [separator for separator in (os.sep, os.altsep) if separator]
    return name.endswith(".toml") or any(separator in name for separator in separators)


def _read(path: str) -> str:
    try:
        return Path(path).read_text(encoding="utf-8")
    except OSError as error:
        raise RobotFileError(f"{path}: {error.strerror or error}") from error
    except UnicodeDecodeError as error:
        raise RobotFileError(f"{path}: not UTF-8 text") from error


def _unknown_preset(name: str) -> str:
    near = difflib.get_close_matches(name.lower(), preset_names(), n=1)
    hint = f"did you mean {near[0]!r}? " if near else ""
    return (
        f"No preset is named {name!r}; {hint}Presets: {', '.join(preset_names())}. "
        "A path to a robot file must end in .toml or contain a separator."
    )


def _no_kind(data: dict[str, Any], kinds: tuple[str, ...]) -> str:
    legal = f"must be {' or '.join(map(repr, kinds))}"
    return f"kind = {data['kind']!r}: {legal}" if "kind" in data else f"kind is missing; it {legal}"


def _problems(error: ValidationError, model: Any) -> list[tuple[str, str]]:
    """(field, what is wrong with it) of each problem that pydantic found."""
    found: list[tuple[str, str]] = []
    meant = {_meant(problem["loc"], model) for problem in error.errors()}
    for problem in error.errors():
        field = ".".join(str(part) for part in problem["loc"])
        kind, value = problem["type"], problem["input"]
        if kind == "missing":
            if problem["loc"] in meant:
                continue  # told already, as a misspelt field
            text = f"{field} is missing"
        elif kind == "extra_forbidden":
            text = f"{field} is not a known field{_hint(problem['loc'], model)}"
        elif kind in ("model_type", "model_attributes_type"):
            text = f"{field} = {value!r}: must be a section, [{field}]"
        elif kind == "literal_error":
            text = f"{field} = {value!r}: must be {problem.get('ctx', {})['expected']}"
        else:
            text = f"{field} = {value!r}: {problem['msg'].removeprefix('Value error, ')}"
        found.append((field, text))
    return found


def _hint(location: tuple[int | str, ...], model: Any) -> str:
    meant = _meant(location, model)
    if meant:
        return f"; did you mean {meant[-1]!r}?"
    return f"; known here: {', '.join(_known(location, model))}"


def _meant(location: tuple[int | str, ...], model: Any) -> tuple[int | str, ...]:
    """The known field that a misspelt one is nearest to; empty if none is near or it is known."""
    known = _known(location, model)
    if not known or location[-1] in known:
        return ()
    near = difflib.get_close_matches(str(location[-1]), known, n=1)
    return (*location[:-1], near[0]) if near else ()


def _known(location: tuple[int | str, ...], model: Any) -> list[str]:
    """The fields of the section that a location stands in."""
    for part in location[:-1]:
        field = getattr(model, "model_fields", {}).get(part)
        if field is None:
            return []
        kinds = (field.annotation, *get_args(field.annotation))  # of an optional section, too
        model = next((kind for kind in kinds if hasattr(kind, "model_fields")), None)
    return list(getattr(model, "model_fields", {}))
