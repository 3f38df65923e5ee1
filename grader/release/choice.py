"""Which exercises `course release --only` takes: `00-05`, `03`, `03_teleop`, or several of these with commas."""

from __future__ import annotations

import re
from collections.abc import Sequence

from gz_course.grader.errors import UsageError
from gz_course.grader.exercise import Exercise
from gz_course.sim.did_you_mean import did_you_mean

RANGE = re.compile(r"(\d{1,2})-(\d{1,2})")


def chosen(text: str, exercises: Sequence[Exercise]) -> list[str]:
    """Return the names of the exercises that a choice means, in their order. Drafts in a range are left out.

    Raises UsageError for a part that means none, or names a draft.
    """
    found: set[str] = set()
    for part in filter(None, map(str.strip, text.split(","))):
        if limits := RANGE.fullmatch(part):
            first, last = sorted(map(int, limits.groups()))
            drafts = [each for each in exercises if each.draft]
            meant = [e for e in exercises if first <= _number(e.name) <= last and e not in drafts]
        else:
            begin = f"{int(part):02d}_" if part.isascii() and part.isdigit() and len(part) < 3 else part
            meant = [each for each in exercises if each.name == part or each.name.startswith(begin)]
            if draft := next((each for each in meant if each.draft), None):
                raise UsageError(
                    f"{draft.name} is a draft: remove `draft = true` from {draft.manifest}, then release it"
                )
        if not meant:
            names = [each.name for each in exercises]
            raise UsageError(
                f"--only {part} means no exercise that is finished{did_you_mean(part, names, listing='known')}"
            )
        found |= {each.name for each in meant}
    if not found:
        raise UsageError("--only names no exercise; give numbers or names, such as 00-05 or 03_teleop")
    return [each.name for each in exercises if each.name in found]


def _number(name: str) -> int:
    digits = name[:2]
    return int(digits) if digits.isascii() and digits.isdigit() else -1
