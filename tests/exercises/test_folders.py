"""The folder of an exercise: what the student sees of it, and that its README and its manifest say the same."""

import ast
import re

import pytest

from gz_course.grader.exercise import exercise_names, find_exercise
from gz_course.grader.exercise.grading import GRADING, README
from gz_course.tests.import_arrows import ROOT

MOST_ENTRIES = 6
ROW = re.compile(r"\| (.+) \| (\d+) \|")
each_exercise = pytest.mark.parametrize("name", exercise_names(ROOT))


@pytest.fixture
def exercise(name):
    return find_exercise(name, ROOT)


@each_exercise
def test_a_student_sees_few_things(exercise):
    seen = {path.name for path in exercise.folder.iterdir()} - {GRADING, "__pycache__"}
    assert README in seen and {name.partition("/")[0] for name in exercise.parts} <= seen
    assert len(seen) <= MOST_ENTRIES, sorted(seen)


@each_exercise
def test_nothing_that_grades_stands_among_what_students_see(exercise):
    for path in exercise.folder.rglob("*.py"):
        if path.is_relative_to(exercise.grading):
            continue
        for node in ast.walk(ast.parse(path.read_text())):
            modules = [node.module or ""] if isinstance(node, ast.ImportFrom) else []
            modules += [alias.name for alias in node.names] if isinstance(node, ast.Import) else []
            assert not [module for module in modules if module.startswith("gz_course")], path


@each_exercise
def test_the_readme_lists_the_checks_with_their_points(exercise):
    table = (exercise.folder / README).read_text().partition("\n## Points\n")[2]
    assert ROW.findall(table) == [(check.title, f"{check.points:g}") for check in exercise.checks]


@each_exercise
def test_the_readme_tells_no_hint(exercise):
    text = " ".join((exercise.folder / README).read_text().split())
    assert [check.hint for check in exercise.checks if check.hint in text] == []
