"""Pictures and clouds, dozens of UDP packets each, reach best-effort subscriptions whole, and grading stays in step."""

import shutil
import struct
import textwrap
import time
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import pytest

from gz_course.grader.record.reading import Recording
from gz_course.grader.run.agent.course_agent.inbox import is_copy
from gz_course.grader.run.pace import lockstep
from gz_course.grader.run.processes.progress import Progress
from gz_course.grader.run.sandbox import environment

# The kernel bounds how much a socket holds, and less than a picture is usual. Here it is a packet or two.
SMALL_SOCKETS = """
import pathlib
from gz_course.grader.run.sandbox import environment
environment.PROFILES = pathlib.Path({profiles!r})
"""
ROOM, PICTURE = Path("/proc/sys/net/core/rmem_max"), 640 * 480 * 3  # [bytes]
# A copy follows a large message at once, whether it is needed or not.
ALWAYS_AGAIN = """
from gz_course.grader.run.pace import lockstep
lockstep.LOST = 0.0
"""
CAMERA = "<horizontal_fov>1.2</horizontal_fov><image><width>{}</width><height>{}</height></image>"
SENSORS = {
    "camera": ("camera", f"<camera>{CAMERA.format(640, 480)}<clip><near>0.1</near><far>30</far></clip></camera>"),
    "cloud": (
        "gpu_lidar",
        """<lidar>
          <scan>
            <horizontal><samples>640</samples><min_angle>-3.14</min_angle><max_angle>3.14</max_angle></horizontal>
            <vertical><samples>16</samples><min_angle>-0.26</min_angle><max_angle>0.26</max_angle></vertical>
          </scan>
          <range><min>0.1</min><max>20</max></range>
        </lidar>""",
    ),
}
WORLD = """
<sdf version="1.10"><world name="studio">
  <plugin filename="gz-sim-physics-system" name="gz::sim::systems::Physics"/>
  <plugin filename="gz-sim-sensors-system" name="gz::sim::systems::Sensors"/>
  <include><uri>model://sun</uri></include>
  <model name="wall">
    <static>true</static><pose>3 0 0 0 0 0</pose>
    <link name="link">
      <collision name="box"><geometry><box><size>0.1 1 1</size></box></geometry></collision>
      <visual name="box">
        <geometry><box><size>0.1 1 1</size></box></geometry><material><diffuse>0.9 0.3 0.1 1</diffuse></material>
      </visual>
    </link>
  </model>
  <model name="robot">
    <link name="base"><gravity>false</gravity>
      <collision name="ball"><geometry><sphere><radius>0.05</radius></sphere></geometry></collision>
      {sensors}
    </link>
    <plugin filename="gz-sim-velocity-control-system" name="gz::sim::systems::VelocityControl"/>
  </model>
</world></sdf>
"""
SENSOR = (
    '<sensor name="{name}" type="{type}"><topic>{name}</topic><update_rate>5</update_rate>'
    "<always_on>1</always_on>{what}</sensor>"
)
BRIDGE = """
- {topic_name: /clock, ros_type_name: rosgraph_msgs/msg/Clock, gz_type_name: gz.msgs.Clock, direction: GZ_TO_ROS}
- {topic_name: /camera, ros_type_name: sensor_msgs/msg/Image, gz_type_name: gz.msgs.Image, direction: GZ_TO_ROS}
- {topic_name: /cloud/points, ros_type_name: sensor_msgs/msg/PointCloud2, gz_type_name: gz.msgs.PointCloudPacked,
   direction: GZ_TO_ROS}
- {ros_topic_name: /cmd_vel, gz_topic_name: /model/robot/cmd_vel, ros_type_name: geometry_msgs/msg/Twist,
   gz_type_name: gz.msgs.Twist, direction: ROS_TO_GZ}
"""
FRAMES = 6  # at 0, 0.2, ... 1.0 s
MANIFEST = """
file = "look.py"
[run]
world = {world!r}
robot = "robot"
bridge = "bridge.yaml"
duration = 1.0
observe = {{ "/seen" = "std_msgs/msg/Int32", "/felt" = "std_msgs/msg/Int32" }}
[[check]]
id = "pictures"
title = "Sees every picture"
points = 50
kind = "count"
signal = "topics/seen/data"
low = 1
count = [{frames}, {frames}]
hint = "-"
[[check]]
id = "clouds"
title = "Feels every cloud"
points = 50
kind = "count"
signal = "topics/felt/data"
low = 1
count = [{frames}, {frames}]
hint = "-"
"""
LOOK = """
import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node
from rclpy.qos import qos_profile_sensor_data
from sensor_msgs.msg import Image, PointCloud2
from std_msgs.msg import Int32

rclpy.init()
node = Node("look")
cmd_vel, seen, felt = (
    node.create_publisher(kind, topic, 10) for kind, topic in ((Twist, "cmd_vel"), (Int32, "seen"), (Int32, "felt"))
)
own = node.create_publisher(Int32, "own", qos_profile_sensor_data)
heard = []
node.create_subscription(Int32, "own", heard.append, 10)  # reliable: it must not match

def look(image):
    cmd_vel.publish(Twist())
    own.publish(Int32())
    twist = Twist()
    twist.linear.x = image.data[240 * image.step + 960] / 1000
    cmd_vel.publish(twist)
    seen.publish(Int32(data=sum(image.data) % 10**6 + 1 if not heard else 0))

def feel(cloud):
    felt.publish(Int32(data=len(cloud.data)))

pictures = node.create_subscription(Image, "camera", look, qos_profile_sensor_data)
node.create_subscription(PointCloud2, "cloud/points", feel, qos_profile_sensor_data)
assert pictures.qos_profile.reliability == qos_profile_sensor_data.reliability
rclpy.spin(node)
"""


@pytest.fixture
def course_folder(tmp_path):
    """A course with one exercise; the submission lies beside it."""
    exercise = tmp_path / "course" / "exercises" / "01_look"
    exercise.mkdir(parents=True)
    sensors = "".join(SENSOR.format(name=name, type=type, what=what) for name, (type, what) in SENSORS.items())
    (exercise / "studio.sdf").write_text(WORLD.format(sensors=sensors))
    (exercise / "bridge.yaml").write_text(BRIDGE)
    (exercise / "look.py").write_text("")
    (exercise / "grading").mkdir()
    (exercise / "README.md").write_text("# Look\n\nLook.\n")
    (exercise / "grading/exercise.toml").write_text(MANIFEST.format(world=str(exercise / "studio.sdf"), frames=FRAMES))
    (tmp_path / "look.py").write_text(textwrap.dedent(LOOK))
    return tmp_path / "course"


@pytest.mark.proof
def test_nothing_large_is_lost_however_little_the_sockets_hold(course_folder, grading, clean, tmp_path):
    profiles = tmp_path / "profiles"
    shutil.copytree(environment.PROFILES, profiles)
    for profile in profiles.glob("*.xml"):
        given = profile.read_text()
        profile.write_text(given.replace("16777216", "100000"))
        assert profile.read_text() != given
    submission, variables = tmp_path / "look.py", {"COURSE_ROOT": str(course_folder)}
    reliable = (bridge := course_folder / "exercises/01_look/bridge.yaml").read_text()
    if int(ROOM.read_text()) > 2 * PICTURE:  # then not even a best-effort publisher loses anything
        bridge.write_text(reliable.replace("gz.msgs.Image,", "gz.msgs.Image, qos_profile: SENSOR_DATA,"))
    plain = grading(tmp_path / "plain", "01", submission, prelude=ALWAYS_AGAIN, **variables)
    bridge.write_text(reliable)
    small = SMALL_SOCKETS.format(profiles=str(profiles))
    narrow = grading(tmp_path / "narrow", "01", submission, "--sandbox", "D", prelude=small, **variables)
    for outcome in (plain, narrow):
        clean(outcome)
        assert outcome.code == 0, outcome.output
        assert outcome.report["pace"] == "lockstep"
    assert plain.report["truth_sha256"] == narrow.report["truth_sha256"]
    # What the student's node asked for is what is judged, not how it is delivered.
    asked = {e["topic"]: e["reliability"] for e in Recording(narrow.recording).facts()["endpoints"]}
    assert asked["/camera"] == asked["/cloud/points"] == "BEST_EFFORT"


class Listener:
    """A process of the submission that takes a picture only when it was sent often enough."""

    gone = starting = waiting_for_release = wants_answer = waits_for_log = False
    logged = 0
    progress = Progress(clock=1)

    def __init__(self):
        self.told = []

    def tell(self, order):
        self.told.append(order)

    def answer(self):
        again = frozenset(order["again"] for order in self.told if "again" in order)
        self.progress = replace(self.progress, again=again)


@pytest.fixture
def sending(monkeypatch):
    """Send a message to a listener that gets only the last of `sendings`; how it went."""
    monkeypatch.setattr(lockstep, "LOST", 0.0)
    monkeypatch.setattr(lockstep, "PATIENCE", 0.2)

    def call(sendings, large=True):
        listener, sent = Listener(), []

        def publish(message):
            assert not sent or listener.progress.again == {"/camera"}, "a copy came unannounced"
            sent.append(message)
            if len(sent) == sendings:
                listener.progress = replace(listener.progress, taken={"/camera": 1})

        student = SimpleNamespace(
            clock=(clock := SimpleNamespace(now=time.monotonic, delayed=lambda: 0.0)), clock_but_mine=clock,
            running=True, starting=False, layout=(1,), endpoints=(), participants=[listener], followed=[listener],
            wait=lambda seconds: listener.answer(),
        )  # fmt: skip
        ros = SimpleNamespace(
            received={}, pump=lambda: None, listens=lambda topic: None, matched=lambda topic, kind: 1,
            is_large=lambda message: large, keeps=lambda topic: 0, offered={},
        )  # fmt: skip
        pace = lockstep.LockStep(student, ros)
        pace._layout, pace._participants = student.layout, [listener]
        pace.send("/camera", SimpleNamespace(publish=publish), "picture", 1)
        pace.settle()
        pace.close_tick(0.001)
        return SimpleNamespace(sent=sent, told=listener.told, pace=pace)

    return call


def test_a_lost_picture_is_announced_and_sent_again_until_it_is_taken(sending):
    sent = sending(4)
    assert sent.sent == ["picture"] * 4
    assert {"again": "/camera"} in sent.told
    assert sent.pace.paced_ticks == 0, "the network was slow, not the student"


def test_a_small_message_that_is_not_taken_is_not_lost_but_left(sending):
    sent = sending(2, large=False)
    assert sent.sent == ["picture"]
    assert (sent.told[:1], sent.pace.paced_ticks) == ([{"free": True}], 1)


def test_a_picture_that_never_gets_through_is_given_up(sending, monkeypatch):
    monkeypatch.setattr(lockstep, "LOST_PATIENCE", 0.3)
    sent = sending(0)
    assert len(sent.sent) > 2
    assert sent.pace.paced_ticks == 1


@pytest.mark.parametrize("raw", [False, True])
def test_a_copy_has_the_stamp_of_the_one_before(raw):
    camera, other = (SimpleNamespace(msg_type=SimpleNamespace(header=None)) for _ in range(2))

    def picture(nanosec):
        if raw:
            return b"\0\1\0\0" + struct.pack("<iI", 7, nanosec) + b"frame and pixels"
        return SimpleNamespace(header=SimpleNamespace(stamp=SimpleNamespace(sec=7, nanosec=nanosec)))

    asked = [(camera, 1), (camera, 1), (other, 1), (camera, 2), (camera, 2), (camera, 2), (camera, 3)]
    assert [is_copy(who, picture(stamp)) for who, stamp in asked] == [
        False,
        True,
        False,
        False,
        True,
        True,
        False,
    ]


def test_what_has_no_stamp_is_never_a_copy():
    number = SimpleNamespace(msg_type=SimpleNamespace)
    assert not any(is_copy(number, 5) for _ in range(2))
