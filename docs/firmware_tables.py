"""What the firmware costs: measured by building it and running it in Unicorn."""

from __future__ import annotations

import subprocess

from deltaviz.link.emulator.firmware import built
from tests.firmware.budget import CPU_HZ, INTERRUPT, STEP, TICK_HZ, budget, share


def measured() -> str:
    return "\n\n".join((_costs(), _shares(), _sizes(), _compiler()))


def _costs() -> str:
    axes = (3, 4)
    rows = [
        "| instructions on average, cycles on average and at worst | "
        + " | ".join(f"{joints} axes" for joints in axes)
        + " |",
        "| --- | --- | --- |",
    ]
    for name in budget(3):
        costs = [budget(joints)[name] for joints in axes]
        cells = [f"{c.mean.instructions}, {c.mean.cycles}, {c.worst.cycles}" for c in costs]
        rows.append(f"| {name} | {' | '.join(cells)} |")
    return "\n".join(rows)


def _shares() -> str:
    tick = CPU_HZ // TICK_HZ
    three, four = (100 * (budget(joints)[STEP].mean.cycles + INTERRUPT) / tick for joints in (3, 4))
    return (
        f"A tick has {tick} cycles, so stepping takes {three:.0f} % of the processor with three "
        f"axes at their top speed, {four:.0f} % with four. With control, a full link and 100 "
        f"segments a second it is {100 * share(3):.0f} % and {100 * share(4):.0f} %."
    )


def _sizes() -> str:
    rows = ["| image | flash, bytes | RAM, bytes, 8192 of them stack |", "| --- | --- | --- |"]
    for image in ("disc1", "f407vet6", "emulator"):
        told = subprocess.check_output(["arm-none-eabi-size", built(f"{image}.elf")], text=True)
        text, data, bss = map(int, told.splitlines()[1].split()[:3])
        rows.append(f"| {image} | {text + data} | {data + bss} |")
    return "\n".join(rows)


def _compiler() -> str:
    told = subprocess.check_output(["arm-none-eabi-gcc", "-dumpfullversion"], text=True)
    return f"Made with arm-none-eabi-gcc {told.strip()}."
