"""The report on a submission that could not be read: as JSON and as a page, so that every student has one."""

from __future__ import annotations

import json
from collections.abc import Sequence
from typing import Any

from markupsafe import escape

from gz_course.grader.exercise import Exercise
from gz_course.grader.report.format import formats
from gz_course.grader.report.report import OUTCOMES
from gz_course.grader.whole_class.grading import REPORT

PAGE = """<!doctype html>
<html lang="en">
<head><meta charset="utf-8"><title>{title}</title>
<style>body {{ font: 1rem/1.5 sans-serif; max-width: 50rem; margin: 2rem auto; padding: 0 1rem; }}</style></head>
<body>
<h1>{title}</h1>
<p>{submission}</p>
<p>0 of {most:g} points</p>
<p class="note" id="by-hand" hidden></p>
<p>{outcome}</p>
<p><strong>{told}</strong></p>
</body>
</html>
"""


def unread_files(exercise: Exercise, result: dict[str, Any], reports: Sequence[str]) -> dict[str, bytes]:
    """Return the files of a student whose submission could not be read: the JSON report, and the page if asked for."""
    report = {
        "exercise": exercise.name,
        "submission": result["submission"],
        "score": 0,
        "max_score": exercise.max_score,
        "outcome": result["outcome"],
        "diagnosis": result["diagnosis"],
        "checks": [],
        "trials": [],
    }
    files = {REPORT: (json.dumps(report, indent=2) + "\n").encode()}
    if "html" in reports:
        page = PAGE.format(
            title=escape(f"{exercise.name}: {exercise.title}"),
            submission=escape(result["submission"]),
            most=exercise.max_score,
            outcome=escape(OUTCOMES.get(result["outcome"], result["outcome"])),
            told=escape(result["diagnosis"]),
        )
        files[formats()["html"].file] = page.encode(errors="replace")
    return files
