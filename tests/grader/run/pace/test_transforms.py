"""A node that looks up transforms gets the same answer each time, also if it has to wait for them, or comes late."""

import pytest

ROBOT = """
from geometry_msgs.msg import TransformStamped
from tf2_ros import StaticTransformBroadcaster, TransformBroadcaster

static, moving = StaticTransformBroadcaster(node), TransformBroadcaster(node)

def transform(parent, child, x):
    made = TransformStamped(child_frame_id=child)
    made.header.frame_id = parent
    made.header.stamp = node.get_clock().now().to_msg()
    made.transform.translation.x = x
    return made

def move():
    moving.sendTransform(transform("map", "base", node.get_clock().now().nanoseconds / 1e9))

static.sendTransform(transform("base", "lidar", 100.0))
node.create_timer(0.2, move)
rclpy.spin(node)
"""
LOOKER = """
import threading
import time
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.duration import Duration
from rclpy.executors import MultiThreadedExecutor
from rclpy.time import Time
from tf2_ros import Buffer, TransformException, TransformListener

buffer = Buffer()
listener = TransformListener(buffer, node)
said = node.create_publisher(String, "/said", 10)

def look(who, ago, timeout):
    now = node.get_clock().now()
    began = time.monotonic()
    try:
        then = Time(nanoseconds=max(1, now.nanoseconds - ago.nanoseconds))
        found = buffer.lookup_transform("map", "lidar", then, timeout)
        text = f"{found.transform.translation.x:.3f}"
    except TransformException as error:
        text = type(error).__name__
    said.publish(String(data=f"{who} {now.nanoseconds / 1e9:.1f}: {text} after {time.monotonic() - began:.3f}"))

def in_a_thread():
    while True:
        time.sleep(0.35)
        look("thread", Duration(), Duration(seconds=0.5))

def in_a_callback():
    look("callback", Duration(), Duration(seconds=0.5))

async def in_a_coroutine():
    now = node.get_clock().now()
    found = await buffer.lookup_transform_async("map", "lidar", now)
    came = (node.get_clock().now() - now).nanoseconds / 1e9
    text = f"coroutine {now.nanoseconds / 1e9:.1f}: {found.transform.translation.x:.3f} after {came:.3f}"
    said.publish(String(data=text))

threading.Thread(target=in_a_thread, daemon=True).start()
node.create_timer(0.1, lambda: look("timer", Duration(seconds=0.3), Duration()))
node.create_timer(0.35, in_a_callback, callback_group=ReentrantCallbackGroup())
node.create_timer(0.3, in_a_coroutine, callback_group=ReentrantCallbackGroup())
executor = MultiThreadedExecutor(4)
executor.add_node(node)
executor.spin()
"""


def test_every_lookup_finds_the_same_each_time(play):
    runs = [play(ticks=20, simulated=True, robot=ROBOT, looker=LOOKER) for _ in range(2)]
    for played in runs:
        assert played.pace.paced_ticks == 0, played.lines
    first, second = ([words for words in map(str.split, run.heard)] for run in runs)
    assert first == second
    found = [words for words in first if "Exception" not in words[2]]
    assert {words[0] for words in found} == {"timer", "thread", "callback", "coroutine"}, runs[0].heard
    assert len([words for words in found if words[0] == "timer"]) > 10, runs[0].heard
    # Between two transforms, 0.2 s apart, of x = t; the static one adds 100 m.
    for who, then, x, _, took in found:
        ago = 0.3 if who == "timer" else 0.0
        assert float(x) == round(float(then[:-1]) - ago + 100.0, 3), runs[0].heard
        assert took == "0.000" if who == "timer" else float(took) <= 0.5


LATE = """
from rclpy.qos import DurabilityPolicy, QoSProfile

said = node.create_publisher(String, "/said", 100)
asked = QoSProfile(depth=100, durability=DurabilityPolicy.TRANSIENT_LOCAL)

def hear(number):
    said.publish(String(data=f"{node.get_clock().now().nanoseconds / 1e9:.1f} {number.data}"))

def come():
    once.cancel()
    node.late = node.create_subscription(Int32, "/kept", hear, asked)

once = node.create_timer(0.5, come)
rclpy.spin(node)
"""


@pytest.mark.proof
def test_what_a_bridge_keeps_is_heard_at_once_by_those_who_come_late(play):
    for holding in (True, False):
        played = play(ticks=14, kept=True, holding=holding, late=LATE)
        assert played.pace.paced_ticks == 0, played.lines
        heard = [(float(time), int(number)) for time, number in map(str.split, played.heard)]
        assert [number for _, number in heard] == list(range(1, 15))
        came = heard[0][0]
        assert heard == [(max(came, number / 10), number) for number in range(1, 15)]
