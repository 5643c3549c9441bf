"""Why a serial port cannot be opened, for a person: the cause, and the way out."""

from __future__ import annotations

import errno
import os
import stat
from pathlib import Path

_IN_USE = (errno.EBUSY, errno.EAGAIN, errno.EWOULDBLOCK)
_DENIED = (errno.EACCES, errno.EPERM)
_GONE = (errno.EIO, errno.ENXIO, errno.ENODEV)


def trouble(device: str, error: Exception, *, group: str | None = None) -> str:
    """What `error`, raised while `device` was opened, means. All sentences end with a way out.

    `group` is the one that may open it; else it is looked up.
    """
    number = _number(error)
    if number == errno.ENOENT:
        return (
            f"There is no {device}. Plug the board in, or choose another port "
            "(deltaviz ports lists them), then connect."
        )
    if number in _IN_USE:
        return f"{device} is in use by {_users(device)}. End that, then connect."
    if number in _DENIED:
        return f"{device} may not be opened. {_way_in(group or _group(device))}"
    if number in _GONE:
        return (
            f"{device} does not work ({os.strerror(number)}). Pull the board's cable, plug it in "
            "again, then connect."
        )
    if number in (errno.ENOTTY, errno.EINVAL, errno.EISDIR) or not _is_device(device):
        return f"{device} is no serial port. Choose another (deltaviz ports lists them)."
    return f"{device} cannot be opened: {error}."


def users(device: str) -> list[tuple[int, str]]:
    """The processes that have `device` open, as far as this user may see: number and name."""
    target = os.path.realpath(device)
    found: list[tuple[int, str]] = []
    for process in Path("/proc").glob("[0-9]*"):
        try:
            uses = any(os.path.realpath(link) == target for link in (process / "fd").iterdir())
            if uses and int(process.name) != os.getpid():
                found.append((int(process.name), (process / "comm").read_text().strip()))
        except OSError:  # it has ended, or is another user's
            continue
    return found


def _number(error: Exception) -> int:
    """The system's error number behind pyserial's exception; 0 for none."""
    causes = (error, error.__context__, error.__cause__)
    for cause in causes:
        number = getattr(cause, "errno", None)
        if isinstance(number, int):
            return number
    for cause in causes:  # termios.error is no OSError
        first = cause.args[0] if cause is not None and cause.args else None
        if isinstance(first, int):
            return first
    return 0


def _users(device: str) -> str:
    names = [f"{name} (process {number})" for number, name in users(device)]
    return " and ".join(names) or "another program"


def _way_in(group: str | None) -> str:
    if group is None:
        return "Ask its owner for permission."
    return (
        f"Join the group {group} that may: sudo usermod -aG {group} $USER, log out and in again, "
        "then connect."
    )


def _group(device: str) -> str | None:
    """The group that may read and write `device`; None: there is none."""
    import grp  # not on every system

    try:
        about = os.stat(device)
        both = stat.S_IRGRP | stat.S_IWGRP
        return grp.getgrgid(about.st_gid).gr_name if about.st_mode & both == both else None
    except (OSError, KeyError):
        return None


def _is_device(device: str) -> bool:
    try:
        return stat.S_ISCHR(os.stat(device).st_mode)
    except OSError:
        return False
