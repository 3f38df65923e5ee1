"""`launched_end`: do all processes end when the launch is interrupted with Ctrl-C?

kind = "launched_end"
"""

from __future__ import annotations

from gz_course.grader.exercise.toml_table import Table
from gz_course.grader.record.reading import Recording
from gz_course.grader.score.check import Finding, check_kind
from gz_course.grader.score.launched import by_python, launch_facts


@check_kind("launched_end")
def launched_end(recording: Recording, parameters: Table) -> Finding:
    """Pass if the launch ends by itself with exit code 0, without a SIGKILL, and leaves no process behind."""
    expected = "after Ctrl-C everything ends by itself"
    facts = launch_facts(recording)
    if not facts.get("running"):
        return Finding(False, expected, "the launch had ended before it was interrupted")
    if facts["left"]:
        why = next(filter(None, (by_python(recording, each) for each in facts["left"])), "")
        return Finding(
            False, expected, f"the launch ended, but this ran on: {', '.join(facts['left'])}", explanation=why
        )
    if not facts["ended_itself"]:
        return Finding(False, expected, "the launch did not end")
    if facts["escalated"]:
        return Finding(False, expected, f"{', '.join(facts['escalated'])} did not listen to Ctrl-C for 5 s")
    if facts["exit_code"]:
        return Finding(False, expected, f"the launch ended with exit code {facts['exit_code']}")
    return Finding(True, expected, "so it did")
