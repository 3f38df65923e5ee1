"""Kinds of submissions, a folder each: what students hand in, how it is read, run and diagnosed.

`exercise.toml` names the kind (`kind = "node"`); the package `grader/kinds/node/` defines it as `KIND`, a `Kind`
(`kind.py`). A new package in this folder is a new kind; no list needs to be edited.
"""
