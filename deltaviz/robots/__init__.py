"""A robot is a mechanism with its limits, drive and homing."""

from deltaviz.robots.errors import RobotFileError
from deltaviz.robots.load import load_robot
from deltaviz.robots.presets import preset_names
from deltaviz.robots.reach import Reach, Reason
from deltaviz.robots.robot import Robot

__all__ = [
    "Reach",
    "Reason",
    "Robot",
    "RobotFileError",
    "load_robot",
    "preset_names",
]
