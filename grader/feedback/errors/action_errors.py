"""Errors in the callback that executes a goal: rclpy catches them, logs them, and aborts the goal.

Source: `ActionServer._execute_goal` of rclpy 7.1, which logs `Error raised in execute callback: ...` and then prints
the traceback.
"""

from __future__ import annotations

from typing import Any

from gz_course.grader.feedback.recorded.places import suspect
from gz_course.grader.feedback.rules import guarded
from gz_course.grader.printable import shown
from gz_course.grader.record.reading import Recording
from gz_course.grader.score.crash import read_crash

NOT_ASKED_FOR = "from state EXECUTING with event CANCELED"
RAISED = "Error raised in execute callback: "


@guarded("")
def execute_raised(recording: Recording, facts: dict[str, Any]) -> str:
    """Name the first error that execute raised, with file and line; empty if it raised none."""
    lines = recording.lines("log/student")
    number = next((i for i, line in enumerate(lines) if RAISED in line.text), None)
    if number is None:
        return ""
    at, texts = lines[number].time_ns / 1e9, [line.text for line in lines[number + 1 :]]
    begin = next((i for i, text in enumerate(texts) if text.startswith("Traceback")), None)
    if begin is None:
        return ""
    after = (i for i, text in enumerate(texts) if i > begin and not text.startswith(" "))
    crash = read_crash(texts[: next(after, begin) + 1], str(recording.properties("run").get("submission")))
    if crash is None:
        return ""
    where, error, said = f" ({crash.place})" if crash.place else "", crash.error, crash.meaning
    if error == "TypeError" and any("publish_feedback" in text for text in texts):
        said = "publish_feedback() takes the feedback of the action, such as Patrol.Feedback(...), and nothing else"
    if NOT_ASKED_FOR in error and (kept := suspect(recording, "anew")):
        said = kept
    advice = f" What that means: {said}." if said else ""
    return shown(
        f"Your execute callback raised {error} at {at:.2f} s of simulated time{where}; rclpy then ends "
        f"the goal as ABORTED.{advice}",
        600,
    )
