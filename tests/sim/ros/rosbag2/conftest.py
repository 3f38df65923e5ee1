"""Two ROS contexts of this process in a domain of its own, as a program and a recorder are two processes."""

import time

import pytest

from gz_course.grader.run.domain import Domain

DEADLINE = 120.0


class Nodes:
    """A node that records or plays, and one of somebody else; both are spun by `until`."""

    def __init__(self, domain):
        import rclpy
        from rclpy.executors import SingleThreadedExecutor

        self._contexts = [rclpy.Context(), rclpy.Context()]
        self._executors = []
        nodes = []
        for context, name in zip(self._contexts, ("rosbag2", "other"), strict=True):
            rclpy.init(context=context, domain_id=domain)
            nodes.append(rclpy.create_node(name, context=context, start_parameter_services=False))
            self._executors.append(SingleThreadedExecutor(context=context))
            self._executors[-1].add_node(nodes[-1])
        self.own, self.other = nodes

    def until(self, condition, meanwhile=lambda: None):
        """Run the callbacks of both nodes until a condition holds."""
        end = time.monotonic() + DEADLINE
        while not condition():
            assert time.monotonic() < end, "not in time"
            meanwhile()
            for executor in self._executors:
                executor.spin_once(timeout_sec=0.005)

    def close(self):
        for executor, node, context in zip(self._executors, (self.own, self.other), self._contexts, strict=True):
            executor.shutdown()
            node.destroy_node()
            context.try_shutdown()


@pytest.fixture(scope="module")
def nodes():
    with Domain() as domain, pytest.MonkeyPatch.context() as patch:
        patch.setenv("ROS_AUTOMATIC_DISCOVERY_RANGE", "LOCALHOST")
        patch.setenv("FASTDDS_BUILTIN_TRANSPORTS", "UDPv4")
        made = Nodes(domain.id)
        yield made
        made.close()
