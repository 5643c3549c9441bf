"""Lengths for a robot that must reach something: searched, proved, and written as a robot file."""

from deltaviz.robots.design.candidate import Lengths, Ranges
from deltaviz.robots.design.designing import Designed, design
from deltaviz.robots.design.score import Preference, Task
from deltaviz.robots.design.search import Found, NothingReaches, search
from deltaviz.robots.design.wish import Wish

__all__ = [
    "Designed",
    "Found",
    "Lengths",
    "NothingReaches",
    "Preference",
    "Ranges",
    "Task",
    "Wish",
    "design",
    "search",
]
