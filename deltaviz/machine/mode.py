"""The modes of the machine. Which change leads from one to another stands in `transitions`."""

from __future__ import annotations

from enum import StrEnum


class Mode(StrEnum):
    OFFLINE = "offline"
    DISABLED = "disabled"
    UNHOMED = "unhomed"
    HOMING = "homing"
    IDLE = "idle"
    JOGGING = "jogging"
    MOVING = "moving"
    RUNNING = "running"
    PAUSED = "paused"
    STOPPING = "stopping"
    FAULT = "fault"
    ESTOP = "estop"
