"""The run of an exercise's own node: its log is recorded apart from the student's, and both graphs at the end."""

from __future__ import annotations

from typing import Any

from gz_course.grader.errors import ManifestError
from gz_course.grader.kinds.given_node import node_file
from gz_course.grader.record.reading import GIVEN_LOG
from gz_course.grader.record.recorder import Recorder
from gz_course.grader.run.graph_snapshot import both_graphs
from gz_course.grader.run.processes.progress import Endpoint
from gz_course.grader.run.run_loop import RunLoop


class ExerciseNodeRunLoop(RunLoop):
    """A run whose submission, a bridge's file or a table of topics, is judged by both graphs."""

    log = GIVEN_LOG
    watches = False

    def run(self, recorder: Recorder) -> dict[str, Any]:
        """Run the exercise's own node. Raises ManifestError if it ended or never spun."""
        facts = super().run(recorder)
        if facts["exit_at"] is not None or not facts["ready"]:
            how = "did not start to spin" if facts["exit_at"] is None else f"ended (exit code {facts['exit_code']})"
            raise ManifestError(f"{node_file(self._exercise)}: the exercise's own node {how}; nothing is graded")
        return facts

    def _last_look(self) -> dict[str, Any]:
        return both_graphs(self._gz_nodes[1], self._ros, self._processes.clock)

    def _is_reserved(self, endpoint: Endpoint) -> bool:
        return False
