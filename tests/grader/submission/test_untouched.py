"""A starter is recognised, under any name, and its report says which part comes first."""

import dataclasses

import pytest

from gz_course.grader.exercise import exercise_names, find_exercise
from gz_course.grader.exercise.pristine import pristine
from gz_course.grader.submission.intake import take_in
from gz_course.grader.submission.untouched import untouched


@pytest.fixture(scope="module")
def exercise(root):
    return find_exercise("03_teleop", root)


def begin(exercise, submission):
    return untouched(exercise, submission.main, submission.files)


def test_every_starter_is_told_where_to_begin(root):
    for name in exercise_names(root):
        exercise = find_exercise(name, root)
        said = begin(exercise, take_in(exercise, exercise.folder))
        assert said.startswith(("Begin", exercise.file.rpartition("/")[2], "follower")), name
        assert len(said.split()) <= 30, said
        assert said.endswith(".") and not said.endswith("..."), said


def test_the_part_is_named_with_its_line(exercise):
    said = begin(exercise, take_in(exercise, exercise.folder))
    lines = pristine(exercise)["teleop_node.py"].decode().splitlines()
    line = next(number for number, text in enumerate(lines, start=1) if "Your part" in text)
    assert said.startswith(
        f"teleop_node.py is as it was handed out. Begin at line {line}: while fewer than five seconds"
    )


def test_another_name_changes_nothing(exercise, tmp_path):
    path = tmp_path / "mine (2).py"
    path.write_bytes(pristine(exercise)["teleop_node.py"])
    assert begin(exercise, take_in(exercise, path))


def test_one_changed_letter_is_a_submission(exercise, tmp_path):
    path = tmp_path / "teleop_node.py"
    path.write_bytes(pristine(exercise)["teleop_node.py"] + b"#")
    assert not begin(exercise, take_in(exercise, path))


def test_nobody_knows_what_was_handed_out(exercise, tmp_path):
    submission = take_in(exercise, exercise.folder)
    elsewhere = dataclasses.replace(exercise, folder=tmp_path / "exercises/03_teleop")
    assert begin(elsewhere, submission) == ""
