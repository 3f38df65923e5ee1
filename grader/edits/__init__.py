"""Edits: a file with one change that a person could make. `verify` breaks a right program by one,
`explain` mends a wrong one.

`edit.py` is what both see. The other files know a type of file each; those with `mending` edits add what is only worth
trying on a wrong program.
"""

from gz_course.grader.edits.edit import Edit, Vocabulary, edits_of

__all__ = ["Edit", "Vocabulary", "edits_of"]
