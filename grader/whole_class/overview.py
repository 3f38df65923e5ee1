"""What a class leaves beside the folders of students: gradebook and page, and what they say while a run goes on."""

from __future__ import annotations

import contextlib
from collections.abc import Mapping, Sequence
from pathlib import Path
from types import MappingProxyType
from typing import Any

from gz_course.grader.errors import InfrastructureError
from gz_course.grader.exercise import Exercise
from gz_course.grader.whole_class.final import Final, names_and_ids, tell_students
from gz_course.grader.whole_class.gradebook import as_csv, write_gradebook
from gz_course.grader.whole_class.index import write_index

PENDING = "pending"  # the outcome of who is not graded yet, while a run goes on
PARTS = 50  # times that the gradebook of a class is written while a run goes on

Result = dict[str, Any]


def write_overview(
    out: Path,
    exercise: Exercise,
    results: list[Result],
    reports: Sequence[str],
    earlier: Mapping[str, Sequence[Result]] = MappingProxyType({}),
) -> list[Result]:
    """Write gradebook and page, and say in the reports what was changed by hand; return the results that count.

    `earlier` are the results of earlier attempts by student. Raises InfrastructureError if that cannot be done,
    UsageError if the changes cannot be read.
    """
    final = Final(exercise, out, names_and_ids(results)).results(results, earlier)
    try:
        tell_students(out, final)
        write_gradebook(out, as_csv(exercise, final))
        write_index(out, exercise, final, reports)
    except OSError as error:
        raise InfrastructureError(
            f"the gradebook cannot be written to {out}: {error.strerror}; every result is in the journal, and the same "
            "command writes it"
        ) from None
    return final


class Progress:
    """The gradebook while a run goes on: what is done, and the others as `pending`."""

    def __init__(self, out: Path, exercise: Exercise, rules: Final, blank: Sequence[Result]) -> None:
        """Prepare it for a class whose results are still `blank`; nothing is written."""
        self._out, self._exercise, self._rules = out, exercise, rules
        self._results = {each["student"]: each | {"outcome": PENDING} for each in blank}
        self._every, self._since = max(1, len(blank) // PARTS), 0

    def add(self, result: Result, *, anew: bool) -> None:
        """Take a result; write the gradebook now and then, if results are new. A full disk is told at the end."""
        self._results[result["student"]] = result
        self._since += anew and result["score"] is not None
        if self._since >= self._every:
            self._since = 0
            with contextlib.suppress(OSError):
                write_gradebook(self._out, as_csv(self._exercise, self._rules.results([*self._results.values()])))
