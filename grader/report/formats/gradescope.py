"""The report for Gradescope: `results.json`, one test for each check.

What hidden trials found is not told (`seen.py`), and each check has its visibility. All text is declared as plain
text, so that nothing a student wrote is taken for markup. `execution_time` is known only to the run and left out when a
recording is scored again.

Source: Gradescope, "Autograder Specifications", https://gradescope-autograders.readthedocs.io/en/latest/specs/
"""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

from gz_course.grader.exercise.leaderboard import HIGHEST, LOWEST
from gz_course.grader.exercise.visibility import AFTER, ALWAYS, NEVER
from gz_course.grader.printable import storable
from gz_course.grader.report.format import Format
from gz_course.grader.report.node_log import node_log
from gz_course.grader.report.report import OUTCOMES, Report, points
from gz_course.grader.report.seen import Seen, seen_of

if TYPE_CHECKING:
    from gz_course.grader.score.consequences import CheckResult

VISIBILITY = {ALWAYS: "visible", AFTER: "after_due_date", NEVER: "hidden"}  # what Gradescope calls them
OF_TRIALS = ("name", "seed", "score", "outcome", "truth_sha256")  # for the instructor
LINES = 20  # of the end of the node's log, shown below the verdict

TEXT = {"output_format": "text", "test_output_format": "text", "test_name_format": "text"}


def as_gradescope(report: Report) -> str:
    """Return the report as the text of a Gradescope `results.json`. Raises UsageError if a recording is unreadable."""
    return json.dumps(storable(as_dict(report)), indent=2, allow_nan=False) + "\n"


def as_dict(report: Report) -> dict[str, Any]:
    data = report.as_dict()
    told = seen_of(report)
    results: dict[str, Any] = {
        "score": data["score"],
        "output": _output(report, told),
        **TEXT,
        "visibility": "visible",
        "stdout_visibility": "hidden",  # it repeats the report
        "tests": [_test(number, check, report, told) for number, check in enumerate(report.score.checks, start=1)],
        "extra_data": {key: data[key] for key in ("exercise", "outcome", "truth_sha256", "versions")}
        | {"trials": [{key: trial[key] for key in OF_TRIALS} for trial in data["trials"]]},
    }
    if report.leaderboard:
        order = {LOWEST: "asc", HIGHEST: "desc"}
        results["leaderboard"] = [
            {"name": each.name, "value": each.value, "order": order[each.best]} for each in report.leaderboard
        ]
    if report.host is not None:
        results["execution_time"] = data["wall_seconds"]
        results["extra_data"] |= {key: data[key] for key in ("sandbox", "pace")}
    return results


def _test(number: int, check: CheckResult, report: Report, told: Seen) -> dict[str, Any]:
    return {
        "number": str(number),
        "name": check.spec.title,
        "score": check.points,
        "max_score": check.spec.points,
        "status": "passed" if check.finding.passed else "failed",
        "output": "\n".join(f"{name}: {value}" for name, value in told.lines(report, check)),
        "visibility": VISIBILITY[check.spec.visibility],
        "extra_data": {"id": check.spec.id},
    }


def _output(report: Report, told: Seen) -> str:
    """Return the diagnosis and, unless all is well, the end of the node's log in a trial that is shown."""
    verdict = f"{points(report.score.points)} of {points(report.max_score)} points. "
    outcome = OUTCOMES.get(report.score.outcome, report.score.outcome)
    lines = [told.diagnosis, verdict + outcome, *filter(None, [told.summary]), *report.notes]
    if not report.full_marks and (trial := told.trial(report)) is not None:
        said = node_log(trial.content(), 0, LINES)
        lines += ["", f"What {said.who} said last:", said.as_text() or "nothing"]
    return "\n".join(line for n, line in enumerate(lines) if line or n)


FORMAT = Format(
    as_text=as_gradescope,
    file="results.json",
    help="Write the report as Gradescope's results.json.",
    class_help="Also write each results.json.",
)
