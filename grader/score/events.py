"""Events: the first moment at which a condition holds. Checks of order, and checks from an event on, use them.

An author writes one of these tables (`name` describes it in the report; `after` [s] ignores what came before):

    { signal = "truth/robot/x", low = 1.0, name = "the robot passes the gate" }     # in the band, both bounds included
    { topic = "cmd_vel" }                                                           # a message arrives
    { topic = "state", says = "^done" }                                             # its text matches a pattern
    { log = "arrived" }                                                             # a line of the node's log matches
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from gz_course.grader.exercise.toml_table import Table
from gz_course.grader.record.reading import Recording
from gz_course.grader.score.steps import Condition

# The prefix that the sandbox's console format puts before a logger's message; a printed line lacks it.
LOGGED = re.compile(r"^\[[A-Z]+\] \[([^\]]*)\]: ")


@dataclass(frozen=True)
class Event:
    """One of a `condition`, a message on `topic` (whose text in `field` matches `pattern`), or a log line."""

    name: str
    condition: Condition | None = None
    topic: str = ""
    field: str = "data"
    pattern: re.Pattern[str] | None = None
    after: float = 0.0

    @staticmethod
    def read(table: Table) -> Event:
        """Read the table of an event. Raises ManifestError if it is none of the four, or two at once."""
        after = table.number("after", 0.0)
        given = [key for key in ("signal", "topic", "log") if table.has(key)]
        if len(given) != 1:
            table.refuse(given[0] if given else "signal", "the only one of the keys signal, topic and log")
        if given == ["signal"]:
            condition = Condition.read(table)
            return Event(str(condition) if not table.has("name") else condition.name, condition, after=after)
        if given == ["log"]:
            pattern = table.regex("log")
            event = Event(table.text("name", f"{pattern.pattern!r} in the node's log"), pattern=pattern, after=after)
        else:
            topic = table.text("topic").strip("/")
            says = table.regex("says") if table.has("says") else None
            default = f"a message on /{topic}" + (f" saying {says.pattern!r}" if says else "")
            event = Event(table.text("name", default), None, topic, table.text("field", "data"), says, after)
        table.end()
        return event

    def moments(self, recording: Recording) -> Iterator[float]:
        """Yield every simulated time [s] at which the event happens, in order."""
        for moment in self._all(recording):
            if moment >= self.after:
                yield moment

    def first(self, recording: Recording, since: float = 0.0) -> float | None:
        """Return the first such time at or after `since` [s], or None."""
        return next((moment for moment in self.moments(recording) if moment >= since), None)

    def _all(self, recording: Recording) -> list[float]:
        if self.condition is not None:
            signal = recording.signal(self.condition.signal)
            held = (signal.values >= self.condition.low) & (signal.values <= self.condition.high)
            return [float(time) for time in signal.times[held] / 1e9]
        if self.pattern is None:
            return [float(time) for time in recording.signal(f"topics/{self.topic}/count").times / 1e9]
        if not self.topic:
            return [at for at, text, _ in log_lines(recording) if self.pattern.search(text)]
        return [at for at, text in texts(recording, self.topic, self.field) if text and self.pattern.search(text)]


def log_lines(recording: Recording) -> Iterator[tuple[float, str, bool]]:
    """Yield (time [s], text, whether it was logged) of every line the node wrote.

    A line was logged if it looks so and its message came on /rosout: the fact `not_logged` numbers those without one.
    """
    forged = set(recording.facts().get("not_logged", []))
    for number, line in enumerate(recording.lines(recording.node_log)):
        text, logged = LOGGED.subn("", line.text)
        yield line.time_ns / 1e9, text, bool(logged) and number not in forged


def not_logged(recording: Recording, pattern: re.Pattern[str]) -> str:
    """Return how many lines match that were not logged, why, and what to do; empty if there are none."""
    facts = recording.facts()
    lines = [line.text for line in recording.lines(recording.node_log)]
    logged = [each for _, _, each in log_lines(recording)]
    found = [
        line for line, each in zip(lines, logged, strict=True) if not each and pattern.search(LOGGED.sub("", line))
    ]
    if not found:
        return ""
    silent = {name.strip("/").replace("/", "."): name for name in facts.get("rosout_off", [])}
    names = {match.group(1) for line in found if (match := LOGGED.match(line))}
    if off := sorted(names & silent.keys()):
        return (
            f"{len(found)} such lines came to the console only: the node {silent[off[0]]} has its log to /rosout "
            "switched off, so nobody else hears it: leave out enable_rosout=False and --disable-rosout-logs"
        )
    return f"{len(found)} such lines were printed, not logged: use the node's logger, self.get_logger().info(...)"


def texts(recording: Recording, topic: str, field: str) -> Iterator[tuple[float, str | None]]:
    """Yield (time [s], value of the text field) of every message on a topic; a text is recorded when it changes."""
    lines = recording.lines(f"topics/{topic}/{field}")
    starts = [line.time_ns for line in lines]
    for time in recording.signal(f"topics/{topic}/count").times:
        index = int(np.searchsorted(starts, time, side="right")) - 1
        yield float(time / 1e9), lines[index].text if index >= 0 else None
