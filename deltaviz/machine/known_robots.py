"""Whose configuration a board has: the robots that may be chosen, by the hash of theirs."""

from __future__ import annotations

from collections.abc import Mapping

from deltaviz.link.configuration import check_configurable, configuration_hash, configure_from
from deltaviz.robots import RobotFileError, load_robot


class KnownRobots:
    """`sources` are names or paths by id. They are read when somebody first asks."""

    def __init__(self, sources: Mapping[str, str]) -> None:
        self._sources = sources

    def name_of(self, digest: int) -> str | None:
        """The id of the robot whose configuration has this hash."""
        for id_, source in self._sources.items():
            try:
                robot = load_robot(source)
                check_configurable(robot)
                if configuration_hash(configure_from(robot)) == digest:
                    return id_
            except RobotFileError:  # changed since the start, and spoilt
                continue
        return None
