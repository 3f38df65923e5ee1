"""Why a service that the grader called during a run gave no answer."""

from __future__ import annotations

from typing import Any

from gz_course.grader.printable import shown
from gz_course.grader.record.reading import Recording


def service_without_answer(recording: Recording, facts: dict[str, Any]) -> str:
    """Name the first call without an answer, with the command that shows the same in a terminal."""
    for each in facts.get("services_called", []):
        if each["answered"]:
            continue
        command = f"`ros2 service call {each['service']} {each['type']}` at {each['at']:g} s"
        if answers := [slip for slip in facts.get("slips", []) if "answers a service" in slip["said"]]:
            said = f"had no answer: line {answers[0]['line']}: {answers[0]['said']}"
        else:
            said = (
                f"had no answer: a node offers it with self.create_service(TYPE, {each['service']!r}, self.CALLBACK), "
                "and answers only while it spins"
            )
        return shown(f"{command} {said}.", 500)
    return ""
