"""The picture of a live ROS graph and a live Gazebo graph, as a file and as a page."""

import signal
import threading
import urllib.error
import urllib.request
from xml.etree import ElementTree

import pytest
import rclpy
from std_msgs.msg import String

from gz_course.sim.gz.msgs.stringmsg_pb2 import StringMsg
from gz_course.sim.gz.msgs.world_stats_pb2 import WorldStatistics
from gz_course.sim.gz.transport import Node, NodeOptions
from gz_course.sim.ros.ros2 import interruption
from gz_course.sim.show.rqt_graph.observed import End, picture
from gz_course.sim.show.rqt_graph.page import Page
from gz_course.sim.show.rqt_graph.picture import Box, Picture
from gz_course.sim.show.rqt_graph.rqt_graph import main
from gz_course.sim.show.rqt_graph.svg import svg
from gz_course.tests.sim.ros.ros2.conftest import ros_domain, start  # noqa: F401

ROS = [
    End("/scan", "/ros_gz_bridge", "sensor_msgs/msg/LaserScan", True),
    End("/scan", "/driver", "sensor_msgs/msg/LaserScan", False),
    End("/cmd_vel", "/driver", "geometry_msgs/msg/Twist", True),
    End("/cmd_vel", "/ros_gz_bridge", "geometry_msgs/msg/Twist", False),
    End("/speed", "/driver", "std_msgs/msg/Float64", False),
    End("/rosout", "/driver", "rcl_interfaces/msg/Log", True),
]
GZ = [
    End("/world/w/stats", "server", "gz.msgs.WorldStatistics", True),
    End("/scan", "server", "gz.msgs.LaserScan", True),
    End("/scan", "other", "gz.msgs.LaserScan", False),
    End("/cmd_vell", "other", "gz.msgs.Twist", True),
    End("/imu", "server", "gz.msgs.IMU", True),
]


def test_a_bridge_joins_both_sides():
    made = picture(["/driver", "/ros_gz_bridge", "/alone"], ROS, GZ)
    assert {(box.kind, box.label) for box in made.boxes.values()} == {
        *(("ros node", "/driver"), ("ros node", "/alone"), ("bridge", "/ros_gz_bridge")),
        *(("ros topic", "/scan"), ("ros topic", "/cmd_vel"), ("ros topic", "/speed")),
        *(("gz topic", "/scan"), ("gz topic", "/cmd_vell"), ("gz process", "gz sim: world w")),
    }
    assert ("gz topic:/scan", "bridge:/ros_gz_bridge") in made.arrows
    assert ("bridge:/ros_gz_bridge", "ros topic:/scan") in made.arrows
    assert {box.label: box.fault for box in made.boxes.values() if box.fault} == {
        "/speed": "nobody publishes it",
        "/cmd_vell": "nobody subscribes to it",
    }


def test_everything_shows_more_and_two_types_are_a_fault():
    made = picture(["/driver"], [*ROS, End("/scan", "/b", "std_msgs/msg/String", True)], GZ, everything=True)
    assert {"ros topic:/rosout", "gz topic:/imu"} < made.boxes.keys()
    assert made.boxes["gz topic:/imu"].fault == ""
    assert made.boxes["ros topic:/scan"].fault == "several types: sensor_msgs/msg/LaserScan, std_msgs/msg/String"


def test_a_listener_of_gazebo_is_no_bridge():
    echo = [End("/cmd_vel", "gz topic -e", "", False), End("/scan", "gz topic -e 2", "", False)]
    bridge = [End("/cmd_vel", "other", "gz.msgs.Twist", True), *GZ[:3]]
    made = picture([], ROS, [*echo, *bridge])
    assert {box.label for box in made.boxes.values() if box.kind == "bridge"} == {"/ros_gz_bridge"}
    assert {"Gazebo program 1", "Gazebo program 2"} < {box.label for box in made.boxes.values()}
    renamed = [End(end.topic, end.owner.replace("bridge", "gate"), end.type_name, end.publishes) for end in ROS]
    made = picture([], renamed, [*echo, *bridge])
    assert {box.label for box in made.boxes.values() if box.kind == "bridge"} == {"/ros_gz_gate"}


def test_a_bridge_whose_topics_are_all_renamed_is_known_by_its_name():
    ros = [End("/a", "/my_bridge", "", True), End("/b", "/driver", "", True)]
    made = picture([], ros, [End("/c", "other", "", False), End("/c", "server", "", True)])
    assert "Gazebo program 1" in {box.label for box in made.boxes.values()}  # two processes could be it
    made = picture([], ros, [End("/c", "other", "", False)])
    assert ("gz topic:/c", "bridge:/my_bridge") in made.arrows


def test_hostile_names_are_only_text():
    made = Picture(
        {"a": Box("ros topic", "<script>&", {'"><svg'}), "b": Box("ros node", "/b")}, {("a", "b"), ("b", "a")}
    )
    root = ElementTree.fromstring(svg(made))
    assert "<script>&" in {element.text for element in root.iter()}
    assert len([path for path in root.iter() if path.get("marker-start")]) == 1
    assert "no node and no topic" in svg(Picture())


def test_the_page_gets_each_new_picture():
    with Page() as page:
        page.show("<svg>one</svg>")
        assert "graph.svg?after=" in _get(page.address)
        assert _get(f"{page.address}graph.svg?after=") == "<svg>one</svg>"
        threading.Thread(target=page.show, args=("<svg>two</svg>",)).start()
        assert _get(f"{page.address}graph.svg?after=1") == "<svg>two</svg>"
        with pytest.raises(urllib.error.HTTPError):
            _get(page.address.rsplit("/", 2)[0] + "/")
    assert page.address.startswith("http://127.0.0.1:")


@pytest.fixture
def signals_as_they_are(monkeypatch):
    """Leave the signals and the environment of the test process alone."""
    monkeypatch.setenv("FASTDDS_BUILTIN_TRANSPORTS", "UDPv4")  # as the command sets it
    for name in ("listen", "ignore"):
        monkeypatch.setattr(interruption, name, lambda: None)


def _get(address):
    with urllib.request.urlopen(address, timeout=60) as answer:
        return answer.read().decode()


def test_one_picture_of_what_runs(ros_domain, signals_as_they_are, tmp_path, monkeypatch, capsys):  # noqa: F811
    monkeypatch.setenv("GZ_PARTITION", f"graph_{ros_domain}")
    context = rclpy.Context()
    rclpy.init(context=context, domain_id=ros_domain)
    node = rclpy.create_node("talker", context=context)
    node.create_publisher(String, "/chatter", 10)
    options = NodeOptions()
    options.partition = f"graph_{ros_domain}"
    try:
        with Node(options) as gz:
            gz.advertise("/world/moon/stats", WorldStatistics)
            gz.advertise("/word", StringMsg)
            assert main([f"--svg={tmp_path / 'graph.svg'}", "--all", "--ros-args", "-r", "__node:=x"]) == 0
    finally:
        node.destroy_node()
        context.try_shutdown()
    assert capsys.readouterr().out == f"written: {tmp_path / 'graph.svg'}\n"
    texts = {element.text for element in ElementTree.parse(tmp_path / "graph.svg").iter()}
    assert {"/talker", "/chatter", "std_msgs/msg/String", "gz sim: world moon", "/word", "gz.msgs.StringMsg"} <= texts


def test_a_file_that_cannot_be_written_is_one_sentence(tmp_path, capsys):
    assert main(["--svg", str(tmp_path / "no/graph.svg")], "course graph") == 1
    assert capsys.readouterr().err.endswith("graph.svg cannot be written: there is no such folder\n")


@pytest.mark.proof
def test_the_program_shows_the_graph_until_ctrl_c(ros_domain, start):  # noqa: F811
    environment = {"GZ_PARTITION": f"graph_{ros_domain}", "DISPLAY": "", "WAYLAND_DISPLAY": ""}
    command = start("run", "rqt_graph", "rqt_graph", environment=environment)
    command.wait_for("open this page in a browser: ")
    command.wait_for("Ctrl-C ends it")
    address = command._lines["stdout"][0].split()[-1]
    assert "<svg " in _get(f"{address}graph.svg?after=")
    command.process.send_signal(signal.SIGINT)
    code, _, errors = command.wait()
    assert (code, errors) == (0, "")
