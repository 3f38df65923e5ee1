"""Can Fast DDS use shared memory? Nodes started by hand use it; grading does not."""

from __future__ import annotations

import shutil
import tempfile
from pathlib import Path

from gz_course.grader.tools.doctor.probe import Probes
from gz_course.grader.tools.doctor.verdict import Verdict, fine, warning

TITLE = "shared memory"
FOLDER = Path("/dev/shm")
LEAST = 32 << 20  # [bytes]; each participant takes about half a megabyte
_UDP = "`export FASTDDS_BUILTIN_TRANSPORTS=UDPv4` in every terminal keeps DDS out of it"


def examine(probes: Probes) -> Verdict:
    """Write a file there and read how much space is free."""
    try:
        with tempfile.TemporaryFile(dir=FOLDER) as stream:
            stream.write(b"x")
            stream.flush()
        free = shutil.disk_usage(FOLDER).free
    except OSError as error:
        return warning(f"{FOLDER} cannot be written: {error.strerror}", _UDP)
    if free < LEAST:
        return warning(f"{free >> 20} MB free in {FOLDER}", _UDP)
    return fine(f"{free >> 20} MB free in {FOLDER}")
