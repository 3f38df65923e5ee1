"""A right node with a huge log keeps its points; the log is cut, and the report says so."""

from pathlib import Path

import pytest

from gz_course.grader.run.sandbox.probe import try_level
from gz_course.tests.grader.conftest import assert_nothing_left, run_grade

SOLUTION = (Path(__file__).parents[2] / "solutions/03_teleop/teleop_node.py").read_text()
SAYS = {
    "print": "print('x' * 1999)",
    "logger": "self.get_logger().info('x' * 1999)",
}
LINES = 1000  # each time a command is published, some thirty times: 60 MB


@pytest.mark.proof
@pytest.mark.parametrize("level", ["A", "C"])
@pytest.mark.parametrize("how", SAYS)
def test_it_is_cut_and_the_points_stay(how, level, tmp_path):
    if lack := try_level(level):
        pytest.skip(f"no level {level} here: {lack}")
    line = "        now = self.get_clock().now()\n"
    assert line in SOLUTION
    chatty = f"        for _ in range({LINES}):\n            {SAYS[how]}\n"
    (tmp_path / "teleop_node.py").write_text(SOLUTION.replace(line, line + chatty))
    outcome = run_grade(tmp_path, "03_teleop", tmp_path / "teleop_node.py", "--sandbox", level)
    assert_nothing_left(outcome)
    assert (outcome.report["score"], outcome.report["outcome"]) == (100, "graded"), outcome.report["diagnosis"]
    assert "The log was too long to be recorded" in " ".join(outcome.report["notes"])
