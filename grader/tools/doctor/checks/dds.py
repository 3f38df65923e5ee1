"""Does a message get from one process to another over DDS? Tested as the grader uses it: own domain, loopback, UDP."""

from __future__ import annotations

from gz_course.grader.run.domain import Domain
from gz_course.grader.run.sandbox import ros_environment
from gz_course.grader.tools.doctor.probe import ProbeError, Probes
from gz_course.grader.tools.doctor.verdict import Verdict, failed, fine

TITLE = "DDS between two processes"
TOPIC = "/course_doctor"

# The publisher keeps the message for late subscribers (transient local), so neither side needs to be first.
_COMMON = """
import sys
import rclpy
from rclpy.qos import DurabilityPolicy, QoSProfile
from std_msgs.msg import String
topic, token = sys.argv[1:]
qos = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
rclpy.init()
node = rclpy.create_node("course_doctor")
"""
TALKER = f"""{_COMMON}
publisher = node.create_publisher(String, topic, qos)
publisher.publish(String(data=token))
sys.stdin.read()
"""
LISTENER = f"""{_COMMON}
heard = []
node.create_subscription(String, topic, lambda message: heard.append(message.data), qos)
while token not in heard:
    rclpy.spin_once(node, timeout_sec=0.5)
print(node.get_name(), len(heard))
"""


def examine(probes: Probes) -> Verdict:
    """Publish in one process and receive in another."""
    with Domain() as domain:
        environment = ros_environment(domain.id, probes.folder / "ros_log")
        token = f"token-{domain.id}"
        talker = probes.start(TALKER, TOPIC, token, environment=environment)
        try:
            probes.run(LISTENER, TOPIC, token, environment=environment)
        except ProbeError as error:
            return failed(
                f"no message came: {error}",
                "mend what the lines about ROS here name; if there is none, let UDP on 127.0.0.1 through the firewall",
            )
        finally:
            talker.stop()
    return fine(f"a message went over DDS on loopback, domain {domain.id}")
