"""Real submissions that wait, or make others wait, for what never comes: every grading ends, and says why."""

import json
import subprocess
import sys
from pathlib import Path

SOLVED = Path(__file__).parents[3] / "solutions" / "04_lidar_listener" / "lidar_subscriber.py"
DOMAINS = """
from rclpy.context import Context

def elsewhere(domain):
    context = Context()
    rclpy.init(context=context, domain_id=domain)
    node = Node("elsewhere", context=context)
    node.create_subscription(LaserScan, "/lidar/scan", print, 10)
    node.create_publisher(Float32, "/nearest_obstacle", 10).publish(Float32(data=0.0))
    node.get_logger().info("nobody of the run hears this")
    return node
"""
COMPUTES = """
import threading

def count():
    while True:
        pass

threading.Thread(target=count, daemon=True).start()
"""


def graded(folder, text, *options):
    """Grade a listener; return the report."""
    (folder / "lidar_subscriber.py").write_text(text)
    command = [sys.executable, "-m", "gz_course.grader", "grade", "04_lidar_listener", "--submission", str(folder)]
    report = folder / "report.json"
    done = subprocess.run(
        [*command, "--out", str(folder / "out"), "--no-page", "--json", str(report), *options],
        capture_output=True,
        text=True,
    )
    assert report.exists(), done.stdout + done.stderr
    return json.loads(report.read_text())


def test_contexts_in_other_domains(tmp_path):
    text = SOLVED.read_text()
    made = "    rclpy.init()\n    others = [elsewhere(domain) for domain in (41, 42)]\n"
    text = text.replace("\n\n\ndef main", f"\n{DOMAINS}\n\ndef main").replace("    rclpy.init()\n", made)
    report = graded(tmp_path, text)
    assert (report["score"], report["outcome"], report["pace"]) == (100, "graded", "lockstep")
    assert set(report["limits"]) == {"processor_seconds", "wall_seconds"}


def test_a_thread_that_computes_without_end_beside_a_node_that_spins(tmp_path):
    text = SOLVED.read_text().replace("\n\n\ndef main", f"\n{COMPUTES}\n\ndef main")
    report = graded(tmp_path, text)
    assert report["outcome"] == "timeout"
    assert "never comes to rest" in report["diagnosis"]
    assert "never spun" not in report["diagnosis"]
