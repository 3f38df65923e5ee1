"""Which sandbox level works here, and do this shell's own limits leave room for a submission?"""

from __future__ import annotations

import resource

from gz_course.grader.run.sandbox import LEVELS, LIMITS, level_module
from gz_course.grader.run.sandbox.level import remember
from gz_course.grader.run.sandbox.probe import try_levels
from gz_course.grader.tools.doctor.probe import ProbeError, Probes
from gz_course.grader.tools.doctor.verdict import Verdict, failed, fine, warning

TITLE = "sandbox of submissions"
# What one rclpy node needs at least, and the shell command that allows it.
NEEDS = {
    resource.RLIMIT_AS: (1 << 30, "address space", "ulimit -v unlimited"),
    resource.RLIMIT_NOFILE: (64, "open files", "ulimit -n 1024"),
}
_CODE = """
import os, sys
from gz_course.grader.errors import CourseError
from gz_course.grader.run.sandbox.probe import exchange
try:
    print(exchange(sys.argv[1], float(sys.argv[2])), flush=True)
except CourseError as error:
    print(error, flush=True)
os._exit(0)
"""
LEAST = "B"  # the lowest level that stops hostile code


def examine(probes: Probes) -> Verdict:
    """Compare what a submission will get with what it needs; then run a node at the best level."""
    for kind, (need, what, fix) in NEEDS.items():
        soft, hard = resource.getrlimit(kind)
        given = [limit for limit in (hard, LIMITS.get(kind, resource.RLIM_INFINITY)) if limit != resource.RLIM_INFINITY]
        least = min(given, default=need)
        if least < need or (soft != resource.RLIM_INFINITY and soft < need):
            return failed(
                f"this shell limits {what} to {min(least, soft if soft >= 0 else least)}, a node needs {need}",
                f"run `{fix}` in this shell, or ask whoever set the limit",
            )

    def attempt(level: str) -> str:
        try:
            return probes.run(_CODE, level, str(probes.wall_seconds_left), within=probes.deadline / 2)
        except ProbeError as error:
            return str(error)

    level, why, certain = try_levels(attempt)
    if certain:
        remember(level, why)
    seen = f"level {level}: {level_module(level).ABOUT}"
    if LEVELS.index(level) <= LEVELS.index(LEAST):
        return fine(seen)
    return warning(
        f"{seen}. {'. '.join(f'Not {better}: {reason}' for better, reason in why.items())}",
        "do not grade code you do not trust here; let ordinary users make namespaces "
        "(sysctl kernel.apparmor_restrict_unprivileged_userns=0), or grade as root or in a virtual machine",
    )
