"""The robots that were asked for, those that are there, and the names of the topics of each."""

from __future__ import annotations

from gz_course.grader.record.reading import Recording
from gz_course.grader.score.launched import argument

DRIVES, HEARS = "cmd_vel", "odom"


def asked_for(recording: Recording) -> tuple[list[str], str]:
    count, called = argument(recording, "robots", "2")
    return [f"robot{number}" for number in range(1, int(count) + 1)], called


def robots_there(recording: Recording) -> list[str]:
    return sorted({name.split("/")[1] for name in recording.signals() if name.startswith("truth/")})
