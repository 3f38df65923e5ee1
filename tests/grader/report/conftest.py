"""Reports with recordings made by hand."""

import pytest

from gz_course.grader.report.report import HostFacts, Report, TrialReport
from gz_course.tests.grader.report.handmade import DURATION, result, score_of, write_run


@pytest.fixture
def make_report(tmp_path):
    """Make a report with a recording for each of its trials: `make_report(score, ...)`."""

    def make(
        score=None, *, trials=("public",), scores=None, lines=(), facts=None, world=True, seconds=DURATION, **more
    ):
        score = score or score_of(result("good", True), result("bad", False), diagnosis="The bad one: was 0.5.")
        parts = []
        for number, name in enumerate(trials):
            path = tmp_path / f"{name}.rrd"
            write_run(path, lines=lines, facts=facts, world=world, seconds=seconds)
            one = scores[number] if scores else score
            parts.append(TrialReport(name, 3 + number, one, path, one.truth_sha256))
        given = {
            "exercise": "03_teleop", "title": "Drive", "submission": "/home/me/node.py",
            "recording": parts[0].recording,
            "score": score, "max_score": 100, "sim_seconds": seconds, "seed": 3, "versions": {"mujoco": "4.0.0"},
            "host": HostFacts("D", "lockstep", 0.5, 2.0), "trials": tuple(parts),
        }  # fmt: skip
        return Report(**(given | more))

    return make


@pytest.fixture
def not_run(make_report):
    """The report on a file with a syntax error."""
    nothing = {"measured": "nothing was run", "at_s": None, "bands": ()}
    score = score_of(
        result("good", False, **nothing),
        result("bad", False, **nothing),
        outcome="student_error",
        diagnosis="node.py, line 3: SyntaxError: expected ':'",
    )
    return make_report(score, world=False, seconds=0.0, facts={"fault": "node.py, line 3: SyntaxError"})
