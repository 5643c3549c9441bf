"""The link as the surfaces see it: how far it has come, and how it is doing."""

from __future__ import annotations

from deltaviz.link.report import LinkReport
from deltaviz.link.session import Session
from deltaviz.machine.snapshot import LinkPhase, LinkStatus


def link_status(
    link: str,
    session: Session | None,
    report: LinkReport,
    *,
    opening: bool,
    problem: str | None,
    note: str | None,
    now: float,
) -> LinkStatus:
    if session is None:
        phase = LinkPhase.OPENING if opening else LinkPhase.CLOSED
        return LinkStatus(link, phase, problem=problem)
    board, telemetry = session.board, session.telemetry
    places = 0 if board is None else board.queue_places
    return LinkStatus(
        id=link,
        phase=LinkPhase.READY if session.ready else LinkPhase.GREETING,
        age=session.age(now),
        problem=problem,
        note=note,
        board=None if board is None else f"{board.board} {board.build}".strip(),
        round_trip=report.round_trip,
        dropped=report.dropped,
        queued=0 if telemetry is None else max(0, places - telemetry.free),
        queue_places=places,
        ahead=session.ahead(now),
    )


def waiting_for_answer(status: LinkStatus) -> str | None:
    """What to tell while the link comes up; None when it does not."""
    match status.phase:
        case LinkPhase.OPENING:
            return f"Opening {status.id}."
        case LinkPhase.GREETING:
            return f"Waiting for the board on {status.id} to answer."
        case _:
            return None
