"""The report for PrairieLearn's external grader: `results.json`, one test for each check, and a picture of the run.

PrairieLearn's score is a part of full marks, from 0 to 1. A submission that could not even start is not gradable there:
it costs no attempt. Neither does a fault of the machine. What hidden trials found is not told (`seen.py`).

Source: PrairieLearn, "External Grading", https://docs.prairielearn.com/externalGrading/ ("Grading results")
"""

from __future__ import annotations

import base64
import json
from typing import TYPE_CHECKING, Any

from gz_course.grader.exercise.visibility import ALWAYS
from gz_course.grader.printable import storable
from gz_course.grader.report.format import Format
from gz_course.grader.report.node_log import node_log
from gz_course.grader.report.report import OUTCOMES, Report, TrialReport, points
from gz_course.grader.report.seen import Seen, seen_of

if TYPE_CHECKING:
    from gz_course.grader.score.consequences import CheckResult

LARGEST = 1_000_000  # [bytes] of results.json that PrairieLearn takes
LINES = 20  # of the end of the node's log
WIDTH = 640  # [pixels] of the picture
STYLE = (
    ".floor { fill: #eceff3; } .body { stroke: #1b1f24; stroke-width: .7; } .start { fill: none; stroke: #c25e00; } "
    ".path { fill: none; stroke: #c25e00; stroke-width: 2.2; } .heading, .ruler { fill: none; stroke: #1b1f24; } "
    ".scan { fill: none; stroke: #b3128f; stroke-width: 3; stroke-linecap: round; } text { font: 12px sans-serif; }"
)


def as_prairielearn(report: Report) -> str:
    """Return the report as the text of PrairieLearn's results.json. Raises UsageError if a recording is unreadable."""
    data = as_dict(report)
    text = _text(data)
    if len(text.encode()) > LARGEST:
        text = _text(data | {"images": []})
    return text


def as_dict(report: Report) -> dict[str, Any]:
    started = bool(report.sim_seconds) or report.score.outcome not in ("student_error", "infra")
    verdict = f"{points(report.score.points)} of {points(report.max_score)} points. {OUTCOMES[report.score.outcome]}"
    told = seen_of(report)
    trial = told.trial(report)
    said = node_log(trial.content(), 0, LINES) if trial is not None and not report.full_marks else None
    data = report.as_dict()
    results: dict[str, Any] = {
        "gradable": started,
        "score": min(1.0, max(0.0, report.score.points / report.max_score)),
        "message": " ".join(line for line in (told.diagnosis, verdict, told.summary, *report.notes) if line),
        "output": "" if said is None else f"What {said.who} said last:\n{said.as_text() or 'nothing'}",
        "tests": [_test(check, report, told) for check in report.score.checks if check.spec.visibility == ALWAYS],
        "images": _images(report, trial) if report.sim_seconds and trial is not None else [],
        "extra": {key: data[key] for key in ("exercise", "outcome", "truth_sha256")},
    }
    if not started:
        results["format_errors"] = [report.score.feedback or OUTCOMES[report.score.outcome]]
    return results


def _test(check: CheckResult, report: Report, seen: Seen) -> dict[str, Any]:
    told = dict(seen.lines(report, check))
    return {
        "name": check.spec.title,
        "description": told.get("expected", ""),
        "points": check.points,
        "max_points": check.spec.points,
        "message": told.get("hint", ""),
        "output": "\n".join(f"{name}: {value}" for name, value in told.items() if name not in ("expected", "hint")),
    }


def _images(report: Report, trial: TrialReport) -> list[dict[str, str]]:
    """Return the world from above with the whole path, if there is a world."""
    from gz_course.grader.report.html.from_above import Map

    recording = trial.content()
    drawn = Map(recording, str(recording.properties("run").get("robot", "robot")))
    if not drawn:
        return []
    end = float(recording.facts().get("sim_seconds") or 0.0)
    head, _, rest = str(drawn.draw(end, WIDTH, drawn.told(), whole_path=True)).partition(">")
    head = head.replace("<svg ", f'<svg xmlns="http://www.w3.org/2000/svg" width="{WIDTH}" ', 1)
    svg = f"{head}><style>{STYLE}</style>{rest}"
    label = "The run from above" if len(report.trials) == 1 else f"The run from above (trial {trial.name})"
    return [{"label": label, "url": f"data:image/svg+xml;base64,{base64.b64encode(svg.encode()).decode()}"}]


def _text(data: dict[str, Any]) -> str:
    return json.dumps(storable(data), indent=2, allow_nan=False) + "\n"


FORMAT = Format(
    as_text=as_prairielearn,
    file="prairielearn.json",
    help="Write the report as PrairieLearn's results.json.",
    class_help="Also write each report as PrairieLearn's results.json.",
)
