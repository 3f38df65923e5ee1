"""Submissions that report for the exercise's own node: what it found out is its word alone."""

import shutil
from pathlib import Path

import pytest

from gz_course.grader.exercise import find_exercise
from gz_course.grader.grade import grade

ROOT = Path(__file__).parents[2]
SOLUTION = ROOT / "solutions/10_actions"
# A server that rejects everything, and says itself that all went well.
SAYS_SO = """
        from std_msgs.msg import String
        import json
        self.forged = self.create_publisher(String, "/dispatcher", 100)
        for event in ("interface", "accepted", "succeeded"):
            said = {"number": 1, "event": event, "goal": "patrol", "fault": "", "visited": 2}
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
def test_a_report_in_the_name_of_the_exercises_node_is_tampering(attack, tmp_path):
    shutil.copytree(SOLUTION / "patrol_interfaces", tmp_path / "submission/patrol_interfaces")
    text = (SOLUTION / "patrol_server.py").read_text()
    place = "        self.busy = False\n"
    assert place in text
    (tmp_path / "submission/patrol_server.py").write_text(text.replace(place, place + attack, 1))
    report = grade(find_exercise("10_actions", ROOT), tmp_path / "submission", tmp_path / "out")
    assert (report.score.outcome, report.score.points) == ("tamper", 0), report.score.diagnosis
    assert "/dispatcher, which belongs to the exercise's own node" in report.score.diagnosis
