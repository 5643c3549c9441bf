from pathlib import Path

import pytest

from deltaviz.robots import Robot, load_robot, preset_names
from deltaviz.robots.presets import preset_text


@pytest.fixture(scope="session")
def stm32() -> Robot:
    return load_robot("stm32")


@pytest.fixture(scope="session")
def stm32_text() -> str:
    return preset_text("stm32")


@pytest.fixture(scope="session", params=preset_names())
def preset(request: pytest.FixtureRequest) -> Robot:
    return load_robot(request.param)


TOOL_AXIS = Path(__file__).parents[2] / "docs" / "examples" / "stm32-tool.toml"


@pytest.fixture(scope="session")
def tool_robot() -> Robot:
    """The preset stm32 with a tool that turns."""
    return load_robot(TOOL_AXIS)


@pytest.fixture(scope="session")
def tool_text() -> str:
    return TOOL_AXIS.read_text()
