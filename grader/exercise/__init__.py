"""Exercises: what an author writes (`exercise`, `trial`, read by `toml_table`), and what is made from it."""

from gz_course.grader.exercise.exercise import (
    MANIFEST,
    CheckSpec,
    Exercise,
    course_root,
    exercise_names,
    find_exercise,
    load_exercise,
)

__all__ = ["MANIFEST", "CheckSpec", "Exercise", "course_root", "exercise_names", "find_exercise", "load_exercise"]
