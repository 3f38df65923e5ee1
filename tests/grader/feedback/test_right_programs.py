"""Right programs hold no slip and no suspect, whatever their names and blocks: a wrong accusation is worse than none.

These are the solutions and accepted variants, nodes in awkward styles, and those of `right_programs/`, which do what
exercises and other tasks ask for in as many styles as there are.
"""

import ast
from pathlib import Path

import pytest

from gz_course.grader.feedback.launch_files import launch_places
from gz_course.grader.feedback.slips import slips
from gz_course.grader.feedback.suspects import suspects
from gz_course.tests.grader.feedback.renaming import own_names, renamed, wrapped

ROOT = Path(__file__).parents[3]
FILES = sorted(
    file
    for pattern in (
        "solutions/*/*.py", "solutions/*/accepted/**/*.py", "tests/grader/run/styles/**/*.py",
        "tests/grader/feedback/right_programs/*.py",
    )
    for file in ROOT.glob(pattern)
)  # fmt: skip
NODES = [file for file in FILES if ".launch" not in file.name]
LAUNCHES = [file for file in FILES if ".launch" in file.name]
FORMS = {
    "as it is": lambda source: source,
    "renamed": lambda source: renamed(source, "thing_"),
    "renamed shortly": lambda source: renamed(source, "q"),
    "wrapped": wrapped,
}


def name_of(file):
    return str(file.relative_to(ROOT))


@pytest.mark.parametrize("form", FORMS)
@pytest.mark.parametrize("file", NODES, ids=name_of)
def test_a_right_program_is_accused_of_nothing(file, form):
    content = FORMS[form](file.read_text()).encode()
    assert slips(content, duration=10.0) == []
    assert suspects(content) == []


@pytest.mark.parametrize("form", ["as it is", "renamed"])
@pytest.mark.parametrize("file", LAUNCHES, ids=name_of)
def test_a_right_launch_file_is_accused_of_nothing(file, form):
    beside = {each.name: each.read_bytes() for each in file.parent.glob("*.py")}
    assert launch_places(FORMS[form](file.read_text()).encode(), beside)["launch_slips"] == []


def test_there_are_right_programs():
    assert len(NODES) * len(FORMS) + len(LAUNCHES) * 2 > 300


def test_other_names_and_blocks_leave_a_program_what_it_is():
    source = "class A(Node):\n    def f(self, x):\n        self.y = x\n        return self.y + len(x)\n"
    assert own_names(ast.parse(source)) == ["x", "A", "f", "y"]
    assert (
        renamed(source, "v")
        == "class v2(Node):\n\n    def v3(self, v1):\n        self.v4 = v1\n        return self.v4 + len(v1)"
    )
    assert "with nullcontext():\n            self.y = x" in wrapped(source)
