"""How the robots of a convoy stand if not in their row, and what in the launch file ends their number."""

from __future__ import annotations

import itertools
import math

from gz_course.grader.record.reading import Recording

GAP = 1.2  # [m]
ROW = 0.15  # [m] that a robot may start beside its place


def ends_there(recording: Recording, count: int, called: str) -> str:
    """Return the loop or the list of the launch file that makes so many robots at most; empty if there is none."""
    places = [each for each in recording.facts().get("fixed_counts", []) if each["count"] == count]
    return "".join(
        f"{each['file']}, line {each['line']}: {each['said']}, so no more than {count} robots come, and it was "
        f"{called}: the function of an OpaqueFunction makes as many as the argument says, "
        "int(LaunchConfiguration('robots').perform(context))"
        for each in places[:1]
    )


def misplaced(recording: Recording, names: list[str]) -> str:
    """Return how the robots stand instead of in their row; empty if in no way that is known."""
    x, y = ([float(recording.signal(f"truth/{name}/{axis}").values[0]) for name in names] for axis in ("x", "y"))
    if len(names) < 2:
        return ""
    places = list(zip(x, y, strict=True))
    steps = [(two[0] - one[0], two[1] - one[1]) for one, two in itertools.pairwise(places)]
    if max(abs(step[axis] - steps[0][axis]) for step in steps for axis in (0, 1)) > ROW:
        return ""
    ahead, aside = steps[0]
    if math.hypot(ahead, aside) < ROW:
        return "all begin at one place: -x of create is the same for all, or is missing"
    if abs(aside) > ROW and abs(ahead) < ROW:
        return "they stand side by side: the row is along x, and -x of create places a robot there"
    if abs(ahead - GAP) < ROW:
        return "each stands in front of the one before: behind is -x"
    if abs(ahead + GAP) > ROW:
        return f"they stand {abs(ahead):.2f} m apart, and {GAP} m is asked for"
    if abs(x[0] + GAP) < ROW:
        return "the row begins one place too far behind: robot1 is at x = 0, so robot N is at -1.2 * (N - 1)"
    return ""


def added_up(reason: str, before: int) -> str:
    """Return what a follower with several robots before it has added up, if it keeps so many gaps; else nothing."""
    if before < 2 or f"is zero at a distance of {GAP * before:.2f} m" not in reason:
        return ""
    return f": the gaps to all {before} robots before it, added up, and only the next one counts"
