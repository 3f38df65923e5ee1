"""A Gazebo service offered as a ROS service.

`bridge.Bridge` makes one link for each service entry. The call to Gazebo waits in a thread of the link, so that topics
are bridged in the meantime; one thread is enough, because Gazebo answers the calls of a service one at a time.
"""

from __future__ import annotations

import concurrent.futures
import contextlib
from typing import Any

from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.node import Node as RosNode
from rclpy.task import Future

from gz_course.sim.bridge.ros_gz_bridge.entry import ServiceEntry
from gz_course.sim.bridge.ros_gz_bridge.type_pairs import find_service
from gz_course.sim.did_you_mean import did_you_mean
from gz_course.sim.gz.transport import Node as GzNode

TIMEOUT_S = 5.0
"""Maximum time [s] for the response of Gazebo."""


class ServiceLink:
    """The ROS service of `entry` on `ros_node`, which its owner spins, until `close`.

    `timeout` [s] is the maximum time for Gazebo's response. Raises the errors of rclpy for an invalid name.
    """

    def __init__(self, ros_node: RosNode, gz_node: GzNode, entry: ServiceEntry, timeout: float = TIMEOUT_S) -> None:
        self.entry = entry
        self._node = ros_node
        self._gz_node = gz_node
        self._timeout = timeout
        self._gz_name = entry.gz_service
        self._types = find_service(entry.ros_type, entry.gz_request_type, entry.gz_reply_type)
        self._callers = concurrent.futures.ThreadPoolExecutor(1, thread_name_prefix=f"service {entry.name}")
        self._open = True
        # Reentrant, so that topics of the same node do not wait for Gazebo's answer.
        self._group = ReentrantCallbackGroup()
        self._service = ros_node.create_service(
            self._types.ros_class, entry.name, self._on_request, callback_group=self._group
        )

    def close(self) -> None:
        """Destroy the service and cancel its calls."""
        if self._open:
            self._open = False
            self._callers.shutdown(wait=False, cancel_futures=True)
            self._node.destroy_service(self._service)

    async def _on_request(self, request: Any, response: Any) -> Any:
        """Return the ROS response; a coroutine, so that rclpy's executor goes on until Gazebo has answered."""
        answered: Future = Future(executor=self._node.executor)
        answered.add_done_callback(lambda _: None)  # a callback makes rclpy wake the executor
        self._callers.submit(self._call, request, answered)
        reply = await answered
        return response if reply is None else reply

    def _call(self, request: Any, answered: Future) -> None:
        """Call Gazebo and set the result of `answered` to the ROS response, or to None if there was none."""
        reply = None
        try:
            reply = self._ask(request)
        except Exception as error:
            self._warn(f"the call was not bridged: {' '.join(str(error).split())}")
        finally:
            with contextlib.suppress(RuntimeError):  # the executor may have been shut down
                answered.set_result(reply)

    def _ask(self, request: Any) -> Any:
        types = self._types
        fault = types.fault(request) if types.fault is not None else None
        if fault is not None:
            self._warn(f"the call was not bridged: {fault}; only finite numbers can be commanded")
            return None
        outcome = self._gz_node.call_raw(
            self._gz_name,
            types.request_to_gz(request).SerializeToString(),
            types.gz_request_type,
            types.gz_reply_type,
            round(self._timeout * 1000),
        )
        if outcome.result:
            return types.reply_to_ros(types.gz_reply_class.FromString(outcome.response))
        if outcome.executed:
            self._warn("Gazebo could not do what was asked")
        else:
            self._warn(f"no answer of Gazebo in {self._timeout:g} s: {self._likely_reason()}")
        return None

    def _likely_reason(self) -> str:
        """Return the likely reason why nobody has answered."""
        wanted = (self._types.gz_request_type, self._types.gz_reply_type)
        offered = {(each.req_type_name, each.rep_type_name) for each in self._gz_node.service_info(self._gz_name)}
        if not offered:
            return f"it offers no service {self._gz_name}{did_you_mean(self._gz_name, self._gz_node.service_list())}"
        if wanted not in offered:
            seen = " or ".join(f"{request} and {reply}" for request, reply in sorted(offered))
            return f"it offers {self._gz_name} with {seen}, not with {wanted[0]} and {wanted[1]}"
        return "it is busy"

    def _warn(self, sentence: str) -> None:
        with contextlib.suppress(Exception):  # the node may have been destroyed
            self._node.get_logger().warning(f"service {self.entry.name} ({self.entry.ros_type}): {sentence}")
