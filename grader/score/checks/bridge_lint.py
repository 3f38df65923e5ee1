"""`bridge_lint`: is the student's bridge configuration free of errors and warnings?

kind = "bridge_lint"
carried = 6               # bridges that must have passed messages, so that an empty file earns nothing

Advice, such as a key that changes nothing, is told and costs no points.
"""

from __future__ import annotations

from pathlib import PurePath
from typing import Any

from gz_course.grader.exercise.toml_table import Table
from gz_course.grader.feedback.errors.launch_errors import bridge_meaning
from gz_course.grader.record.reading import Recording
from gz_course.grader.score.check import Finding, check_kind
from gz_course.grader.score.graphs import bridges


@check_kind("bridge_lint")
def bridge_lint(recording: Recording, parameters: Table) -> Finding:
    """Pass if lint found neither an error nor a warning; report the first error, else the first warning."""
    least = parameters.number("carried")
    found = recording.facts().get("lint", [])
    expected = "lint finds neither an error nor a warning"
    faults = [finding for finding in found if not finding.get("advice")]
    for finding in sorted(faults, key=lambda finding: (bool(finding["warning"]), "is missing" in finding["sentence"])):
        more = f" (and {len(faults) - 1} more)" if len(faults) > 1 else ""
        measured = f"{'warning' if finding['warning'] else 'error'} in {_told(finding)}{more}"
        return Finding(False, expected, measured, explanation=bridge_meaning(finding["sentence"]))
    carried = sum(bridge.to_ros + bridge.to_gz > 0 for bridge in bridges(recording))
    if carried < least:
        measured = f"only {carried} of your bridges carried a message, so there was little to check"
        return Finding(False, expected, measured, gated=True)
    advice = "".join(f"; advice, for no points: {_told(finding)}" for finding in found[:1])
    more = f" (and {len(found) - 1} more)" if len(found) > 1 else ""
    return Finding(True, expected, f"no error and no warning{advice}{more}" if found else "nothing found")


def _told(finding: dict[str, Any]) -> str:
    file, _, line = finding["place"].rpartition(":")
    return f"{PurePath(file).name}, line {line}: {finding['sentence']}"
