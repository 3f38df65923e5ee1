"""Several sources of `/clock`: time jumps back and forth between them."""

from __future__ import annotations

import itertools
from collections.abc import Iterator

from gz_course.grader.tools.diagnose.finding import Finding, Severity
from gz_course.grader.tools.diagnose.system import System, names

BEFORE = ("not_bridged",)


def look(system: System) -> Iterator[Finding]:
    """Find more than one publisher of `/clock`."""
    publishers = [end.node for end in system.ros_ends("/clock", publish=True)]
    if len(publishers) < 2:
        return
    times = [time_ns for _, time_ns in system.ros.clock]
    steps = list(itertools.pairwise(times))
    back = sum(after < before for before, after in steps)
    yield Finding(
        Severity.ERROR,
        f"/clock has {len(publishers)} publishers ({names(publishers)}): time jumps between them.",
        "End all but one: a bridge or simulator of an earlier run may be left over, or a second bridge carries the "
        "clock, too.",
        (f"{back} of {len(steps)} steps of the clock went back",) if steps else (),
    )
