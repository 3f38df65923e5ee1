"""A report after a search: what a trial has shown is said first, before what the text of the file alone suggests."""

from __future__ import annotations

from dataclasses import replace

from gz_course.grader.explain.explanation import Explanation
from gz_course.grader.explain.order import named_lines
from gz_course.grader.report.report import Report


def with_trial(report: Report, explanation: Explanation) -> Report:
    """Return the report with what the search found.

    A change that helps comes first. What the report said before follows, unless it names lines and a change at none of
    them earns full marks: then the trial has decided against it. A search without a find adds what was tried.
    """
    found, said = explanation.found, report.score.feedback
    if found is None or not found.before.failed:
        return report
    first, *more = explanation.sentences
    if not found.changes:
        details = " ".join([report.score.details, first, *more]).strip()
        return replace(report, tried=True, score=replace(report.score, details=details))
    named = named_lines(report.score.diagnosis, explanation.files)
    placed = {each for change in found.changes for each in change.lines}
    agrees = not (named and found.full_marks) or bool(named & (placed | {("", line) for _, line in placed}))
    details = " ".join([*more, *([said] if agrees else [])])
    return replace(report, tried=True, score=replace(report.score, diagnosis=first, details=details))
