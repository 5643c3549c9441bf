"""The arguments of `deltaviz monitor`, and what they ask of it."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from deltaviz.terminal.status import FAILED, UsageError


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("url", nargs="?", metavar="URL", help="a port to listen on")
    parser.add_argument("--capture", type=Path, metavar="FILE", help="what serve --capture wrote")
    parser.add_argument("--follow", action="store_true", help="go on while the capture grows")
    parser.add_argument("--only", type=_names, default=(), metavar="NAMES", help="Arm,Segment,...")
    parser.add_argument("--hide", type=_names, default=(), metavar="NAMES", help="Telemetry,Keep")
    parser.add_argument("--from", dest="sender", choices=("host", "board"), help="one side's words")
    parser.add_argument(
        "--replay",
        choices=("session", "board"),
        help="run a capture again: the host's session with the board's words, or the simulated "
        "board with the host's; status 1 if it does not come out the same",
    )
    parser.add_argument("--json", action="store_true", help="one JSON object a line")


def _names(text: str) -> tuple[str, ...]:
    from deltaviz.terminal.monitor import NAMES

    names = tuple(name.strip() for name in text.split(","))
    for name in names:
        if name not in NAMES:
            known = ", ".join(NAMES)
            raise argparse.ArgumentTypeError(f"there is no message {name!r}; there is: {known}")
    return names


def run(options: argparse.Namespace) -> int:
    from deltaviz.link.capture.reader import CaptureError
    from deltaviz.link.capture.spoken import ReplayError
    from deltaviz.link.traffic import Sender
    from deltaviz.link.transport import LinkError
    from deltaviz.terminal import monitor

    if (options.url is None) == (options.capture is None):
        raise UsageError("monitor takes either a port's URL or --capture FILE")
    if options.capture is None and (options.follow or options.replay):
        raise UsageError("--follow and --replay go with --capture FILE")
    try:
        if options.capture is not None and options.replay is not None:
            return monitor.replay(options.capture, options.replay, as_json=options.json)
        sender = None if options.sender is None else Sender(options.sender)
        filter_ = monitor.Filter(options.only, options.hide, sender)
        return monitor.run(
            url=options.url,
            capture=options.capture,
            follow=options.follow,
            filter_=filter_,
            as_json=options.json,
        )
    except (CaptureError, LinkError, ReplayError) as error:
        print(f"deltaviz: {error}", file=sys.stderr)
        return FAILED
