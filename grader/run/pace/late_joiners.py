"""How many kept messages DDS hands over to subscriptions of the submission that join late: they must be taken, too.

A transient-local publisher keeps its last messages for subscriptions that ask for them and are connected later. Both
sides report numbers (`agent/course_agent/history.py`); a pair counts once, when it is seen for the first time. The
bridge of the grader may have such publishers, too.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping

from gz_course.grader.run.processes.participant import Participant

GRADER = -1  # number of the grader among the processes


class LateJoiners:
    """`due` counts by topic the kept messages that subscriptions get, or have got."""

    def __init__(self) -> None:
        self.due: Counter[str] = Counter()
        self._asking: Counter[tuple[int, str]] = Counter()  # subscriptions of a process, by topic and type
        self._keeping: set[tuple[int, str]] = set()  # processes that were seen to have such a publisher

    def look(self, participants: Iterable[Participant], ours: Mapping[str, int] | None = None) -> None:
        """Count the pairs that are new; `ours` are the numbers that the grader keeps, by topic and type."""
        reports = [(each.number, each.progress) for each in participants if each.progress]
        keeping = [(number, key, kept) for number, report in reports for key, kept in report.kept.items()]
        keeping += [(GRADER, key, kept) for key, kept in (ours or {}).items()]
        asking = [(number, key, count) for number, report in reports for key, count in report.asked.items()]
        for publisher, key, kept in keeping:
            is_new = (publisher, key) not in self._keeping
            for subscriber, asked, count in asking:
                if asked == key:
                    new = count if is_new else max(0, count - self._asking[subscriber, key])
                    self.due[key.partition(" ")[0]] += kept * new
        self._keeping.update((number, key) for number, key, _ in keeping)
        for number, key, count in asking:
            self._asking[number, key] = count
