"""The simulated board: what a real one does with messages, as a pure object."""

from deltaviz.link.board.board import SimulatedBoard

__all__ = ["SimulatedBoard"]
