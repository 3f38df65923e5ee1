"""Publishers on the simulator's topics that hide from the agent in their process: DDS shows them all the same."""

from pathlib import Path

import pytest

from gz_course.grader.exercise import find_exercise
from gz_course.grader.grade import grade

ROOT = Path(__file__).parents[2]
UNSPUN = """
import rclpy, threading
from nav_msgs.msg import Odometry
def publish():
    while not rclpy.ok():
        threading.Event().wait(0.01)
    publisher = rclpy.create_node("hidden").create_publisher(Odometry, "/odom", 10)
    for _ in range(100):
        publisher.publish(Odometry())
        threading.Event().wait(0.01)
    threading.Event().wait()
threading.Thread(target=publish, daemon=True).start()
"""
# Taken out of the lists that the agent reads.
UNLISTED = """
import rclpy.node
from nav_msgs.msg import Odometry
make = rclpy.node.Node.__init__
def hiding(node, *args, **kwargs):
    make(node, *args, **kwargs)
    node.hidden = node.create_publisher(Odometry, "/odom", 10)
    node._publishers.remove(node.hidden)
    node.create_timer(0.1, lambda: node.hidden.publish(Odometry()))
rclpy.node.Node.__init__ = hiding
"""
# A process without the agent; its publisher is gone again before the run ends.
PROCESS = """
import os, sys
CODE = '''
import rclpy, time
from nav_msgs.msg import Odometry
rclpy.init()
node = rclpy.create_node("hidden")
deadline = time.monotonic() + 30
while len(node.get_node_names()) < 2 and time.monotonic() < deadline:
    rclpy.spin_once(node, timeout_sec=0.1)
publisher = node.create_publisher(Odometry, "/odom", 10)
publisher.publish(Odometry())
node.destroy_publisher(publisher)
print("sent", flush=True)
'''
reading, writing = os.pipe()
if not os.fork():
    os.dup2(writing, 1)
    kept = {k: v for k, v in os.environ.items() if not k.startswith("COURSE") and k != "PYTHONPATH"}
    os.execve(sys.executable, [sys.executable, "-c", CODE], kept)
def await_sent():
    assert os.read(reading, 4) == b"sent"
"""


@pytest.mark.parametrize(
    "attack",
    [
        pytest.param(UNSPUN, id="a node that nobody spins"),
        pytest.param(UNLISTED, id="out of rclpy's lists", marks=pytest.mark.proof),
        pytest.param(PROCESS, id="a short one in a process without the agent", marks=pytest.mark.proof),
    ],
)
def test_a_hidden_publisher_on_a_topic_of_the_simulator_is_tampering(attack, solution, tmp_path):
    (tmp_path / "teleop_node.py").write_text(
        f"import attack\n{solution}".replace("rclpy.spin(", 'getattr(attack, "await_sent", int)() or rclpy.spin(')
    )
    (tmp_path / "attack.py").write_text(attack)
    report = grade(find_exercise("03_teleop", ROOT), tmp_path, tmp_path / "out")
    assert (report.score.outcome, report.score.points) == ("tamper", 0), report.score.diagnosis
    assert "publishes on /odom" in report.score.diagnosis


# Says to the grader what is not so; another grading at level C could say it over a connection of its own.
CLAIM = """
import json, os, socket, threading
def claim():
    channel = socket.socket(socket.AF_UNIX, socket.SOCK_SEQPACKET)
    channel.connect(os.environ["COURSE_SOCKET"])
    endpoint = {"node": "/hidden", "kind": "publisher", "topic": "/odom", "type": "nav_msgs/msg/Odometry"}
    endpoint |= {"reliability": "RELIABLE", "durability": "VOLATILE", "matched": 1}
    report = {"clock": None, "idle": True, "taken": {}, "published": {}, "delivered": {}, "holding": True, "held": 0}
    channel.send(json.dumps(report | {"released": 0, "flushes": 0, "endpoints": [endpoint]}).encode())
    threading.Event().wait()
threading.Thread(target=claim, daemon=True).start()
"""


@pytest.mark.proof
def test_a_publisher_that_is_only_claimed_is_none(solution, tmp_path):
    (tmp_path / "teleop_node.py").write_text(f"import attack\n{solution}")
    (tmp_path / "attack.py").write_text(CLAIM)
    report = grade(find_exercise("03_teleop", ROOT), tmp_path, tmp_path / "out")
    assert (report.score.outcome, report.score.points) == ("graded", 100), report.score.diagnosis
