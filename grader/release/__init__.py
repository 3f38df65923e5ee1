"""The students' copy of the course: `student_copy.py` makes it for `course release`."""
