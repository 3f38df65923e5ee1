"""ROS parameters that the grader sets while a submission runs, as `ros2 param set` does.

A request goes to the service `NODE/set_parameters` that every node offers. Its outcome is a fact of the recording, for
feedback only: what a parameter does is seen in the simulator's truth.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from rcl_interfaces.msg import SetParametersResult
from rcl_interfaces.srv import SetParameters
from rclpy.parameter import Parameter

from gz_course.grader.exercise.trial import Entry, ScriptedParameter
from gz_course.grader.printable import shown
from gz_course.grader.record.recorder import Recorder
from gz_course.grader.run.grader_endpoints import GraderEndpoints
from gz_course.grader.run.pace.real_time import RealTime


class ParameterScript:
    """The clients for the nodes that a script names, and what became of each request (`facts`)."""

    def __init__(self, ros: GraderEndpoints, pace: RealTime, script: Iterable[Entry]) -> None:
        nodes = sorted({each.node for each in script if isinstance(each, ScriptedParameter)})
        self._clients = {node: ros.client(SetParameters, f"{node}/set_parameters") for node in nodes}
        self._pace = pace
        self.facts: list[dict[str, Any]] = []

    def set(self, wanted: ScriptedParameter, recorder: Recorder) -> None:
        """Set a parameter and record the value and the outcome: `set`, `refused` or `no answer`."""
        request = SetParameters.Request(parameters=[Parameter(wanted.name, value=wanted.value).to_parameter_msg()])
        response = self._pace.ask(self._clients[wanted.node], request)
        results = response.results if response is not None else []
        result = results[0] if results else SetParametersResult(successful=False)
        outcome = "set" if result.successful else "no answer" if response is None else "refused"
        reason = shown(result.reason)
        self.facts.append(
            {
                "at": wanted.at,
                "node": wanted.node,
                "name": wanted.name,
                "value": wanted.value,
                "outcome": outcome,
                "reason": reason,
            }
        )
        record_parameter(recorder, wanted.name, wanted.value)
        said = f"ros2 param set {wanted.node} {wanted.name} {wanted.value}: {outcome}"
        level = "INFO" if result.successful else "WARN"
        recorder.text("log/grader", f"{said}: {reason}" if reason else said, level)


def record_parameter(recorder: Recorder, name: str, value: Any) -> None:
    """Record a parameter that is a number as a signal."""
    if isinstance(value, int | float) and not isinstance(value, bool):
        recorder.name(f"parameters/{name}", f"parameter {name}")
        recorder.scalar(f"parameters/{name}", float(value))
