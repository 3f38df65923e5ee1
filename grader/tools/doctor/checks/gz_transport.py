"""Do two processes find each other by multicast on loopback and exchange a message, as `gz topic` needs it?"""

from __future__ import annotations

import os
import uuid

import psutil

from gz_course.grader.tools.doctor.probe import ProbeError, Probes
from gz_course.grader.tools.doctor.verdict import Verdict, failed, fine, warning

TITLE = "Gazebo transport between two processes"
TOPIC = "/course_doctor"

TALKER = """
import sys
from gz_course.sim.gz.msgs.stringmsg_pb2 import StringMsg
from gz_course.sim.gz.transport import Node
node = Node()
publisher = node.advertise(sys.argv[1], StringMsg)
message = StringMsg()
message.data = sys.argv[2]
if not publisher.wait_for_subscribers(timeout=float(sys.argv[3])):
    sys.exit("no subscriber was discovered: multicast does not work on the loopback interface")
publisher.publish(message)
sys.stdin.read()
"""
LISTENER = """
import sys, threading
from gz_course.sim.gz.msgs.stringmsg_pb2 import StringMsg
from gz_course.sim.gz.transport import Node
heard = threading.Event()
node = Node()
node.subscribe(StringMsg, sys.argv[1], lambda message: heard.set() if message.data == sys.argv[2] else None)
if not heard.wait(float(sys.argv[3])):
    sys.exit("no message was heard: multicast does not work on the loopback interface")
node.close()
"""


def examine(probes: Probes) -> Verdict:
    """Publish in one process and receive in another, in a private partition."""
    token = uuid.uuid4().hex
    environment = {"GZ_PARTITION": f"doctor-{token}", "GZ_IP": "127.0.0.1"}
    arguments = (TOPIC, token, f"{max(0.1, probes.wall_seconds_left):.1f}")
    talker = probes.start(TALKER, *arguments, environment=environment)
    try:
        probes.run(LISTENER, *arguments, environment=environment)
    except ProbeError as error:
        return failed(
            f"no message came: {error}",
            "let multicast through on loopback: `sudo ip link set lo multicast on`, "
            "`sudo ip route add 239.255.0.0/16 dev lo`, and UDP ports 10317 and 10318 in the firewall",
        )
    finally:
        talker.stop()
    given = os.environ.get("GZ_IP", "")
    if given and given not in addresses():
        return warning(
            f"a message went through on loopback, but GZ_IP is {given}, no address of this machine",
            "`unset GZ_IP`, or set it to this machine's address",
        )
    return fine("two processes found each other by multicast on loopback, and a message went through")


def addresses() -> set[str]:
    """Return the network addresses of this machine."""
    return {each.address for group in psutil.net_if_addrs().values() for each in group}
