"""Kinds of submissions, a folder each: what students hand in, how it is read, run and diagnosed.

`exercise.toml` names the kind (`kind = "node"`); the package `grader/kinds/node/` holds it as `KIND`, a `Kind`
(`kind.py`). A folder with such a package is a kind; nothing lists them.
"""
