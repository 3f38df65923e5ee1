"""Kinds of submissions, one a file: what students hand in, how it is read, and what plays when it is run.

`exercise.toml` names the kind (`kind = "node"`); `grader/kinds/node.py` holds it as `KIND`.
"""
