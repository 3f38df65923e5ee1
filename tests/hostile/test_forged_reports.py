"""Submissions that report for the exercise's own node: what they publish is no report, under whatever name."""

import json
import shutil
from pathlib import Path

import pytest

from gz_course.grader.exercise import find_exercise
from gz_course.grader.grade import grade
from gz_course.grader.record.reading import REPORTS, Recording

ROOT = Path(__file__).parents[2]
SOLUTION = ROOT / "solutions/10_actions"
# A server that says itself that all went well.
SAYS_SO = """
        from std_msgs.msg import String
        import json
        self.forged = self.create_publisher(String, "/dispatcher", 100)
        for goal in ("empty", "too_fast", "backwards", "standing"):
            said = {"number": 1, "event": "rejected", "goal": goal}
            self.create_timer(1.0, lambda said=said: self.forged.publish(String(data=json.dumps(said))))
"""
# The same in a node of its own, under the name of the exercise's node.
IN_ITS_NAME = """
        from std_msgs.msg import String
        self.other = rclpy.create_node("dispatcher")
        self.forged = self.other.create_publisher(String, "/dispatcher", 100)
        self.create_timer(1.0, lambda: self.forged.publish(String(data="{}")))
"""


@pytest.mark.proof
@pytest.mark.parametrize("attack", [pytest.param(SAYS_SO, id="says so"), pytest.param(IN_ITS_NAME, id="in its name")])
def test_what_is_said_in_the_name_of_the_exercises_node_is_no_report(attack, tmp_path):
    shutil.copytree(SOLUTION / "patrol_interfaces", tmp_path / "submission/patrol_interfaces")
    text = (SOLUTION / "rejected/accepts_everything/patrol_server.py").read_text()
    place = "        self.busy = False\n"
    assert place in text
    (tmp_path / "submission/patrol_server.py").write_text(text.replace(place, place + attack, 1))
    report = grade(find_exercise("10_actions", ROOT), tmp_path / "submission", tmp_path / "out")
    assert (report.score.outcome, report.score.points) == ("graded", 85), report.score.diagnosis
    numbers = [json.loads(line.text)["number"] for line in Recording(report.recording).lines(REPORTS)]
    assert numbers == list(range(1, len(numbers) + 1))
