"""`emulate://`: the board's real firmware in QEMU, with arms on its pins."""
