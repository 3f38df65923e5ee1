"""What attacks forge in DDS is believed by plain nodes of rclpy: else such an attack would try nothing.

These are the datagrams of `cases/rtps.py`, and what `cases/shared_history` writes into shared memory.
"""

import os
import subprocess
import sys
import textwrap

import pytest

from gz_course.grader.run.sandbox.levels.a import program as bubblewrap

from .test_hostile import CASES

NO_ATTACKS = True
LISTENER = """
import sys, threading
import rclpy
from rclpy.executors import SingleThreadedExecutor
from std_msgs.msg import String
rclpy.init()
node = rclpy.create_node("listener")
node.create_subscription(String, "/spoken", lambda message: print("heard", message.data, flush=True), 100)
known = 0
def look():
    global known
    if (count := node.count_publishers("/spoken")) != known:
        known = count
        print("publishers", known, flush=True)
node.create_timer(0.01, look)
rclpy.spin(node)
"""
CLIENT = """
import rclpy
from std_srvs.srv import Trigger
rclpy.init()
node = rclpy.create_node("client")
client = node.create_client(Trigger, "/asked")
client.wait_for_service()
answer = client.call_async(Trigger.Request())
rclpy.spin_until_future_complete(node, answer)
print("heard", answer.result().message, flush=True)
"""
# Speaks, and forges. `heard(text)` waits for a line of the listener; `silent(text)` says that it has not come by then.
SPEAKER = """
import subprocess, sys
import rclpy
from std_msgs.msg import String
listener = subprocess.Popen([sys.executable, "listener.py"], stdout=subprocess.PIPE, text=True)
rclpy.init()
node = rclpy.create_node("speaker")
publisher = node.create_publisher(String, "/spoken", 100)
lines = []
def heard(text):
    while text not in lines:
        lines.append(listener.stdout.readline().strip())
        assert lines[-1], "the listener has ended"
def say(text):
    publisher.publish(String(data=text))
def spoken(text):
    data = text.encode() + b"\\0"
    return b"\\0\\1\\0\\0" + struct.pack("<I", len(data)) + data + b"\\0" * (-len(data) % 4)
heard("publishers 1")
while not publisher.get_subscription_count():
    time.sleep(0.01)
say("1")
heard("heard 1")
mine = writer_of(node, "/spoken")
try:
{forgery}
    print("believed")
finally:
    listener.kill()
    os._exit(0) if sys.exc_info()[0] is None else None
"""
# Each ends only if it is believed.
FORGERIES = {
    "a sample": """
        send_to_all(data_message(mine, 2, spoken("forged")))
        heard("heard forged")
        say("2")  # the second of this writer has come, they think
        say("3")
        heard("heard 3")
        assert "heard 2" not in lines
    """,
    "a heartbeat": """
        send_to_all(heartbeat(mine, 1_000, 10_000))
        time.sleep(0.5)
        say("2")
        send_to_all(data_message(mine, 1_000, spoken("far ahead")))
        heard("heard far ahead")
        assert "heard 2" not in lines
    """,
    "a gap": """
        send_to_all(gap(mine, 2, 4))
        time.sleep(0.5)
        say("2")
        say("3")
        say("4")
        heard("heard 4")
        assert "heard 2" not in lines and "heard 3" not in lines
    """,
    "a farewell": """
        for number in range(1, 20):
            send_to_all(farewell(mine, number), discovery=True)
        heard("publishers 0")
    """,
    "the end of an endpoint": """
        for number in range(1, 60):
            send_to_all(end_of(mine, number), discovery=True)
        heard("publishers 0")
    """,
    "a stranger": """
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as door:
            door.bind(("127.0.0.1", 0))
            door.settimeout(100)
            send_to_all(announcement(os.urandom(16), door.getsockname()[1], 1), discovery=True)
            assert door.recv(1 << 16).startswith(b"RTPS")  # who believes it introduces itself
    """,
    "a reply": """
        from rclpy.serialization import serialize_message
        from std_srvs.srv import Trigger
        listener.kill()
        listener = subprocess.Popen([sys.executable, "client.py"], stdout=subprocess.PIPE, text=True)
        def answer(request, response):
            client, server = (writer_of(node, name, no_mangle=True) for name in ("rq/askedRequest", "rr/askedReply"))
            forged = serialize_message(Trigger.Response(message="forged"))
            send_to_all(reply_message(server, 1, (client, 1), forged))
            response.message = "true"
            return response
        service = node.create_service(Trigger, "/asked", answer)
        rclpy.spin_once(node, timeout_sec=300)
        heard("heard forged")
    """,
}
# Says yes and stays; what somebody else has changed in its history by then is what a listener that comes later hears.
SHARES = """
import subprocess, sys
import rclpy
from rclpy.qos import DurabilityPolicy, QoSProfile
from std_msgs.msg import Bool
rclpy.init()
node = rclpy.create_node(sys.argv[1])
kept = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
if sys.argv[1] == "speaker":
    node.create_publisher(Bool, "/said", kept).publish(Bool(data=True))
    if subprocess.run([sys.executable, "forger.py"]).returncode == 0:
        subprocess.run([sys.executable, "node.py", "listener"])
else:
    heard = []
    node.create_subscription(Bool, "/said", heard.append, kept)
    while not heard:
        rclpy.spin_once(node)
    print("heard", heard[0].data, flush=True)
os._exit(0)
"""
FORGES = """
import sys
mine, theirs = histories()
sys.exit(mine != [] or sum(map(rewritten, theirs)) != 1)
"""


def alone(folder, program, **variables):
    """What a program prints where nobody else is, and what it says of errors."""
    words = [str(bubblewrap()), "--die-with-parent", "--unshare-pid", "--unshare-net", "--dev-bind", "/", "/"]
    words += ["--tmpfs", "/dev/shm", "--chdir", str(folder), "--", sys.executable, *program]
    variables = {"ROS_DOMAIN_ID": "1", "ROS_LOG_DIR": str(folder), "HOME": str(folder)} | variables
    done = subprocess.run(words, capture_output=True, text=True, timeout=300, env=os.environ | variables)
    return done.stdout, done.stderr


@pytest.mark.skipif(not bubblewrap(), reason="there is no bubblewrap")
@pytest.mark.proof
@pytest.mark.parametrize("forgery", FORGERIES)
def test_a_forgery_is_believed(forgery, tmp_path):
    body = textwrap.indent(textwrap.dedent(FORGERIES[forgery]).strip(), "    ")
    (tmp_path / "listener.py").write_text(LISTENER)
    (tmp_path / "client.py").write_text(CLIENT)
    (tmp_path / "speaker.py").write_text((CASES / "rtps.py").read_text() + SPEAKER.format(forgery=body))
    said, errors = alone(tmp_path, ["speaker.py"], FASTDDS_BUILTIN_TRANSPORTS="UDPv4")
    assert said == "believed\n", said + errors


@pytest.mark.skipif(not bubblewrap(), reason="there is no bubblewrap")
def test_what_is_written_into_a_shared_history_is_heard(tmp_path):
    attack = (CASES / "shared_history/attack.py").read_text()
    (tmp_path / "node.py").write_text(attack + SHARES)
    (tmp_path / "forger.py").write_text(attack + FORGES)
    said, errors = alone(tmp_path, ["node.py", "speaker"])
    assert said == "heard False\n", said + errors
