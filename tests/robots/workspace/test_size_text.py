"""How large a workspace is, as a person reads it."""

import pytest

from deltaviz.robots.workspace.size_text import size_text


@pytest.mark.parametrize(
    ("size", "dimensions", "told"),
    [
        (30_863_000.0, 3, "30.86 l"),
        (30_857_158_368_000.0, 3, "30857158 l"),
        (1882.6, 3, "1.883 cm³"),
        (30.85, 3, "30.85 mm³"),
        (35_050.0, 2, "350.5 cm²"),
        (3.505, 2, "3.505 mm²"),
    ],
)
def test_the_unit_fits_the_size(size: float, dimensions: int, told: str) -> None:
    assert size_text(size, dimensions=dimensions) == told
