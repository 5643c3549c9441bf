import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from deltaviz.mechanism import FiveBar, RotaryDelta

REFERENCE = Path(__file__).parents[1] / "data" / "reference"
FIVE_BARS = REFERENCE / "five_bar"


@dataclass(frozen=True)
class Reference:
    """One reference file and the mechanism that it speaks of."""

    mechanism: Any
    cases: dict[str, list[dict[str, Any]]]

    def column(self, cases: str, key: str) -> np.ndarray:
        return np.array([case[key] for case in self.cases[cases]])

    def angles(self, cases: str) -> np.ndarray:
        return np.radians(self.column(cases, "theta_deg"))


def _names(folder: Path) -> list[str]:
    return sorted(path.stem for path in folder.glob("*.json"))


def _load(folder: Path, name: str, mechanism: type) -> Reference:
    data = json.loads((folder / f"{name}.json").read_text())
    return Reference(mechanism=mechanism(**data["geometry"]), cases=data)


@pytest.fixture(scope="module", params=_names(REFERENCE))
def reference(request: pytest.FixtureRequest) -> Reference:
    return _load(REFERENCE, request.param, RotaryDelta)


@pytest.fixture(scope="module", params=_names(FIVE_BARS))
def planar_reference(request: pytest.FixtureRequest) -> Reference:
    return _load(FIVE_BARS, request.param, FiveBar)


@pytest.fixture(scope="session")
def stm32() -> RotaryDelta:
    return RotaryDelta(base_radius=115, effector_radius=75, upper_arm=125, forearm=338)


@pytest.fixture(scope="session")
def trossen() -> RotaryDelta:
    return RotaryDelta.from_sides(f=457.3, e=115, upper_arm=112, forearm=232)


@pytest.fixture(scope="session")
def uneven() -> RotaryDelta:
    """Every length and every direction different, as calibration leaves them."""
    return RotaryDelta(
        base_radius=(115.0, 117.5, 112.5),
        effector_radius=(75.0, 74.0, 77.0),
        upper_arm=(125.0, 122.0, 127.5),
        forearm=(338.0, 335.0, 342.0),
        azimuths_deg=(3.0, 118.0, 245.0),
    )
