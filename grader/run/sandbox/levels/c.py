"""Level C: no namespaces. Landlock for files, TCP, signals and tracing; UDP stays open, processes stay visible."""

from __future__ import annotations

from gz_course.grader.run.sandbox.landlock import command as command
from gz_course.grader.run.sandbox.landlock import missing as missing

ABOUT = "Landlock and limits; the network is not isolated"
PRIVATE_NETWORK = False
WALLS = ""
LANDLOCK = True
