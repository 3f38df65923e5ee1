"""The formats a report can be written in: one file each, found by being in this folder.

The file `html.py` holds `FORMAT`, a `grader.report.format.Format`, and is the option `--html`. It is imported for the
help of `course grade`: what takes long to import is imported in its functions.
"""
