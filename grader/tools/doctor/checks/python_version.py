"""Are there ROS wheels for this Python and this platform (CPython 3.11 to 3.14 on Linux, x86-64)?"""

from __future__ import annotations

import platform
import sys

from gz_course.grader.tools.doctor.probe import Probes
from gz_course.grader.tools.doctor.verdict import Verdict, failed, fine, warning

TITLE = "Python and platform"
OLDEST, NEWEST = (3, 11), (3, 14)


def examine(probes: Probes) -> Verdict:
    """Examine the interpreter and the machine."""
    here = f"{platform.python_implementation()} {platform.python_version()}, {platform.system()} {platform.machine()}"
    if (platform.system(), platform.machine(), sys.implementation.name) != ("Linux", "x86_64", "cpython"):
        return failed(here, "use CPython on Linux (x86-64); there are no ROS wheels for anything else")
    if not OLDEST <= sys.version_info[:2] <= NEWEST:
        return failed(here, "set the environment up again with a Python from 3.11 to 3.14")
    if sys.prefix == sys.base_prefix:
        return warning(
            f"{here}, no virtual environment", "keep the course apart: `python3 -m venv .venv`, install there"
        )
    return fine(f"{here}, in {sys.prefix}")
