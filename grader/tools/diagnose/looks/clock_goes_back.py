"""A clock that goes backwards: because of a reset of the world, or a second source."""

from __future__ import annotations

import itertools
from collections.abc import Iterator

from gz_course.grader.tools.diagnose.finding import Finding, Severity
from gz_course.grader.tools.diagnose.system import System


def look(system: System) -> Iterator[Finding]:
    """Find backward steps of a clock that has one publisher."""
    if len(system.ros_ends("/clock", publish=True)) > 1:
        return
    times = [time_ns for _, time_ns in system.ros.clock]
    back = [(before, after) for before, after in itertools.pairwise(times) if after < before]
    if back:
        before, after = back[0]
        yield Finding(
            Severity.WARNING,
            f"/clock went back from {before * 1e-9:.3f} s to {after * 1e-9:.3f} s while it was listened to.",
            "If you did not reset the world, look for a second simulator; if you did, nodes must forget what they keep "
            "by time (a jump callback of the clock tells them).",
            (f"{len(back)} steps back in {system.ros.seconds:g} s",),
        )
