"""Services of the submission that the grader calls while it runs, as `ros2 service call` does.

An answer is a claim of the submission. The recording has whether one came, `calls/SERVICE/answered`, and its fields.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from gz_course.grader.errors import ManifestError
from gz_course.grader.exercise.trial import Entry, ScriptedCall
from gz_course.grader.printable import shown
from gz_course.grader.record.recorder import Recorder
from gz_course.grader.run.grader_endpoints import GraderEndpoints
from gz_course.grader.run.pace.real_time import RealTime
from gz_course.sim.ros.ros2.errors import CommandError
from gz_course.sim.ros.ros2.interface import service_class
from gz_course.sim.ros.rosidl_runtime_py.set_message import set_message_fields
from gz_course.sim.show.rviz2.drawing.fields import fields

LONGEST = 2_000  # characters kept of a text


class CallScript:
    """The clients for the services that a script names, and what became of each call (`facts`)."""

    def __init__(self, ros: GraderEndpoints, pace: RealTime, script: Iterable[Entry]) -> None:
        """Make the clients. Raises ManifestError if a type or a request does not fit."""
        calls = {each.service: each for each in script if isinstance(each, ScriptedCall)}
        self._clients = {name: ros.client(_class(each), name) for name, each in calls.items()}
        self._pace = pace
        self.facts: list[dict[str, Any]] = []

    def call(self, wanted: ScriptedCall, recorder: Recorder) -> None:
        """Call a service; record whether it answered, and the answer."""
        answer = self._pace.ask(self._clients[wanted.service], request_of(wanted))
        answered = answer is not None
        self.facts.append({"at": wanted.at, "service": wanted.service, "type": wanted.type, "answered": answered})
        base = f"calls/{wanted.service.strip('/')}"
        recorder.scalar(f"{base}/answered", float(answered))
        for entity, value in fields(answer, base) if answered else ():
            if isinstance(value, bool | int | float):
                recorder.scalar(entity, float(value))
            elif isinstance(value, str):
                recorder.text(entity, shown(value, LONGEST))
        said = "answered" if answered else "no answer"
        recorder.text(
            "log/grader", f"ros2 service call {wanted.service} {wanted.type}: {said}", "INFO" if answered else "WARN"
        )


def request_of(wanted: ScriptedCall) -> Any:
    """Return the request of a call. Raises ManifestError if it does not fit the type of the service."""
    request = _class(wanted).Request()
    try:
        set_message_fields(request, wanted.request)
    except (AttributeError, TypeError, ValueError, AssertionError) as error:
        raise ManifestError(f"the request of the call of {wanted.service} at {wanted.at:g} s: {error}") from None
    return request


def _class(wanted: ScriptedCall) -> Any:
    try:
        return service_class(wanted.type)
    except CommandError as error:
        raise ManifestError(f"the call of {wanted.service} at {wanted.at:g} s: {error}") from None
