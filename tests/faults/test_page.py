"""docs/reliability.md is today's: what was measured here stands there."""

from __future__ import annotations

import importlib.util
import re
from pathlib import Path
from types import ModuleType

import pytest

DOCS = Path(__file__).parents[2] / "docs"
NUMBER = re.compile(r"\d+(?:\.\d+)?")


def script() -> ModuleType:
    spec = importlib.util.spec_from_file_location("reliability", DOCS / "reliability.py")
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_the_page_is_todays() -> None:
    """In all words, and in its numbers as nearly as processors round alike: a last digit can move a
    knot, and with it the frames that a fault meets.
    """
    todays, page = script().todays(), (DOCS / "reliability.md").read_text()
    told = "run: python docs/reliability.py"
    assert NUMBER.sub("#", todays) == NUMBER.sub("#", page), told
    for today, then in zip(NUMBER.findall(todays), NUMBER.findall(page), strict=True):
        least = 0.1 if "." in then else 1
        assert float(today) == pytest.approx(float(then), rel=0.02, abs=least), told


def test_what_goes_beyond_a_limit_would_stand_there() -> None:
    from tests.faults.judge import Verdict

    beyond, nearest = script().beyond, script().nearest
    verdict = Verdict(worst={"joint velocity": 1.2, "radius": 0.5, "z": 0.05})
    assert beyond([verdict]) == ["joint velocity 1.200", "radius 0.500"]
    assert nearest([verdict]) == 1.2
