"""How well does the grader lock a submission in here, and do this shell's own limits leave room for one?"""

from __future__ import annotations

import resource

from grader.doctor.probe import Probes
from grader.doctor.verdict import Verdict, failed, fine
from grader.run.sandbox import LEVEL, LIMITS

TITLE = "sandbox of submissions"
# What one rclpy node needs at least, and what to write for it in a shell.
NEEDS = {
    resource.RLIMIT_AS: (1 << 30, "address space", "ulimit -v unlimited"),
    resource.RLIMIT_NOFILE: (64, "open files", "ulimit -n 1024"),
}
LEVELS = {
    "A": "namespaces, a user of its own and limits",
    "B": "namespaces, restricted files and limits",
    "C": "restricted files and limits; the network is not isolated",
    "D": "limits and a process group of its own: keeps accidents in, no jail for hostile code",
}


def examine(probes: Probes) -> Verdict:
    """Say the level, and compare what a submission will get with what it needs."""
    for kind, (need, what, fix) in NEEDS.items():
        soft, hard = resource.getrlimit(kind)
        given = [limit for limit in (hard, LIMITS.get(kind, resource.RLIM_INFINITY)) if limit != resource.RLIM_INFINITY]
        least = min(given, default=need)
        if least < need or (soft != resource.RLIM_INFINITY and soft < need):
            return failed(
                f"this shell limits {what} to {min(least, soft if soft >= 0 else least)}, a node needs {need}",
                f"run `{fix}` in this shell, or ask whoever set the limit",
            )
    return fine(f"level {LEVEL}: {LEVELS.get(LEVEL, 'a level this check does not know')}")
