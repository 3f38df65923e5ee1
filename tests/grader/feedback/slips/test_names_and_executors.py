"""Variables meant for the module, executors that are passed over, locks taken twice, orders of Euler angles."""

import pytest

from gz_course.grader.feedback.slips import slips

GLOBAL = """\
busy = False

def check(goal):
    return not busy

def execute(handle):
    global busy
    busy = True
"""
SPIN = """\
def main():
    node = Server()
    executor = MultiThreadedExecutor()
    executor.add_node(node)
    executor.spin()

main()
"""
EULER = """\
def on_odometry(message):
    q = message.pose.pose.orientation
    roll, pitch, yaw = euler_from_quaternion([q.x, q.y, q.z, q.w])
    return yaw
"""
LOCK = """\
class Server(Node):
    def __init__(self):
        self.lock = threading.RLock()

    def place(self):
        with self.lock:
            return self.pose

    def execute(self, handle):
        with self.lock:
            print(self.place())
"""
LOOP = """\
def drive_to(handle, point):
    left = distance(point)
    while left > 0.1:
        if handle.is_cancel_requested:
            return False
        step(point)
        left = distance(point)
    return True
"""


def said(source):
    return " ".join(each["said"] for each in slips(source.encode()))


OTHER_RECEIVE = """\
class Inlet(Node):
    def __init__(self):
        self.lock = Lock()

    def receive(self):
        receive = self.socket.recv
        with self.lock:
            return receive()
"""


@pytest.mark.parametrize("source", [GLOBAL, SPIN, EULER, LOCK, LOOP, OTHER_RECEIVE])
def test_right_code_has_none(source):
    assert slips(source.encode()) == []


@pytest.mark.parametrize(
    ("source", "old", "new", "words"),
    [
        (GLOBAL, "    global busy\n", "", "write `global busy` first in execute"),
        (SPIN, "executor.spin()", "rclpy.spin(node)", "the call is executor.spin()"),
        (EULER, "roll, pitch, yaw", "yaw, pitch, roll", "yaw gets the roll"),
        (EULER, "q.x, q.y, q.z, q.w", "q.w, q.x, q.y, q.z", "takes x, y, z, w in this order"),
        (LOOP, "        left = distance(point)\n", "", "nothing in this loop changes left, which line 2"),
        (LOCK, "RLock", "Lock", "self.place() takes self.lock, which line 10 holds already"),
        ("turn = math.atan(dy / dx)\n", "", "", "atan2(dy, dx)"),
        ("def execute(handle):\n    handle.succeed\n", "", "", "does not call it"),
    ],
)
def test_wrong_code_is_named(source, old, new, words):
    assert words in said(source.replace(old, new))


def test_a_variable_that_is_also_read_or_passed_is_no_slip():
    assert said(GLOBAL.replace("    global busy\n    busy = True\n", "    busy = True\n    return busy\n")) == ""
    assert said(SPIN.replace("executor.spin()", "rclpy.spin(node, executor)")) == ""
    own = "def euler_from_quaternion(q):\n    return 0, 0, 0\n\n" + EULER.replace("roll, pitch, yaw", "yaw, a, b")
    assert said(own) == ""
