"""What the watchdog beside a grading looks at: processor time, memory and progress; a busy machine changes none.

Wall time has a limit, too (`limits.py`), which only a machine reaches that is far too busy.

`supervision.py` runs a grading in a child process and asks `Look.at` every now and then whether to end it. The child
tells how far it has come (`Heartbeat` there); everything else is read from /proc, from outside.

Source: proc_pid_stat(5).
"""

from __future__ import annotations

import contextlib
import os
import time
from pathlib import Path

from gz_course.grader.run.fair_clock import FairClock
from gz_course.grader.run.limits import wall_limit
from gz_course.grader.run.sandbox.resource_monitor import descendants

MOST_MEMORY = 2 << 30  # [bytes] in use by the grader's process
# Processor time of the grader's process [s], and more for each simulated second: ten times what honest runs take, and
# where it simulates a world that was handed in.
OWN_CPU_SECONDS, OWN_CPU_FACTOR = 15.0, 3.0
CPU_SECONDS, CPU_FACTOR = 25.0, 8.0
BOX_CPU_SECONDS, BOX_CPU_FACTOR = 45.0, 15.0  # the same for all processes of a submission together
STILL_CPU_SECONDS = 45.0  # processor time of both together [s] while simulated time stands still
LONGEST_WAIT = 60.0  # [s] in which nobody computes and simulated time stands still
MACHINE = "infra"  # outcome of what the machine had no time for
_TICKS = os.sysconf("SC_CLK_TCK")


class Look:
    """What the watchdog sees of a child: `at` returns outcome and sentence when something is too much.

    `apart` are processes below this one that are none of its business; a job simulates `duration` [s].
    """

    def __init__(self, pid: int, apart: set[int], duration: float) -> None:
        self._pid, self._apart, self._duration = pid, frozenset(apart), duration
        self._clock = FairClock(lambda: [pid, *descendants(pid, self._apart)])
        self._place = (-1, -1)  # job, simulated time [ns]
        self._own = self._box = 0.0  # processor time [s] when the job began
        self._still = 0.0  # that of both when simulated time last went on
        self._idle = 0.0  # by the clock, then
        self._began = time.monotonic()

    def at(self, job: int, sim_time_ns: int, handed_in: bool) -> tuple[str, str] | None:
        """Look once. `handed_in`: the child simulates a world that was handed in."""
        own = cpu_seconds(self._pid)
        box = sum(cpu_seconds(each, with_ended=True) for each in descendants(self._pid, self._apart))
        idle = self._clock.idle()
        if job != self._place[0]:
            self._own, self._box, self._began = own, box, time.monotonic()
        if (job, sim_time_ns) != self._place:
            self._place, self._still, self._idle = (job, sim_time_ns), own + box, idle
        own_spent, box_spent = own - self._own, box - self._box
        when = f"at {sim_time_ns / 1e9:.2f} s of simulated time"
        if _resident(self._pid) > MOST_MEMORY:
            what = "Simulating your world" if handed_in else "What your program sent"
            return "memory", f"{what} took more than {MOST_MEMORY >> 30} GiB of memory {when}."
        if not handed_in and own_spent > OWN_CPU_SECONDS + OWN_CPU_FACTOR * self._duration:
            return "timeout", (
                f"Dealing with what your program sent took {own_spent:.0f} s of processor time {when}; it was ended: "
                "it sends far more than is needed."
            )
        if own_spent > CPU_SECONDS + CPU_FACTOR * self._duration:
            return "timeout", (
                f"Simulating your world took {own_spent:.0f} s of processor time and had come no further than "
                f"{sim_time_ns / 1e9:.2f} s of simulated time: it has too many bodies, contacts or rays."
            )
        if box_spent > BOX_CPU_SECONDS + BOX_CPU_FACTOR * self._duration:
            return "timeout", f"What you started had used {box_spent:.0f} s of processor time {when}, and was ended."
        if (still := own + box - self._still) > STILL_CPU_SECONDS:
            return "timeout", (
                f"What you started kept the processor busy for {still:.0f} s while simulated time stood still {when}, "
                "and was ended: it never came to rest."
            )
        if idle - self._idle > LONGEST_WAIT:
            return "timeout", (
                f"Nothing was computed and simulated time stood still for {LONGEST_WAIT:.0f} s {when}: "
                "something you started waits for what never comes."
            )
        if (wall := time.monotonic() - self._began) > wall_limit(self._duration):
            return MACHINE, (
                f"this machine is too busy: {sim_time_ns / 1e9:.2f} s of simulated time took {wall:.0f} s, and the "
                f"run had a processor for {own_spent + box_spent:.0f} s; grade again"
            )
        return None


def cpu_seconds(pid: int, with_ended: bool = False) -> float:
    """Return the processor time [s] a process has used, on wish with that of its ended children."""
    try:
        words = Path(f"/proc/{pid}/stat").read_bytes().rpartition(b")")[2].split()
    except OSError:
        return 0.0
    return sum(map(int, words[11 : 15 if with_ended else 13])) / _TICKS


def is_stopped(pid: int) -> bool:
    """Return whether a process was stopped by a signal."""
    try:
        return Path(f"/proc/{pid}/stat").read_bytes().rpartition(b")")[2].split()[0] == b"T"
    except OSError:
        return False


def _resident(pid: int) -> int:
    with contextlib.suppress(OSError):
        for line in Path(f"/proc/{pid}/status").read_text().splitlines():
            if line.startswith("RssAnon:"):
                return int(line.split()[1]) << 10
    return 0
