"""The questions of `course doctor`: one file each, found by being in this folder.

A file says what it is about (`TITLE`) and answers with `examine(probes)`, a `Verdict`. What may crash (a driver, a
library of another ROS) is tried in a process of its own.
"""
