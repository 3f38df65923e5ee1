"""The formats a report can be written in, one file each; every module in this folder is a format.

`html.py` defines `FORMAT`, a `grader.report.format.Format`, which adds the option `--html`. All formats are imported
for the help of `course grade`, so slow imports belong inside their functions.
"""
