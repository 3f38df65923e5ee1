"""Programs that earn full marks hold no slip and no suspect: a wrong accusation is worse than none."""

from pathlib import Path

import pytest

from gz_course.grader.feedback.slips import slips
from gz_course.grader.feedback.suspects import suspects

ROOT = Path(__file__).parents[4]
SOLUTIONS = ROOT / "solutions"
RIGHT = sorted(
    file
    for pattern in ("*/*.py", "*/accepted/*/*.py")
    for file in SOLUTIONS.glob(pattern)
    if ".launch" not in file.name
)


@pytest.mark.parametrize("file", RIGHT, ids=lambda file: str(file.relative_to(SOLUTIONS)))
def test_a_right_program_is_accused_of_nothing(file: Path) -> None:
    assert slips(file.read_bytes(), duration=10.0) == []
    assert suspects(file.read_bytes()) == []


def test_there_are_right_programs() -> None:
    assert len(RIGHT) > 30
