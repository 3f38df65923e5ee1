"""Mistakes of Python that launch files have in common with nodes."""

from __future__ import annotations

from collections.abc import Iterator

from gz_course.grader.feedback.launch_files import launch_slip
from gz_course.grader.feedback.launch_files.reading import LaunchFile, Place
from gz_course.grader.feedback.slips.language.no_effect import first_iteration
from gz_course.grader.feedback.slips.language.shared_objects import late_bound, one_list_for_all
from gz_course.grader.feedback.slips.nodes.scan_callbacks import kept_defaults


@launch_slip
def of_python(file: LaunchFile) -> Iterator[Place]:
    """Find defaults and lists that are shared, loops that end in their first iteration, names that are bound late."""
    for rule in (kept_defaults, first_iteration, late_bound, one_list_for_all):
        yield from rule(file.tree)
