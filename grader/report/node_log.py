"""The log of the node, shortened to its beginning and end, as every report shows it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from gz_course.grader.printable import shown

if TYPE_CHECKING:
    from gz_course.grader.record.reading import Recording
    from gz_course.grader.report.report import Report

FIRST, LAST = 40, 80  # lines kept from the beginning and from the end


@dataclass(frozen=True)
class NodeLog:
    """Printable lines as (simulated time [s], level, text); `left_out` lines are missing between the two parts.

    `dropped` further lines of a very long log were not recorded. `who` names the writer in words.
    """

    first: tuple[tuple[float, str, str], ...]
    left_out: int
    last: tuple[tuple[float, str, str], ...]
    dropped: int = 0
    who: str = "your node"

    def as_text(self) -> str:
        """Return the lines as text, each with its time."""
        lines = [_told(line) for line in self.first]
        if self.left_out:
            lines.append(f"({self.left_out} lines are left out here)")
        lines += [_told(line) for line in self.last]
        if self.dropped:
            lines.append(f"({self.dropped} more lines are not recorded: the log is too long)")
        return "\n".join(lines)


def log_of(report: Report, first: int = FIRST, last: int = LAST) -> NodeLog:
    """Return the log of the trial a report shows. Raises UsageError if its recording is unreadable."""
    return node_log(report.shown_trial.content(), first, last)


def node_log(recording: Recording, first: int = FIRST, last: int = LAST) -> NodeLog:
    """Return the first and last lines that the node's process, or those of a launch file, printed and logged."""
    from gz_course.grader.record.reading import GIVEN_LOG

    log, facts = recording.node_log, recording.facts()
    every = [(line.time_ns / 1e9, line.level, shown(line.text).rstrip()) for line in recording.lines(log)]
    dropped = int(facts.get("lines_dropped") or 0)
    who = "your launch file's programs" if "launch" in facts else NodeLog.who
    if log == GIVEN_LOG:
        who = "the exercise's own node"
    if len(every) <= first + last:
        return NodeLog(tuple(every), 0, (), dropped, who)
    left_out = len(every) - first - last
    return NodeLog(tuple(every[:first]), left_out, tuple(every[-last:] if last else ()), dropped, who)


def _told(line: tuple[float, str, str]) -> str:
    time_s, _, text = line
    return f"{time_s:8.2f} s  {text}"
