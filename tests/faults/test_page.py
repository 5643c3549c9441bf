"""docs/reliability.md is today's: what was measured here stands there."""

from __future__ import annotations

import importlib.util
from pathlib import Path
from types import ModuleType

DOCS = Path(__file__).parents[2] / "docs"


def script() -> ModuleType:
    spec = importlib.util.spec_from_file_location("reliability", DOCS / "reliability.py")
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_the_page_is_todays() -> None:
    todays = script().todays()
    assert todays == (DOCS / "reliability.md").read_text(), "run: python docs/reliability.py"


def test_what_goes_beyond_a_limit_would_stand_there() -> None:
    from tests.faults.judge import Verdict

    beyond, nearest = script().beyond, script().nearest
    verdict = Verdict(worst={"joint velocity": 1.2, "radius": 0.5, "z": 0.05})
    assert beyond([verdict]) == ["joint velocity 1.200", "radius 0.500"]
    assert nearest([verdict]) == 1.2
