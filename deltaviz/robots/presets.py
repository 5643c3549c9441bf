"""The robot files that come with the package."""

from __future__ import annotations

from importlib import resources


def preset_names() -> tuple[str, ...]:
    """Names of the presets, the default one first."""
    found = (entry.name for entry in (resources.files("deltaviz.robots") / "presets").iterdir())
    names = {name.removesuffix(".toml") for name in found if name.endswith(".toml")}
    return tuple(sorted(names, key=lambda name: (name != "stm32", name)))


def preset_text(name: str) -> str:
    """The robot file of a preset."""
    path = resources.files("deltaviz.robots") / "presets" / f"{name}.toml"
    return path.read_text(encoding="utf-8")
