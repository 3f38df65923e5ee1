"""The deadline of an exercise, and how late a submission was: a hint for the instructor, which costs no points."""

from __future__ import annotations

import re
from datetime import UTC, datetime, timedelta, tzinfo
from zoneinfo import ZoneInfo, ZoneInfoNotFoundError

from gz_course.grader.errors import UsageError
from gz_course.grader.printable import shown

EXAMPLE = "--deadline '2026-11-20 23:59 Europe/Berlin' or 2026-11-20T23:59+01:00"
UNKNOWN = "unknown"


def read_deadline(text: str) -> datetime:
    """Return a deadline with its time zone: an ISO time with an offset, or followed by the name of a zone.

    Of a local time that comes twice, when clocks are put back, it is the later one. Raises UsageError if it cannot be
    read, has no zone, or is skipped when clocks are put forward.
    """
    words = text.split()
    zone: tzinfo | None = None
    if len(words) > 1 and re.search("[A-Za-z]", words[-1]) and not re.match(r"\d", words[-1]):
        zone = _zone(words.pop())
    try:
        time = datetime.fromisoformat(" ".join(words))
    except ValueError:
        raise UsageError(f"--deadline {shown(text, 80)!r} is no time; write it as {EXAMPLE}") from None
    if len(words) == 1 and not re.search(r"\d[T ]\d|^\d{8}T", words[0]):
        raise UsageError(f"--deadline {shown(text, 80)!r} has no time of the day; write it as {EXAMPLE}")
    if time.tzinfo is None and zone is None:
        raise UsageError(f"--deadline {shown(text, 80)!r} has no time zone; write it as {EXAMPLE}")
    if time.tzinfo is not None:
        return time
    local = time.replace(tzinfo=zone, fold=1)
    if local.astimezone(UTC).astimezone(zone).replace(tzinfo=None) != time:
        raise UsageError(f"--deadline {shown(text, 80)!r}: clocks are put forward then, and this time is skipped")
    return local


def _zone(name: str) -> tzinfo:
    try:
        return UTC if name.upper() in ("UTC", "Z", "GMT") else ZoneInfo(name)
    except (ZoneInfoNotFoundError, ValueError, OSError):
        raise UsageError(
            f"there is no time zone {shown(name, 80)!r} here; expected a name such as Europe/Berlin, or an offset: "
            f"{EXAMPLE}"
        ) from None


def lateness(deadline: datetime, submitted: datetime | None) -> str:
    """Return the cell of the column LATE: empty if in time, `unknown`, or by how much it was late.

    A submission time without a zone is taken to be in the deadline's zone.
    """
    if submitted is None:
        return UNKNOWN
    late = absolute(submitted, deadline) - deadline.astimezone(UTC)
    return f"LATE by {_duration(late)}" if late > timedelta(0) else ""


def absolute(time: datetime, deadline: datetime) -> datetime:
    """Return a time in UTC; without a zone it is one of the deadline's, and the earlier of two."""
    try:
        return (time if time.tzinfo else time.replace(tzinfo=deadline.tzinfo, fold=0)).astimezone(UTC)
    except (OverflowError, ValueError):  # in the year 1 or 9999
        return time.replace(tzinfo=UTC)


def _duration(late: timedelta) -> str:
    minutes, seconds = divmod(int(late.total_seconds()), 60)
    hours, minutes = divmod(minutes, 60)
    days, hours = divmod(hours, 24)
    parts = [f"{value} {unit}" for value, unit in ((days, "d"), (hours, "h"), (minutes, "min")) if value]
    return " ".join(parts) or f"{max(seconds, 1)} s"
