"""The run of a student's node beside the exercise's own."""

from __future__ import annotations

from typing import Any

from gz_course.grader.record.reading import PRINTED, REPORTS
from gz_course.grader.run.pace.lockstep import LockStep
from gz_course.grader.run.pace.real_time import RealTime
from gz_course.grader.run.run_loop import RunLoop

START_UP = 10.0  # [s] more than a single node gets


class PackageRunLoop(RunLoop):
    """A run in which the exercise's own node, in a sandbox of its own, asks the student's and reports what it got."""

    def _paced(self, pace: str) -> RealTime:
        if pace == "lockstep":
            return LockStep(self._processes, self._ros, holding=True)
        return super()._paced(pace)

    @property
    def _time_limit(self) -> float:
        """More than for one node: two come up."""
        return super()._time_limit + START_UP

    def _collect(self) -> None:
        super()._collect()
        beside = self._processes.beside
        if beside is None:
            return
        for entity, texts in ((REPORTS, beside.reports), (PRINTED, beside.lines)):
            for text in texts:
                self._recorder.text(entity, text)
            texts.clear()

    def _last_look(self) -> dict[str, Any]:
        """Return how the exercise's own node has ended, if it has."""
        beside = self._processes.beside
        code = beside.exit_code if beside is not None else None
        return {} if code is None else {"exercise_node_ended": code}
