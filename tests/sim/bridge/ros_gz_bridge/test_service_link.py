"""A Gazebo service is called through ROS; failures are answered and logged, and topics are bridged meanwhile."""

import threading
import uuid

import pytest
from geometry_msgs.msg import Twist
from std_srvs.srv import SetBool

from gz_course.sim.bridge.ros_gz_bridge import type_pairs
from gz_course.sim.bridge.ros_gz_bridge.bridge import Bridge
from gz_course.sim.bridge.ros_gz_bridge.config import ConfigError, read_yaml
from gz_course.sim.bridge.ros_gz_bridge.entry import BridgeEntry, BridgeError, Direction, ServiceEntry
from gz_course.sim.gz.msgs.boolean_pb2 import Boolean
from gz_course.sim.gz.msgs.stringmsg_pb2 import StringMsg
from gz_course.sim.gz.msgs.twist_pb2 import Twist as GzTwist
from gz_course.sim.gz.transport import Node, NodeOptions, Scope
from gz_course.tests.sim.bridge.ros_gz_bridge.reading import parse_argument, parse_yaml

TYPES = ("std_srvs/srv/SetBool", "gz.msgs.Boolean", "gz.msgs.StringMsg")
DEADLINE = 120.0


@pytest.fixture(autouse=True)
def set_bool(monkeypatch):
    """Add a pair for tests, because the services of Gazebo's own bridge need packages that may be absent."""
    monkeypatch.setattr(type_pairs, "_services", dict(type_pairs._services))
    type_pairs.add_service(
        *TYPES,
        request_to_gz=lambda request: Boolean(data=request.data),
        reply_to_ros=lambda reply: SetBool.Response(success=True, message=reply.data),
        fault=lambda request: None,
    )


@pytest.fixture
def stage(ros):
    node, name = ros.new_node(), f"/s{uuid.uuid4().hex}"
    options = NodeOptions(partition=uuid.uuid4().hex, scope=Scope.PROCESS)
    client = ros.node.create_client(SetBool, name)

    def call(value):
        assert client.wait_for_service(DEADLINE)
        answered = threading.Event()
        future = client.call_async(SetBool.Request(data=value))
        future.add_done_callback(lambda _: answered.set())
        assert answered.wait(DEADLINE)
        return future.result()

    with Node(options) as own, Node(options) as gazebo:
        yield node, own, gazebo, ServiceEntry(name, *TYPES, "b.yaml:1"), call
    ros.node.destroy_client(client)
    ros.drop_node(node)


def test_a_call_goes_to_gazebo_and_its_reply_comes_back(stage):
    node, own, gazebo, entry, call = stage
    asked = []
    gazebo.advertise_service(
        entry.name, Boolean, StringMsg, lambda r: (asked.append(r.data), StringMsg(data="done"))[1]
    )
    with Bridge(node, own, [], services=[entry]):
        replies = [call(True), call(False)]
        assert [(reply.success, reply.message) for reply in replies] == [(True, "done")] * 2
        assert asked == [True, False]
    assert not [each for each in node.services if each.srv_name == entry.name]


def test_a_service_that_fails_or_is_absent_is_answered_and_explained(stage, capfd):
    node, own, gazebo, entry, call = stage
    gazebo.advertise_service(f"{entry.name}s", Boolean, StringMsg, lambda request: StringMsg())
    with Bridge(node, own, [], services=[entry]):
        assert call(True).success is False
        gazebo.advertise_service(entry.name, Boolean, Boolean, lambda request: request)
        assert call(True).success is False
        gazebo.unadvertise_service(entry.name)
        gazebo.advertise_service(entry.name, Boolean, StringMsg, lambda request: (False, StringMsg()))
        assert call(True).success is False
    warnings = [line for line in capfd.readouterr().err.splitlines() if "[WARN]" in line]
    assert len(warnings) == 3
    assert f"offers no service {entry.name}; did you mean '{entry.name}s'?" in warnings[0]
    assert "with gz.msgs.Boolean and gz.msgs.Boolean, not with gz.msgs.Boolean and gz.msgs.StringMsg" in warnings[1]
    assert "Gazebo could not do what was asked" in warnings[2]


def test_topics_go_on_while_gazebo_thinks(stage, ros, inbox, eventually):
    node, own, gazebo, entry, call = stage
    asked, let_go, commands = threading.Event(), threading.Event(), inbox()

    def think(request):
        asked.set()
        assert let_go.wait(DEADLINE)
        return StringMsg(data="at last")

    gazebo.advertise_service(entry.name, Boolean, StringMsg, think)
    gazebo.subscribe(GzTwist, f"{entry.name}/cmd", commands)
    topic = f"{entry.name}/cmd"
    command = BridgeEntry(topic, topic, "geometry_msgs/msg/Twist", "gz.msgs.Twist", Direction.ROS_TO_GZ)
    replies = []
    with Bridge(node, own, [command], services=[entry]):
        caller = threading.Thread(target=lambda: replies.append(call(True)))
        caller.start()
        assert asked.wait(DEADLINE)
        publisher = ros.node.create_publisher(Twist, topic, 10)
        eventually(publisher.get_subscription_count, "the bridge listens")
        publisher.publish(Twist())
        commands.wait(1)
        assert replies == []
        let_go.set()
        caller.join(DEADLINE)
        ros.node.destroy_publisher(publisher)
    assert replies[0].message == "at last"


def test_a_service_nobody_can_convert_is_an_error(stage):
    node, own, _, _, _ = stage
    wrong = ServiceEntry("/s", "std_srvs/srv/SetBool", "gz.msgs.Twist", "gz.msgs.Boolean", "b.yaml:3")
    with pytest.raises(BridgeError, match=r"b\.yaml:3: the service std_srvs/srv/SetBool does not go with"):
        Bridge(node, own, [], services=[wrong])


YAML = """\
- service_name: /world/w/set
  ros_type_name: std_srvs/srv/SetBool
  gz_req_type_name: gz.msgs.Boolean
  gz_rep_type_name: gz.msgs.StringMsg
"""


def test_services_are_read_from_a_file_and_from_arguments():
    config = read_yaml(YAML, "b.yaml")
    assert config.services == [ServiceEntry("/world/w/set", *TYPES, "b.yaml:1")]
    assert config.findings == []
    for text in (f"/world/w/set@{TYPES[0]}", "@".join(["/world/w/set", *TYPES])):
        assert parse_argument(text) == ServiceEntry("/world/w/set", *TYPES, f"argument '{text}'")


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (YAML.replace("service_name", "topic_name"), "b.yaml:1: 'service_name' is missing"),
        (YAML + "  direction: GZ_TO_ROS\n", "b.yaml:5: 'direction' is for a topic, but this entry is a service"),
        (YAML.replace("gz.msgs.StringMsg", "gz.msgs.Twist"), "b.yaml:2: the service std_srvs/srv/SetBool does not go"),
        (YAML + YAML, "b.yaml:5: offers /world/w/set again (first: b.yaml:1)"),
    ],
)
def test_each_fault_of_a_service(text, words):
    assert any(str(finding).startswith(words) for finding in read_yaml(text, "b.yaml").findings)


def test_who_wants_topics_only_is_told_of_a_service():
    with pytest.raises(ConfigError, match=r"b\.yaml:1: /world/w/set is a service; only topics can be bridged here"):
        parse_yaml(YAML, "b.yaml")
