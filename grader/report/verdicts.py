"""The verdicts in the recording: the states of each check, the bands, the result."""

from __future__ import annotations

from typing import Any

import numpy as np
import rerun as rr

from gz_course.grader.record.recorder import Recorder
from gz_course.grader.score.score import Score

COLORS = np.array([[110, 110, 110, 255], [40, 160, 70, 255], [200, 50, 50, 255]], dtype=np.uint8)
TAIL = 0.5  # [s] recorded beyond the end, so that a verdict given at the end is visible


def write_verdicts(recorder: Recorder, score: Score, max_score: float, end_s: float) -> None:
    """Log every check as a state that changes at the moment of its verdict, its bands, and the result as properties."""
    failures = []
    for check in score.checks:
        entity = f"/checks/{check.spec.id}"
        at = check.finding.at_s if check.finding.at_s is not None else end_s
        times, states = [round(at * 1e9)], ["pass" if check.finding.passed else "fail"]
        if times[0] > 0:
            times, states = [0, *times], ["wait", *states]
        times, states = [*times, round((end_s + TAIL) * 1e9)], [*states, states[-1]]
        recorder.static(entity, _states(check.spec.title))
        recorder.states(entity, times, states)
        for number, band in enumerate(check.finding.bands):
            span = [round(band.start * 1e9), round(band.end * 1e9)]
            for side, value in (("low", band.low), ("high", band.high)):
                if np.isfinite(value):
                    recorder.constant(f"{entity}/{number}/{band.signal}/{side}", span, value)
        recorder.set_time(round(at * 1e9))
        verdict = "passed" if check.finding.passed else "failed"
        recorder.text(
            "/log/verdicts",
            f"{check.spec.title}: {verdict}; {check.finding.measured}",
            "INFO" if check.finding.passed else "ERROR",
        )
        if not check.finding.passed:
            failures.append(at)
    recorder.tell_story(failures)
    recorder.properties(
        "result",
        score=float(score.points),
        max_score=float(max_score),
        outcome=score.outcome,
        diagnosis=score.diagnosis,
        truth_sha256=score.truth_sha256,
    )


def _states(title: str) -> Any:
    """Return how the states of a check are shown: the lane of a check is named by its id, so the title is in them."""
    labels = [f"{state}: {title}" for state in ("not decided", "passed", "failed")]
    return rr.StateConfiguration(values=["wait", "pass", "fail"], labels=labels, colors=COLORS)
