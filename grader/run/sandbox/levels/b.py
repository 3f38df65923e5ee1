"""Level B: the same box, built by Python itself (`grader/run/inside/walls.py`), and Landlock within it."""

from __future__ import annotations

from gz_course.grader.run.sandbox.landlock import command as command
from gz_course.grader.run.sandbox.landlock import missing as missing

ABOUT = "namespaces built by Python, a user of its own, a private network, Landlock, limits"
PRIVATE_NETWORK = True
WALLS = "own"
LANDLOCK = True
