"""Draws the picture of sources.md that stands for Zheng and Chen's figures 4 to 8.

python docs/workspace_pictures.py    write docs/zheng2023-workspace.png (needs matplotlib)
"""

from __future__ import annotations

from pathlib import Path

from source_tables.zheng_chen import published

if __name__ == "__main__":
    published().plot(str(Path(__file__).parent / "zheng2023-workspace.png"))
