"""Exercises: what an author writes (`exercise`, `trial`, read by `toml_table`), and what is made from it.

`grading` finds and loads what grades an exercise.
"""

from gz_course.grader.exercise.exercise import (
    CheckSpec,
    Exercise,
    course_root,
    exercise_names,
    find_exercise,
    load_exercise,
)

__all__ = ["CheckSpec", "Exercise", "course_root", "exercise_names", "find_exercise", "load_exercise"]
