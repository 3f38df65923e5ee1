"""The parameter `bridged_topics` can be read back and describes the real bridges."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from gz_course.sim.bridge.ros_gz_bridge import bridged_topics
from gz_course.sim.bridge.ros_gz_bridge.entry import BridgeEntry, Direction

NAMES = st.text(min_size=1, max_size=30)
ENTRIES = st.builds(BridgeEntry, NAMES, NAMES, NAMES, NAMES, direction=st.sampled_from(Direction), lazy=st.booleans())


class Node:
    """A minimal substitute for a node: names are not changed, one parameter is stored."""

    def __init__(self):
        self.offered = None

    def resolve_topic_name(self, name):
        return name

    def has_parameter(self, name):
        return self.offered is not None

    def declare_parameter(self, name, kind):
        assert self.offered is None
        self.offered = []

    def set_parameters(self, parameters):
        self.offered = list(parameters[0].value)


@given(entries=st.lists(ENTRIES, max_size=4), later=st.lists(ENTRIES, max_size=2))
def test_entries_are_read_back(entries, later):
    node = Node()
    bridged_topics.offer(node, entries)
    assert bridged_topics.entries(node.offered) == entries
    bridged_topics.offer(node, later)
    assert bridged_topics.entries(node.offered) == later


@pytest.mark.parametrize(
    "text", ["", "[]", "{ros_topic_name: /a}", "{", "x: {y: 1", "{direction: UP}", "null", "5", "- a"]
)
def test_a_text_that_is_no_entry(text):
    with pytest.raises(ValueError, match="is no entry of a bridge"):
        bridged_topics.entries([text])


def test_topics_are_told_as_they_are_after_remapping(ros):
    import rclpy

    node = rclpy.create_node("offering", context=ros.context, cli_args=["--ros-args", "-r", "/in:=/robot/in"])
    try:
        entry = BridgeEntry("in", "/gz", "std_msgs/msg/Bool", "gz.msgs.Boolean")
        bridged_topics.offer(node, [entry])
        (told,) = bridged_topics.entries(node.get_parameter(bridged_topics.PARAMETER).value)
        assert (told.ros_topic, told.gz_topic) == ("/robot/in", "/gz")
    finally:
        node.destroy_node()
