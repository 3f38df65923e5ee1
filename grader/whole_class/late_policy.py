"""The deadline of a class, what lateness costs, and which attempts count: `class.toml` in the folder of a class.

    deadline = "2026-11-20 23:59 Europe/Berlin"
    late = "10 % a day, 3 days"     # of all points for each day that has begun; after three days nothing is earned
    attempts = "best"               # or "last", or "mean": earlier attempts are kept, and lateness is that of each

Without the file, and for whom no time of submission is known, nothing is taken off. A student's own deadline is in
`overrides.csv`.
"""

from __future__ import annotations

import math
import re
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path

from gz_course.grader.errors import ManifestError, UsageError
from gz_course.grader.exercise.toml_table import Table
from gz_course.grader.learning_platforms.lateness import absolute
from gz_course.grader.learning_platforms.lateness import read_deadline as read_time
from gz_course.grader.printable import shown

CLASS = "class.toml"
BEST, LAST, MEAN = "best", "last", "mean"
COUNTED = (BEST, LAST, MEAN)  # of several attempts (`attempts.py`)
LATE = re.compile(r"(?P<percent>\d+(?:\.\d+)?) ?% (?:a|per) day(?:, (?P<days>\d+) days?)?")
DAY = 86_400.0  # [s]


@dataclass(frozen=True)
class LatePolicy:
    """What lateness costs: a part of all points for each day that has begun, and all after `days`.

    `attempts` says which attempts count; empty: the last, and earlier ones are not kept.
    """

    deadline: datetime | None
    part: float = 0.0
    days: int | None = None
    attempts: str = ""

    def taken_off(self, submitted: datetime | None, most: float, own: datetime | None = None) -> tuple[float, str]:
        """Return the points that a submission loses of `most`, and why in words; `own` is the student's deadline."""
        due = own or self.deadline
        if submitted is None or due is None:
            return 0.0, ""
        late = (absolute(submitted, due) - due.astimezone(UTC)).total_seconds()
        if late <= 0 or not self.part:
            return 0.0, ""
        days = math.ceil(late / DAY)
        if self.days is not None and days > self.days:
            return most, f"{days} days late, after {self.days} nothing is earned"
        return min(most, days * self.part * most), f"{days} {'day' if days == 1 else 'days'} late"


def read_policy(folder: Path) -> LatePolicy | None:
    """Return the policy of a class, None without a file. Raises UsageError if it cannot be read."""
    path = folder / CLASS
    if not path.exists():
        return None
    try:
        return _read(path)
    except ManifestError as error:
        raise UsageError(str(error)) from None


def _read(path: Path) -> LatePolicy:
    table = Table.load(path)
    attempts = table.choice("attempts", COUNTED) if table.has("attempts") else ""
    due = None
    if not attempts or table.has("deadline") or table.has("late"):
        due = read_deadline(table.text("deadline"), f"{path}: deadline")
    part, days = 0.0, None
    if table.has("late"):
        text = table.text("late")
        match = LATE.fullmatch(text.strip())
        if match is None:
            raise UsageError(f"{path}: late is {shown(text, 60)!r}; write it as '10 % a day, 3 days'")
        part, days = float(match["percent"]) / 100, int(match["days"]) if match["days"] else None
    table.end()
    return LatePolicy(due, part, days, attempts)


def read_deadline(text: str, where: str) -> datetime:
    """Return a time with its zone. Raises UsageError that begins with `where`."""
    try:
        return read_time(text)
    except UsageError as error:
        raise UsageError(str(error).replace("--deadline", where)) from None
