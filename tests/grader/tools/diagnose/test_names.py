"""DDS tells an endpoint before it tells the name of its node."""

from types import SimpleNamespace

import pytest

from gz_course.grader.tools.diagnose import ros_side
from gz_course.sim.ros.ros2.graph import UNKNOWN_NODE


class Graph:
    """One subscription on /scan whose node is known from the look number `named` on."""

    def __init__(self, named):
        self.named, self.looks = named, 0
        self.node = self

    def get_fully_qualified_name(self):
        return "/own"

    def topics(self, hidden):
        return [("/scan", ["sensor_msgs/msg/LaserScan"])]

    def get_publishers_info_by_topic(self, topic):
        return []

    def get_subscriptions_info_by_topic(self, topic):
        name, space = ("listener", "/") if self.looks >= self.named else (UNKNOWN_NODE, "_NODE_NAMESPACE_UNKNOWN_")
        return [SimpleNamespace(node_name=name, node_namespace=space, topic_type="t", qos_profile=None)]

    def spin_once(self, timeout):
        self.looks += 1


@pytest.mark.parametrize(("named", "node"), [(0, "/listener"), (7, "/listener"), (10**9, ros_side.UNNAMED)])
def test_the_name_is_waited_for_but_not_for_ever(monkeypatch, named, node):
    graph = Graph(named)
    now = SimpleNamespace(monotonic=lambda: graph.looks * ros_side.LOOK_AGAIN)
    monkeypatch.setattr(ros_side, "time", now)
    assert [end.node for end in ros_side._named_endpoints(graph)] == [node]
    assert graph.looks <= min(named, ros_side.NAMES / ros_side.LOOK_AGAIN + 2)
