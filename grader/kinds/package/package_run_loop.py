"""The run of a student's node beside the exercise's own, both in one sandbox."""

from __future__ import annotations

from typing import Any

from gz_course.grader.run.grader_endpoints import message_class
from gz_course.grader.run.pace.lockstep import LockStep
from gz_course.grader.run.pace.real_time import RealTime
from gz_course.grader.run.run_loop import RunLoop

START_UP = 10.0  # [s] more than a single node gets


class PackageRunLoop(RunLoop):
    """A run in which the exercise's own node asks the student's, and publishes on `observe` what it got."""

    def __init__(self, *given: Any, **options: Any) -> None:
        super().__init__(*given, **options)
        for topic, kind in self._exercise.observe.items():
            self._ros.discovery.watch(topic, message_class(kind))

    def _paced(self, pace: str) -> RealTime:
        if pace == "lockstep":
            return LockStep(self._processes, self._ros, holding=True)
        return super()._paced(pace)

    @property
    def _time_limit(self) -> float:
        """More than for one node: two come up."""
        return super()._time_limit + START_UP

    def _last_look(self) -> dict[str, Any]:
        """Return the topics of the exercise's node on which others have published, too."""
        counted = self._ros.discovery.publishers_counted
        return {"forged": sorted(topic for topic in self._exercise.observe if counted(topic) > 1)}
