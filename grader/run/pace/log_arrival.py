"""Arrival of log messages: simulated time waits for them as for other messages, but a lost one disturbs nothing else.

`real_time.py` and `lockstep.py` ask whether all that the processes have logged has arrived on /rosout.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from gz_course.grader.run.agent.course_agent.rosout_counter import ROSOUT
from gz_course.grader.run.fair_clock import Patience
from gz_course.grader.run.processes.submission_processes import SubmissionProcesses

if TYPE_CHECKING:
    from gz_course.grader.run.grader_endpoints import GraderEndpoints

PATIENCE = 2.0  # [s] without a log message after which those that are missing count as lost
GIVING_UP = 3  # losses after which log messages are not waited for any more


class LogArrival:
    """Compares what the processes say that they logged with what has come."""

    def __init__(self, processes: SubmissionProcesses, ros: GraderEndpoints) -> None:
        self._processes = processes
        self._ros = ros
        self._lost = self._done = 0
        self._losses = 0
        self._short = (0, 0)  # logged and arrived, when something was missing last
        self._patience = Patience(processes.clock, PATIENCE)

    def complete(self) -> bool:
        """Return whether everything has arrived, or will never; then confirm it to those that wait for that."""
        logged = sum(each.logged for each in self._processes.participants)
        if logged > self._done and self._losses < GIVING_UP and not self._arrived(logged):
            return False
        self._done = logged
        for each in self._processes.participants:
            if each.waits_for_log and not each.gone:
                each.confirm_log()
        return True

    def _arrived(self, logged: int) -> bool:
        """Take what has come; return whether nothing is missing, or what is missing has to count as lost."""
        self._ros.take_logs()
        arrived = self._ros.received[ROSOUT]
        if arrived + self._lost >= logged:
            return True
        if (logged, arrived) != self._short:
            self._short, self._patience = (logged, arrived), Patience(self._processes.clock, PATIENCE)
        if not self._patience.over():
            return False
        self._lost, self._losses = logged - arrived, self._losses + 1
        return True
