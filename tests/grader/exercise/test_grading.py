"""What grades an exercise is found in its own folder or in the installed course, and is loaded as a package."""

import shutil
import sys

import pytest

from gz_course.grader.exercise import exercise_names, find_exercise, load_exercise
from gz_course.grader.exercise.grading import grading_folder, grading_module

WALL = "09_closed_loop"


@pytest.fixture
def own(tmp_path):
    """Write files of the folder that grades an exercise of one's own."""

    def write(**files):
        folder = tmp_path / "exercises/70_own/grading"
        folder.mkdir(parents=True, exist_ok=True)
        (folder / "exercise.toml").touch()
        for name, text in files.items():
            (folder / f"{name}.py").write_text(text)
        return folder

    return write


def test_a_students_folder_is_graded_by_the_installed_course(root, tmp_path):
    mine = tmp_path / "exercises" / WALL
    mine.mkdir(parents=True)
    (mine / "wall_follower.py").write_text("mine")
    assert grading_folder(mine) == root / "exercises" / WALL / "grading"
    assert exercise_names(tmp_path) == [WALL]
    exercise = find_exercise("09", tmp_path)
    assert exercise.starter.read_text() == "mine"
    assert exercise.title == find_exercise("09", root).title, "whatever the student has made of the README"


def test_a_folder_of_its_own_comes_first(root, tmp_path):
    shutil.copytree(root / "exercises/03_teleop", tmp_path / "exercises/03_teleop")
    exercise = load_exercise(tmp_path / "exercises/03_teleop")
    assert exercise.grading == tmp_path / "exercises/03_teleop/grading"


def test_a_folder_that_nobody_grades_is_no_exercise(tmp_path):
    (tmp_path / "exercises/77_notes").mkdir(parents=True)
    assert grading_folder(tmp_path / "exercises/77_notes") is None
    assert exercise_names(tmp_path) == []


def test_the_courses_own_are_imported_by_name(root):
    module = grading_module(root / "exercises" / WALL / "grading", "wall")
    assert module.__name__ == f"gz_course.exercises.{WALL}.grading.wall"
    assert module is grading_module(root / "exercises" / WALL / "grading", "wall")


def test_others_are_packages_with_relative_imports_and_leave_nothing(own):
    folder = own(checks="from .facts import LIMIT\n", facts="LIMIT = 3\n")
    module = grading_module(folder, "checks")
    assert module.LIMIT == 3 and not module.__name__.startswith("gz_course")
    assert module.__package__ in sys.modules
    assert sorted(path.name for path in folder.iterdir()) == ["checks.py", "exercise.toml", "facts.py"]


def test_a_change_in_any_file_is_loaded(own):
    folder = own(checks="from .facts import LIMIT\n", facts="LIMIT = 3\n")
    assert grading_module(folder, "checks").LIMIT == 3
    own(facts="LIMIT = 4\n")
    assert grading_module(folder, "checks").LIMIT == 4


def test_equal_names_in_two_courses_do_not_meet(root, tmp_path):
    copy = tmp_path / "exercises" / WALL / "grading"
    shutil.copytree(root / "exercises" / WALL / "grading", copy)
    (copy / "wall.py").write_text("MINE = True\n")
    assert grading_module(copy, "wall").MINE
    assert not hasattr(grading_module(root / "exercises" / WALL / "grading", "wall"), "MINE")
