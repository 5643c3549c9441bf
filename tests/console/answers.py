"""What the server tells a page: a state, a robot, the links, and the scene's view."""

from __future__ import annotations

from typing import Any

READY: dict[str, Any] = {
    "mode": "idle",
    "homed": True,
    "robot": "stm32",
    "xyz_mm": [12.4, -3.15, -301.02],
    "theta_deg": [21.44, 18.02, 24.91],
    "command_xyz_mm": [12.4, -3.15, -301.0],
    "command_theta_deg": [21.44, 18.02, 24.9],
    "target_xyz_mm": [12.4, -3.15, -301.0],
    "target_theta_deg": [21.44, 18.02, 24.9],
    "xyz_speed_share": [0.0, 0.0, 0.0],
    "theta_speed_share": [0.0, 0.0, 0.0],
    "margins": [0.9, 0.9, 0.9],
    "held_by": [],
    "link": {
        "id": "sim",
        "connected": True,
        "phase": "ready",
        "age_ms": 4.0,
        "problem": None,
        "note": None,
        "board": "simulated python",
        "round_trip_ms": 0.8,
        "dropped": 0,
        "queued": 6,
        "queue_places": 64,
        "ahead_ms": 58.0,
    },
    "control": {"holder": "you", "you": True},
    "stop_reason": None,
    "fault": None,
    "override": 1.0,
    "next_step": None,
    "board_time_s": 1.0,
    "underruns": 0,
    "capture": None,
}
PORTS = [{"id": "sim", "description": "Simulated board"}]
ROBOT: dict[str, Any] = {
    "name": "stm32",
    "joints": 3,
    "joint_names": ["θ1", "θ2", "θ3"],
    "axes": ["X", "Y", "Z"],
    "tool_axis": False,
    "presets": ["deltadraw", "stm32", "trossen", "zheng2023"],
    "workspace": {"z": [-440, -225], "radius": 230, "x": None, "y": None},
    "limits": {
        "joint": {
            "min_deg": [-45, -45, -45],
            "max_deg": [90, 90, 90],
            "velocity_deg_s": [340, 340, 340],
            "unhomed_velocity_deg_s": [5, 5, 5],
        },
        "cartesian": {"velocity": 600, "acceleration": 6000, "jerk": 150000},
    },
}

# What differs from READY and ROBOT for the other shapes of robots.
SHAPES: dict[str, tuple[dict[str, Any], dict[str, Any]]] = {
    "planar": (
        {
            "xyz_mm": [5.25, 0.0, -181.5],
            "theta_deg": [30.0, 26.5],
            "command_xyz_mm": [5.25, 0.0, -181.5],
            "command_theta_deg": [30.0, 26.5],
            "target_xyz_mm": [5.25, 0.0, -181.5],
            "target_theta_deg": [30.0, 26.5],
            "theta_speed_share": [0.0, 0.0],
            "margins": [0.9, 0.9],
        },
        {
            "joints": 2,
            "joint_names": ["θ1", "θ2"],
            "axes": ["X", "Z"],
            "workspace": {"x": [-100, 100], "y": None, "z": [-240, -130], "radius": None},
        },
    ),
    "tool": (
        {
            "theta_deg": [21.44, 18.02, 24.91, -40.0],
            "command_theta_deg": [21.44, 18.02, 24.91, -40.0],
            "target_theta_deg": [21.44, 18.02, 24.91, -40.0],
            "theta_speed_share": [0.0, 0.0, 0.0, 0.0],
            "margins": [0.9, 0.9, 0.9, 0.9],
        },
        {"joints": 4, "joint_names": ["θ1", "θ2", "θ3", "Tool"], "tool_axis": True},
    ),
}


# One of each kind that the scene may have in its panel.
VIEW: list[dict[str, Any]] = [
    {
        "kind": "toggle",
        "key": "Display: Trail",
        "group": "Display",
        "label": "Trail",
        "value": True,
    },
    {
        "kind": "toggle",
        "key": "Workspace: Reach",
        "group": "Workspace",
        "label": "Reach",
        "value": False,
    },
    {
        "kind": "choice",
        "key": "Workspace: Colours",
        "group": "Workspace",
        "label": "Colours",
        "value": "One colour",
        "options": ["One colour", "Conditioning", "Resolution"],
    },
    {
        "kind": "line",
        "key": "Workspace: Point",
        "group": "Workspace",
        "label": "Point",
        "value": "",
        "hint": "Type X Y Z in mm.",
        "longest": 80,
    },
    {
        "kind": "readout",
        "key": "Workspace: Reach told",
        "group": "Workspace",
        "rows": [
            {
                "kind": "row",
                "text": "Reach: 31.0 l, drawn within 0.5 mm.",
                "value": "",
                "dot": None,
            },
            {"kind": "row", "text": "Type 2", "value": "9 mm", "dot": [200, 30, 120]},
            {
                "kind": "colours",
                "name": "Resolution, mm per microstep",
                "low": "0.03",
                "high": "0.11",
                "stops": [[68, 40, 120], [252, 231, 62]],
            },
        ],
    },
    {
        "kind": "slider",
        "key": "Geometry: Forearm",
        "group": "Geometry",
        "label": "Forearm",
        "value": 338.0,
        "low": 135.0,
        "high": 676.0,
        "step": 1.0,
    },
    {
        "kind": "button",
        "key": "Geometry: Save as robot file",
        "group": "Geometry",
        "label": "Save as robot file",
        "disabled": True,
    },
]
