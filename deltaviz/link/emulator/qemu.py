"""How QEMU is called: which machine, whose clock, what stands at the ends of its serial ports."""

from __future__ import annotations

import shutil
from pathlib import Path

QEMU = "qemu-system-arm"
SETUP = 0x2002_0000  # RAM that QEMU's chip has, behind that of the STM32F407
MISSING = (
    "The emulated board needs QEMU, and there is no qemu-system-arm. On Debian and Ubuntu: "
    "sudo apt install qemu-system-arm"
)


def is_installed() -> bool:
    return shutil.which(QEMU) is not None


def command(
    image: Path,
    *,
    link: int,
    bench: int,
    pace: int,
    setup: int,
    listens: bool = False,
    trace: int | None = None,
) -> list[str]:
    """`link` and `bench` are descriptors of sockets: what the board's serial port is connected to
    (one that waits for connections, if it `listens`), and its bench; `pace` that of one over which
    its time is granted; `setup` one of a file with what the bench says before it starts. Every
    write to a register becomes a line in the descriptor `trace`.
    """
    listening = ",server=on,wait=off" if listens else ""
    arguments = [
        QEMU,
        # An STM32F405: for what the firmware uses, the twin of the STM32F407.
        *("-machine", "netduinoplus2", "-kernel", str(image)),
        *("-display", "none", "-monitor", "none", "-nodefaults"),
        # Virtual time: 8 ns an instruction, and no waiting. So every tick interrupts, in its turn.
        *("-icount", "shift=3,sleep=off"),
        *("-chardev", f"socket,id=bench,fd={bench}", "-serial", "chardev:bench"),  # USART1
        *("-chardev", f"socket,id=link,fd={link}{listening}", "-serial", "chardev:link"),  # USART2
        *("-chardev", f"socket,id=pace,fd={pace}", "-serial", "chardev:pace"),  # USART3
    ]
    # Bytes that come before the firmware has switched its serial port on would be lost.
    arguments += ["-device", f"loader,file=/dev/fd/{setup},addr={SETUP:#x},force-raw=on"]
    if trace is not None:
        arguments += ["-trace", "memory_region_ops_write", "-D", f"/dev/fd/{trace}"]
    return arguments
