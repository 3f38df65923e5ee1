"""Both graphs as a run records them: names, types, who publishes; and a bridge that hears itself matches nobody."""

import threading
import time

import pytest
import rclpy
from rclpy.context import Context
from std_msgs.msg import Float64, String

from gz_course.grader.kinds.kind import RunPlan
from gz_course.grader.run.domain import Domain
from gz_course.grader.run.fair_clock import FairClock
from gz_course.grader.run.grader_endpoints import GraderEndpoints
from gz_course.grader.run.graph_snapshot import both_graphs
from gz_course.grader.run.pace.matching import can_match
from gz_course.grader.run.processes.progress import Endpoint
from gz_course.grader.run.sandbox import ros_environment
from gz_course.sim.bridge.ros_gz_bridge.entry import BridgeEntry, Direction
from gz_course.sim.gz.msgs.double_pb2 import Double
from gz_course.sim.gz.msgs.stringmsg_pb2 import StringMsg
from gz_course.sim.gz.transport import Node, NodeOptions, Scope

BOTH = BridgeEntry(
    "/words", "/gz/words", "std_msgs/msg/String", "gz.msgs.StringMsg", Direction.BIDIRECTIONAL, source="/x/b.yaml:3"
)
IN = BridgeEntry(
    "/number", "/gz/number", "std_msgs/msg/Float64", "gz.msgs.Double", Direction.GZ_TO_ROS, publisher_queue=1
)
QUICK = BridgeEntry(
    "/quick", "/gz/quick", "std_msgs/msg/Float64", "gz.msgs.Double", Direction.GZ_TO_ROS, qos_profile="SENSOR_DATA"
)


@pytest.fixture
def domain(tmp_path, monkeypatch):
    with Domain() as reserved:
        for key, value in ros_environment(reserved.id, tmp_path).items():
            monkeypatch.setenv(key, value)
        yield reserved.id


@pytest.fixture
def gz(domain):
    """Two Gazebo nodes nobody outside can reach: the simulator's and the bridge's."""
    nodes = [Node(NodeOptions(scope=Scope.PROCESS, partition=f"graphs-{domain}")) for _ in range(2)]
    yield nodes
    for node in nodes:
        node.close()


@pytest.fixture
def ros(domain, gz):
    made = []

    def make(*entries, **parameters):
        made.append(GraderEndpoints(domain, gz[1], list(entries), {}, lambda topic, message: None, **parameters))
        return made[-1]

    yield make
    for each in made:
        each.close()


@pytest.fixture
def other(domain):
    """A ROS node of somebody else."""
    context = Context()
    rclpy.init(args=[], context=context, domain_id=domain)
    yield rclpy.create_node("other", context=context, start_parameter_services=False)
    rclpy.shutdown(context=context)


def test_a_bridge_that_hears_itself_matches_nobody(ros):
    made = ros(BOTH)
    assert (made.matched("/words", "publisher"), made.matched("/words", "subscription")) == (0, 0)


def test_somebody_else_is_matched_beside_a_bridge_that_hears_itself(ros, other):
    made = ros(BOTH)
    other.create_publisher(String, "/words", 10)
    other.create_subscription(String, "/words", lambda message: None, 10)
    pause, end = threading.Event(), time.monotonic() + 120
    while (found := [made.matched("/words", kind) for kind in ("publisher", "subscription")]) != [1, 1]:
        assert time.monotonic() < end, f"matched {found}"
        pause.wait(0.01)


def test_what_is_offered_with_best_effort_is_known(ros):
    made = ros(IN, QUICK)
    assert (made.reliable("/number"), made.reliable("/quick"), made.reliable("/elsewhere")) == (True, False, True)


def test_who_asks_for_reliable_delivery_is_not_waited_for_where_none_is_offered(ros):
    made = ros(IN, QUICK)

    def listener(topic, reliability):
        return Endpoint("/n", "subscription", topic, "std_msgs/msg/Float64", reliability, "VOLATILE", 0)

    assert can_match(listener("/number", "RELIABLE"), made)
    assert can_match(listener("/quick", "BEST_EFFORT"), made)
    assert not can_match(listener("/quick", "RELIABLE"), made)


def test_what_the_bridge_keeps_for_late_subscriptions_is_known(ros):
    name = f"qos_overrides.{IN.ros_topic}.publisher.durability"
    made = ros(IN, QUICK, parameters={name: "transient_local"})

    def listener(topic):
        return Endpoint("/n", "subscription", topic, "std_msgs/msg/Float64", "RELIABLE", "TRANSIENT_LOCAL", 0)

    assert (made.keeps(IN.ros_topic), made.keeps("/quick"), made.keeps("/elsewhere")) == (IN.publisher_queue, 0, 0)
    assert can_match(listener(IN.ros_topic), made) and not can_match(listener("/quick"), made)
    assert RunPlan("n.py", {}, [IN, QUICK], {}, {name: "transient_local"}).kept == {IN.ros_topic: IN.ros_type}
    assert RunPlan("n.py", {}, [IN, QUICK]).kept == {}


def test_both_graphs(ros, gz, other):
    sensor = gz[0].advertise("/gz/number", Double)
    gz[0].subscribe(StringMsg, "/gz/words", lambda message: None)
    made = ros(BOTH, IN)
    other.create_subscription(Float64, "/number", lambda message: None, 10)
    sensor.publish(Double(data=2.0))

    facts = both_graphs(gz[1], made, FairClock(list))
    assert facts["gz_topics"]["/gz/number"] == {
        "types": ["gz.msgs.Double"],
        "publishers": ["gz sim"],
        "subscribers": ["ros_gz_bridge"],
    }
    assert facts["gz_topics"]["/gz/words"] == {
        "types": ["gz.msgs.StringMsg"],
        "publishers": ["ros_gz_bridge"],
        "subscribers": ["gz sim", "ros_gz_bridge"],
    }
    assert set(facts["ros_topics"]) == {"/words", "/number"}
    assert facts["ros_topics"]["/words"]["publishers"] == ["ros_gz_bridge"]
    both, number = facts["bridges"]
    assert (both["source"], both["direction"], both["to_ros"], both["to_gz"]) == ("b.yaml:3", "BIDIRECTIONAL", 0, 0)
    assert (number["to_ros"], number["publisher_qos"]["depth"], number["subscription_qos"]) == (1, 1, None)
