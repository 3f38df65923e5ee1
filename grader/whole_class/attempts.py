"""Several attempts of a student: kept, graded and counted if `class.toml` says how (`attempts = "best"`).

An export may have all attempts (Blackboard, Brightspace); of other platforms, what a student hands in again is found
when the class is graded again. The last attempt has the student's own folder, each earlier one a folder in `attempts/`.
"""

from __future__ import annotations

import shutil
from collections.abc import Iterable, Sequence
from pathlib import Path
from statistics import fmean
from typing import Any

from gz_course.grader.errors import InfrastructureError
from gz_course.grader.whole_class.journal import Journal, Results
from gz_course.grader.whole_class.late_policy import BEST, LAST
from gz_course.grader.whole_class.students_folder import ATTEMPTS, folder_name

UNGRADED = "ungraded"  # key of a last attempt, if an earlier one could not be graded

Result = dict[str, Any]


def attempt_folder(student: str, key: str) -> str:
    """Return the folder of an earlier attempt, below that of the class: nobody else's, and no other attempt's."""
    return f"{ATTEMPTS}/{folder_name(student)}-{key[:12]}"


def is_earlier(result: Result) -> bool:
    """Return whether a result is that of an earlier attempt."""
    return str(result["folder"]).startswith(f"{ATTEMPTS}/")


def earlier_attempts(results: Results) -> dict[str, list[Result]]:
    """Return the results of earlier attempts by student, in the order in which they were handed in."""
    every = results.all()
    last = {(each["student"], _content(each)) for each in every if not is_earlier(each)}
    known = {(each["student"], _content(each)): each for each in every if is_earlier(each)}  # the last grading of each
    found: dict[str, list[Result]] = {}
    for (student, content), each in known.items():
        if (student, content) not in last:
            found.setdefault(student, []).append(each)
    return {student: sorted(each, key=lambda one: one.get("submitted") or "") for student, each in found.items()}


def _content(result: Result) -> str:
    return str(result["sha256"] or f"\n{result['submission']}")


def move(out: Path, journal: Journal, key: str, result: Result, folder: str) -> Result:
    """Move what a result left into another folder, and return the result with it."""
    try:
        (out / folder).parent.mkdir(exist_ok=True)
        if (out / folder).exists():
            shutil.rmtree(out / folder)
        (out / result["folder"]).rename(out / folder)
    except OSError as error:
        raise InfrastructureError(f"{out / folder} cannot be written: {error.strerror}; nothing is lost") from None
    moved = result | {"folder": folder}
    journal.add(key, moved)
    return moved


def keep_earlier(out: Path, journal: Journal, student: str, sha256: str) -> None:
    """Keep what a student's folder holds as an earlier attempt, before another submission is graded into it."""
    folder = folder_name(student)
    if (held := journal.held(folder)) is None:
        return
    key, result = held
    if result["sha256"] not in ("", sha256) and (out / folder).is_dir():
        move(out, journal, key, result, attempt_folder(student, key))


def counted(how: str, scored: Sequence[Result]) -> tuple[Result, list[str]]:
    """Return the result that counts of all attempts, the last one last, and what to tell about it."""
    scores = [each["score"] for each in scored]
    told = ", ".join("no grade" if score is None else f"{score:g}" for score in scores)
    if how == LAST or len(scored) == 1 or all(score is None for score in scores):
        return scored[-1], []
    if how == BEST:
        place = max(range(len(scored)), key=lambda n: (-1.0 if scores[n] is None else scores[n], n))
        return scored[place], [f"attempt {place + 1} of {len(scored)} counts, the best of {told}"]
    graded = [each for each in scored if each["score"] is not None]
    ids = dict.fromkeys(id for each in graded for id in each["points"])
    points = {id: _mean(each["points"].get(id, 0) for each in graded) for id in ids}
    mean = scored[-1] | {"score": _mean(each["score"] for each in graded), "points": points}
    mean["machine_score"] = _mean(each["machine_score"] for each in graded)
    return mean, [f"the mean of {len(graded)} attempts counts: {told}"]


def _mean(values: Iterable[float]) -> float:
    return round(fmean(values), 6)
