"""The questions of `course doctor`, one file each; every module in this folder is asked.

A file defines its subject (`TITLE`) and answers with `examine(probes)`, a `Verdict`. What may crash (a driver, a
library of another ROS) is tried in a separate process.
"""
