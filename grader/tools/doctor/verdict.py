"""An answer of `course doctor`: what was seen and, if it is a problem, what to do about it."""

from __future__ import annotations

from dataclasses import dataclass

OK, WARNING, FAILED = "ok", "warning", "failed"


@dataclass(frozen=True)
class Verdict:
    """`status` is ok, warning (works, but worth knowing) or failed (does not work); `fix` is one sentence."""

    status: str
    seen: str
    fix: str = ""


def fine(seen: str) -> Verdict:
    return Verdict(OK, seen)


def warning(seen: str, fix: str) -> Verdict:
    """Return a verdict for what works but may surprise."""
    return Verdict(WARNING, seen, fix)


def failed(seen: str, fix: str) -> Verdict:
    """Return a verdict for what does not work."""
    return Verdict(FAILED, seen, fix)
