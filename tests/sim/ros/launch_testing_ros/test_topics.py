"""Topics are waited for, messages changed on their way, over DDS in a domain of its own."""

import pytest
import rclpy
from std_msgs.msg import String

from gz_course.grader.run.domain import Domain
from gz_course.sim.ros.launch_testing_ros import DataRepublisher, MessagePump, WaitForTopics
from gz_course.sim.ros.launch_testing_ros.tools import basic_output_filter


@pytest.fixture
def node(monkeypatch):
    monkeypatch.setenv("ROS_AUTOMATIC_DISCOVERY_RANGE", "LOCALHOST")
    monkeypatch.setenv("FASTDDS_BUILTIN_TRANSPORTS", "UDPv4")
    with Domain() as domain:
        monkeypatch.setenv("ROS_DOMAIN_ID", str(domain.id))
        context = rclpy.Context()
        rclpy.init(context=context, domain_id=domain.id)
        node = rclpy.create_node("talker", context=context)
        yield node
        node.destroy_node()
        rclpy.shutdown(context=context)


def test_what_comes_and_what_does_not(node):
    publisher = node.create_publisher(String, "chatter", 10)
    node.create_timer(0.01, lambda: publisher.publish(String(data="hello")))
    louder = DataRepublisher(node, "chatter", "loud", String, lambda message: String(data=message.data.upper()))
    asked = []
    with MessagePump(node, context=node.context):
        topics = [("chatter", String), ("loud", String)]
        with WaitForTopics(topics, timeout=60.0, messages_received_buffer_length=2, trigger=asked.append) as waited:
            assert waited.topics_received() == {"chatter", "loud"} and waited.topics_not_received() == set()
            assert waited.wait()
            assert waited.received_messages("loud")[0].data == "HELLO"
            assert 1 <= len(waited.received_messages("chatter")) <= 2
            with pytest.raises(KeyError, match="No topic named quiet"):
                waited.received_messages("quiet")
        with pytest.raises(RuntimeError, match=r"Did not receive messages on these topics.*quiet"):
            WaitForTopics([("quiet", String)], timeout=0.0).__enter__()
    assert len(asked) == 2 and louder.get_num_received() == louder.get_num_republished() > 0
    louder.shutdown()


def test_lines_are_dropped():
    keep = basic_output_filter(filtered_patterns=[".*noise"], filtered_rmw_implementation="rmw_fastrtps_cpp")
    assert keep("pid 1\nkept\nsome noise\n") == "kept\n"
