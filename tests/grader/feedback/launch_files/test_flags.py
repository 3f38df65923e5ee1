"""Expressions that let a world run where it is to be paused."""

import pytest

from gz_course.grader.feedback.launch_files import launch_places

FILE = """\
paused = LaunchConfiguration("paused")


def make(context):
    asked = paused.perform(context)
    return [Node(arguments=[FLAG])]
"""


@pytest.mark.parametrize(
    ("flag", "wrong"),
    [
        ("PythonExpression([\"'-r' if '\", paused, \"' == 'true' else ''\"])", True),
        ("PythonExpression([\"'' if '\", paused, \"' == 'true' else '-r '\"])", False),
        ("PythonExpression([\"'-r' if '\", paused, \"' == 'false' else ''\"])", False),
        ("PythonExpression([\"'-r' if '\", paused, \"' != 'true' else ''\"])", False),
        ("'-s -r' if asked == 'true' else '-s'", True),
        ("'-s -r' if asked.lower() == 'true' else '-s'", True),
        ("'-s' if asked == 'true' else '-s -r'", False),
        ("'-s -r' if asked != 'true' else '-s'", False),
        ("'-s -r' if asked == 'false' else '-s'", False),
    ],
)
def test_the_two_cases_of_a_flag(flag, wrong):
    found = [each["said"] for each in launch_places(FILE.replace("FLAG", flag).encode())["launch_slips"]]
    assert any("the two cases of the expression are exchanged" in each for each in found) == wrong
