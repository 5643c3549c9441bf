"""The command line: `deltaviz` alone serves the page; the rest answers in the terminal."""

from __future__ import annotations

import argparse
import contextlib
import difflib
import json
import math
import os
import sys
from collections.abc import Callable, Sequence
from importlib.metadata import version
from pathlib import Path
from typing import TYPE_CHECKING, NoReturn

from deltaviz.terminal.status import BAD_USAGE, FAILED, OK, UsageError

if TYPE_CHECKING:  # the command line starts before the layers it needs are known
    from deltaviz.robots import Reach, Robot


class _Parser(argparse.ArgumentParser):
    """argparse, with errors in two lines rather than a usage dump."""

    def error(self, message: str) -> NoReturn:
        self.exit(BAD_USAGE, f"{self.prog}: {message}\nTry '{self.prog} --help'.\n")


def main(argv: Sequence[str] | None = None) -> int:
    """Run one command; the exit status: 0 done, 1 it could not be done, 2 bad usage."""
    arguments = _with_default_command(list(sys.argv[1:] if argv is None else argv))
    options = _parser().parse_args([_shield_negative(a) for a in arguments])
    command: Callable[[argparse.Namespace], int] = options.run
    try:
        return command(options)
    except UsageError as error:
        print(f"deltaviz: {error}", file=sys.stderr)
        return BAD_USAGE
    except BrokenPipeError:  # the reader of our output left early, as `head` does
        with contextlib.suppress(OSError):
            os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return FAILED


def _with_default_command(arguments: list[str]) -> list[str]:
    if not arguments:
        return ["serve"]
    first = arguments[0]
    if first.startswith("-") and first not in ("-h", "--help", "--version"):
        return ["serve", *arguments]
    if not first.startswith("-") and first not in _COMMANDS:
        near = difflib.get_close_matches(first, _COMMANDS, n=1)
        hint = f" Did you mean '{near[0]}'?" if near else ""
        known = ", ".join(_COMMANDS)
        print(f"deltaviz: no command '{first}'.{hint} Commands: {known}.", file=sys.stderr)
        raise SystemExit(BAD_USAGE)
    return arguments


def _shield_negative(argument: str) -> str:
    """argparse takes -1e-3 for an option; with a space before it, for the number it is."""
    if argument.startswith("-"):
        with contextlib.suppress(ValueError):
            float(argument)
            return f" {argument}"
    return argument


def _parser() -> argparse.ArgumentParser:
    parser = _Parser(
        prog="deltaviz", description="A 3D viewer and jog controller for delta robots."
    )
    parser.add_argument("--version", action="version", version=f"deltaviz {version('deltaviz')}")
    commands = parser.add_subparsers(dest="command", metavar="COMMAND", required=True)
    for name, (add, summary) in _COMMANDS.items():
        add(commands.add_parser(name, help=summary, description=summary))
    return parser


def _add_robot(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "--robot", default="stm32", metavar="NAME|FILE", help="preset or robot file (stm32)"
    )


def _add_json(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--json", action="store_true", help="print one JSON object")


def _add_serve(parser: argparse.ArgumentParser) -> None:
    _add_robot(parser)
    parser.add_argument(
        "--link",
        default="sim://",
        metavar="URL",
        help="the board: a serial port (/dev/ttyUSB0, serial:///dev/ttyUSB0?baud=115200), "
        "socket://HOST:PORT or another URL of pyserial's, or simulated (sim://)",
    )
    parser.add_argument("--host", default="127.0.0.1", help="address to listen on (127.0.0.1)")
    parser.add_argument(
        "--port", type=_port, default=8000, help="port to listen on; 0: any free one (8000)"
    )
    parser.add_argument("--no-browser", action="store_true", help="do not open the browser")
    parser.add_argument(
        "--capture", type=Path, metavar="FILE", help="add all that passes on the link to this file"
    )
    parser.set_defaults(run=_serve)


def _port(text: str) -> int:
    if not text.strip().isdecimal() or not 0 <= int(text) <= 65535:
        raise argparse.ArgumentTypeError(f"{text!r} is no port; use a number from 0 to 65535")
    return int(text)


def _serve(options: argparse.Namespace) -> int:
    from deltaviz.web.serve import serve

    _load(options.robot)  # a misspelt name is told before anything starts
    return serve(
        robot=options.robot,
        link=options.link,
        host=options.host,
        port=options.port,
        browser=not options.no_browser,
        capture=options.capture,
    )


def _add_ik(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "xyz", nargs="+", metavar="MM", help="tool tip: X Y Z in mm; Y is 0 for a planar robot"
    )
    _add_robot(parser)
    _add_json(parser)
    parser.set_defaults(run=_ik)


def _add_fk(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("theta", nargs="+", metavar="DEG", help="one angle per joint, in degrees")
    _add_robot(parser)
    _add_json(parser)
    parser.set_defaults(run=_fk)


def _ik(options: argparse.Namespace) -> int:
    import numpy as np

    from deltaviz.robots.coordinates import SPACE, CoordinateError, in_robot

    robot = _load(options.robot)
    try:
        xyz = in_robot(robot, _numbers(options.xyz, len(SPACE), "coordinates", "mm"))
    except CoordinateError as error:
        raise UsageError(str(error)) from None
    theta = np.degrees(robot.inverse(np.array(xyz)))
    if not np.isfinite(theta).all():
        print(f"deltaviz: {robot.reach(xyz)}", file=sys.stderr)
        return FAILED
    _print_values(theta.tolist(), key="theta_deg", unit="°", digits=6, as_json=options.json)
    _warn_of_limits(robot.reach(xyz))
    return OK


def _fk(options: argparse.Namespace) -> int:
    import numpy as np

    from deltaviz.robots.coordinates import in_space

    robot = _load(options.robot)
    theta = _numbers(options.theta, robot.joint_count, "angles", "degrees")
    xyz = robot.forward(np.radians(theta))
    if not np.isfinite(xyz).all():
        print("deltaviz: with these angles the forearms cannot meet", file=sys.stderr)
        return FAILED
    _print_values(
        list(in_space(xyz.tolist())), key="xyz_mm", unit="mm", digits=6, as_json=options.json
    )
    _warn_of_limits(robot.reach(xyz))
    return OK


def _warn_of_limits(reach: Reach) -> None:
    if not reach.legal:
        print(f"Note: outside this robot's limits. {reach}", file=sys.stderr)


def _numbers(texts: Sequence[str], count: int, what: str, unit: str) -> list[float]:
    if len(texts) != count:
        raise UsageError(f"this robot takes {count} {what} in {unit}; got {len(texts)}")
    return [_number(text, unit) for text in texts]


def _number(text: str, unit: str) -> float:
    try:
        value = float(text)
    except ValueError:
        raise UsageError(f"'{text.strip()}' is no number; use {unit} like -12.5") from None
    if not math.isfinite(value):
        raise UsageError(f"'{text.strip()}' is not finite; use {unit} like -12.5")
    return value


def _print_values(values: list[float], *, key: str, unit: str, digits: int, as_json: bool) -> None:
    if as_json:
        print(json.dumps({key: values}))
    else:
        shown = (f"{round(v, digits) + 0.0:.{digits}f}" for v in values)  # + 0.0: no "-0"
        print("  ".join(shown), unit)


def _add_workspace(parser: argparse.ArgumentParser) -> None:
    from deltaviz.terminal import workspace

    _add_robot(parser)
    _add_json(parser)
    workspace.add_arguments(parser)
    parser.set_defaults(run=_workspace)


def _workspace(options: argparse.Namespace) -> int:
    from deltaviz.terminal import workspace

    return workspace.run(_load(options.robot), options)


def _add_robots(parser: argparse.ArgumentParser) -> None:
    _add_json(parser)
    parser.set_defaults(run=_robots)


def _robots(options: argparse.Namespace) -> int:
    from deltaviz.robots import load_robot, preset_names

    robots = [load_robot(name) for name in preset_names()]
    if options.json:
        print(json.dumps({"robots": [robot.name for robot in robots]}))
        return OK
    for robot in robots:
        low, high = robot.zone.z
        print(
            f"{robot.name:<12} {robot.kind}, {robot.joint_count} joints, "
            f"Z {low:g} to {high:g} mm, {robot.drive.driver or 'simulation only'}"
        )
    return OK


def _add_ports(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "--list", action="store_true", help="only list them: open none (which restarts an Arduino)"
    )
    parser.add_argument(
        "--baud", type=_baud, metavar="N", help="baud rate at which to ask (921600)"
    )
    _add_json(parser)
    parser.set_defaults(run=_ports)


def _baud(text: str) -> int:
    if not text.strip().isdecimal() or int(text) == 0:
        raise argparse.ArgumentTypeError(f"{text!r} is no baud rate; use a number like 115200")
    return int(text)


def _ports(options: argparse.Namespace) -> int:
    from deltaviz.link.ports import list_ports
    from deltaviz.link.probe import probe_all
    from deltaviz.link.serial_link import BAUD
    from deltaviz.terminal import ports as terminal

    ports = list_ports()
    devices = [] if options.list else [port.device for port in ports]
    findings = probe_all(devices, baud=options.baud or BAUD)
    print((terminal.as_json if options.json else terminal.text)(ports, findings))
    return OK


def _add_emulate(parser: argparse.ArgumentParser) -> None:
    _add_robot(parser)
    parser.add_argument(
        "--port", type=_port, default=0, help="port of this computer to wait at (any free one)"
    )
    parser.set_defaults(run=_emulate)


def _emulate(options: argparse.Namespace) -> int:
    from deltaviz.link.transport import LinkError
    from deltaviz.terminal.emulate import emulate

    robot = _load(options.robot)
    try:
        emulate(
            robot,
            name=options.robot,
            port=options.port,
            out=sys.stdout,
            commands=sys.stdin,
        )
    except LinkError as error:
        print(f"deltaviz: {error}", file=sys.stderr)
        return FAILED
    except KeyboardInterrupt:
        pass
    return OK


def _add_monitor(parser: argparse.ArgumentParser) -> None:
    from deltaviz.terminal import monitor_options

    monitor_options.add_arguments(parser)
    parser.set_defaults(run=monitor_options.run)


def _add_verify(parser: argparse.ArgumentParser) -> None:
    _add_robot(parser)
    parser.add_argument(
        "--poses", type=_count, default=20_000, metavar="N", help="how many poses to try (20000)"
    )
    parser.add_argument("--seed", type=int, default=0, metavar="N", help="which poses (0)")
    _add_json(parser)
    parser.set_defaults(run=_verify)


def _count(text: str) -> int:
    if not text.strip().isdecimal() or not 1 <= int(text) <= 10_000_000:
        raise argparse.ArgumentTypeError(f"{text!r}: use a number from 1 to 10000000")
    return int(text)


def _verify(options: argparse.Namespace) -> int:
    robot = _load(options.robot)
    if options.seed < 0:
        raise UsageError("--seed must be at least 0")

    from deltaviz.robots.verification import verify
    from deltaviz.terminal import verify as terminal

    found = verify(robot, poses=options.poses, seed=options.seed)
    print((terminal.as_json if options.json else terminal.text)(found))
    return OK if found.agrees else FAILED


def _add_compare(parser: argparse.ArgumentParser) -> None:
    from deltaviz.terminal import compare

    compare.add_arguments(parser)
    _add_json(parser)
    parser.set_defaults(run=_compare)


def _compare(options: argparse.Namespace) -> int:
    from deltaviz.terminal import compare

    return compare.run(_load(options.first), _load(options.second), options)


def _add_design(parser: argparse.ArgumentParser) -> None:
    from deltaviz.terminal.design_options import add_arguments

    parser.add_argument(
        "--robot",
        default="stm32",
        metavar="NAME|FILE",
        help="whose joints, limits, drive and effector it has (stm32)",
    )
    add_arguments(parser)
    _add_json(parser)
    parser.set_defaults(run=_design)


def _design(options: argparse.Namespace) -> int:
    from deltaviz.robots.load import robot_text
    from deltaviz.terminal import design

    template = _load(options.robot)
    return design.run(template, robot_text(options.robot)[0], options)


def _load(name: str) -> Robot:
    from deltaviz.robots import RobotFileError, load_robot

    try:
        return load_robot(name)
    except RobotFileError as error:
        raise UsageError(str(error)) from None


_COMMANDS: dict[str, tuple[Callable[[argparse.ArgumentParser], None], str]] = {
    "serve": (_add_serve, "Run the server and open the page (the default command)."),
    "ik": (_add_ik, "Joint angles for a tool tip position."),
    "fk": (_add_fk, "Tool tip position for joint angles."),
    "workspace": (_add_workspace, "What a robot reaches, how well, and what fits inside."),
    "verify": (_add_verify, "Whether the kinematics agrees with itself and with other methods."),
    "compare": (_add_compare, "Two robots side by side: reach, precision, torque."),
    "design": (_add_design, "Lengths that reach what is wanted, as a robot file."),
    "robots": (_add_robots, "The robots that come with deltaviz."),
    "ports": (_add_ports, "Serial ports, with what they are, and which of them has a board."),
    "emulate": (_add_emulate, "The real firmware in QEMU, as a board to connect to."),
    "monitor": (_add_monitor, "What passes on a link, one line a message."),
}
