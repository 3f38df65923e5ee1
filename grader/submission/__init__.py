"""What a student handed in: found and read by `intake`, archives by `archive`, held in memory as a `Submission`."""

from gz_course.grader.submission.submission import Submission

__all__ = ["Submission"]
