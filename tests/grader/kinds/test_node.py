"""`kind = "node"`: what is known of a file before it runs goes into the facts of its run."""

from gz_course.grader.exercise import find_exercise
from gz_course.grader.kinds.node import plan
from gz_course.grader.submission.intake import take_in


def test_suspicious_places_of_the_file_become_facts(root, tmp_path):
    exercise = find_exercise("03_teleop", root)
    text = (root / "solutions" / "03_teleop" / exercise.file).read_text()
    node = tmp_path / exercise.file
    node.write_text(text)
    assert plan(exercise, take_in(exercise, node)).facts == {}
    node.write_text(f"import time\ntime.sleep(1)\ncommand.linear.x = 1\n{text}")
    assert plan(exercise, take_in(exercise, node)).facts == {
        "wall_clock": [{"file": exercise.file, "line": 2, "call": "time.sleep()", "waits": True}],
        "whole_numbers": [{"file": exercise.file, "line": 3, "field": "command.linear.x", "value": "1"}],
    }
