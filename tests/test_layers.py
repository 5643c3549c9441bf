"""The five layers know only those above them, and no module reaches sideways."""

from __future__ import annotations

import ast
from pathlib import Path

import pytest

PACKAGE = Path(__file__).parents[1] / "deltaviz"

# Each folder, with what it may import of ours.
MAY_IMPORT = {
    "mechanism": {"mechanism"},
    "robots": {"mechanism", "robots"},
    "motion": {"mechanism", "robots", "motion"},
    "link": {"mechanism", "robots", "motion", "link"},
    "machine": {"mechanism", "robots", "motion", "link", "machine"},
    "scene": {"mechanism", "robots", "motion", "machine", "scene"},
    "terminal": {"mechanism", "robots", "motion", "link", "machine", "terminal"},
    "web": {"mechanism", "robots", "motion", "link", "machine", "scene", "web"},
}


def imported_layers(source: str, package: str) -> set[str]:
    """Our folders that a module's text imports, relative imports resolved to `package`."""
    found: set[str] = set()
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.ImportFrom):
            names = [node.module or ""]
            if node.level == 1:
                found.add(package)
                continue
        elif isinstance(node, ast.Import):
            names = [alias.name for alias in node.names]
        else:
            continue
        found |= {n.split(".")[1] for n in names if n.startswith("deltaviz.")}
    return found


@pytest.mark.parametrize("layer", MAY_IMPORT)
def test_a_layer_imports_only_from_above(layer: str) -> None:
    for module in (PACKAGE / layer).rglob("*.py"):
        extra = imported_layers(module.read_text(), layer) - MAY_IMPORT[layer]
        assert not extra, f"{module.relative_to(PACKAGE)} imports {sorted(extra)}"


def test_every_folder_has_its_place() -> None:
    folders = {p.name for p in PACKAGE.iterdir() if p.is_dir() and not p.name.startswith("_")}
    assert folders == set(MAY_IMPORT)


def test_a_wrong_import_is_seen() -> None:
    source = "def late():\n    from deltaviz.web.app import create_app\n"
    assert imported_layers(source, "motion") - MAY_IMPORT["motion"] == {"web"}
