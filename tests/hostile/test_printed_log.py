"""Lines that look like a log, and logs that look unusual: a line counts if its message came on /rosout."""

import json
from pathlib import Path

import pytest

from gz_course.grader.exercise import find_exercise
from gz_course.grader.grade import grade
from gz_course.grader.record.reading import Recording

ROOT = Path(__file__).parents[2]
SOLUTION = (ROOT / "solutions/04_lidar_listener/lidar_subscriber.py").read_text()
LOG = "self.get_logger().info("
NODE = 'super().__init__("lidar_listener")'
SPIN = "rclpy.spin(LidarListener())"
PRINTED = SOLUTION.replace(LOG, 'print("[INFO] [lidar_listener]: " + ')
OFF = SOLUTION.replace(NODE, 'super().__init__("lidar_listener", enable_rosout=False)')
CHILD = SOLUTION.replace(LOG, 'self.get_logger().get_child("scans").info(')
THREADS = SOLUTION.replace(
    SPIN,
    "from rclpy.executors import MultiThreadedExecutor\n    executor = MultiThreadedExecutor(4)\n"
    "    executor.add_node(LidarListener())\n    executor.spin()",
)
# Another process answers the scans.
TWO = (
    SOLUTION.replace("self.nearest.publish", "self.nearest.publish")
    .replace(
        SPIN,
        "import subprocess, sys\n    other = subprocess.Popen([sys.executable, __file__, *sys.argv[1:]]) "
        'if "talker" not in sys.argv else None\n    rclpy.spin(LidarListener() if other is None else Node("parent"))',
    )
    .replace("[sys.executable, __file__, *sys.argv[1:]]", '[sys.executable, __file__, "talker", *sys.argv[1:]]')
)
# Logs more lines than /rosout keeps before anybody can have found it.
EAGER = SOLUTION.replace(NODE, NODE + "\n        for i in range(300):\n            self.get_logger().info(f'line {i}')")
ENDS = SOLUTION.replace(
    "self.nearest.publish(Float32(data=min(valid)))",
    "self.nearest.publish(Float32(data=min(valid)))\n        self.count = getattr(self, 'count', 0) + 1\n"
    "        if self.count == 3:\n            self.get_logger().error('that is enough')\n"
    "            raise SystemExit(0)",
)


@pytest.fixture
def graded(tmp_path):
    """Grade a node; the report and the facts of its recording."""

    def call(text):
        (tmp_path / "lidar_subscriber.py").write_text(text)
        report = grade(find_exercise("04_lidar_listener", ROOT), tmp_path, tmp_path / "out")
        (recording,) = (tmp_path / "out").glob("*.rrd")
        return report, Recording(recording)

    return call


@pytest.mark.proof
@pytest.mark.parametrize(
    ("text", "words"),
    [
        pytest.param(PRINTED, "printed, not logged", id="printed"),
        pytest.param(OFF, "/lidar_listener has its log to /rosout switched off", id="off"),
    ],
)
def test_what_only_looks_logged_is_not(graded, text, words):
    report, _ = graded(text)
    logs, others = report.score.checks[:3], report.score.checks[3:]
    assert [each.points for each in logs] == [0, 0, 0] and all(words in each.finding.measured for each in logs)
    assert all(each.points == each.spec.points for each in others)
    assert report.host.pace == "lockstep"


@pytest.mark.proof
@pytest.mark.parametrize(
    "text",
    [
        pytest.param(CHILD, id="child logger"),
        pytest.param(THREADS, id="threads"),
        pytest.param(TWO, id="two processes"),
        pytest.param(EAGER, id="300 lines at once"),
    ],
)
def test_what_is_logged_counts_however_it_is_done(graded, text):
    report, recording = graded(text)
    assert (report.score.points, report.host.pace) == (100, "lockstep"), report.score.diagnosis
    assert recording.facts()["not_logged"] == []


@pytest.mark.proof
def test_the_last_words_of_a_node_that_ends_are_logged(graded):
    _, recording = graded(ENDS)
    assert any("that is enough" in line.text for line in recording.lines("log/student"))
    assert recording.facts()["not_logged"] == [], json.dumps(recording.facts())
