"""The ROS node of a launch, for actions that speak to nodes. It exists only if a launch file has such an action.

Source: ros2/launch_ros, launch_ros/launch_ros/ros_adapters.py
"""

from __future__ import annotations

import os
import threading
from typing import TYPE_CHECKING, Any

from gz_course.sim.ros.launch.event_handlers import OnShutdown
from gz_course.sim.ros.launch_ros.actions.set_parameter import PARAMETERS

if TYPE_CHECKING:
    from gz_course.sim.ros.launch.launch_context import LaunchContext

_ADAPTER = "launch_ros_adapter"


class ROSAdapter:
    """A node `launch_ros_<process>`, spun by a thread of its own until `shutdown`."""

    def __init__(self, *, use_sim_time: bool = False) -> None:
        import rclpy
        from rclpy.executors import SingleThreadedExecutor
        from rclpy.parameter import Parameter
        from rclpy.signals import SignalHandlerOptions

        self.ros_context = rclpy.Context()
        rclpy.init(args=[], context=self.ros_context, signal_handler_options=SignalHandlerOptions.NO)
        self.ros_node: Any = rclpy.create_node(
            f"launch_ros_{os.getpid()}",
            context=self.ros_context,
            parameter_overrides=[Parameter("use_sim_time", value=use_sim_time)],
        )
        self.ros_executor = SingleThreadedExecutor(context=self.ros_context)
        self.ros_executor.add_node(self.ros_node)
        self._thread = threading.Thread(target=self._spin, name="launch_ros", daemon=True)
        self._thread.start()

    def _spin(self) -> None:
        from rclpy.executors import ExternalShutdownException, ShutdownException

        try:
            self.ros_executor.spin()
        except (ExternalShutdownException, ShutdownException):
            return

    def shutdown(self) -> None:
        """End the thread and destroy the node."""
        self.ros_executor.shutdown(0.0)
        self.ros_context.try_shutdown()
        self._thread.join()
        self.ros_node.destroy_node()


def get_ros_adapter(context: LaunchContext) -> ROSAdapter:
    """Return the adapter of the launch, made at the first call; it ends with the launch.

    Its clock follows /clock if `use_sim_time` was set for the nodes of the scope.
    """
    adapter: ROSAdapter | None = context.get_locals_as_dict().get(_ADAPTER)
    if adapter is None:
        parameters = context.launch_configurations.get(PARAMETERS, ())
        of_scope: dict[str, Any] = dict(each for each in parameters if isinstance(each, tuple))
        adapter = made = ROSAdapter(use_sim_time=of_scope.get("use_sim_time") is True)
        context.extend_globals({_ADAPTER: adapter})

        def end(*_: Any) -> None:
            context.extend_globals({_ADAPTER: None})
            made.shutdown()

        context.register_event_handler(OnShutdown(on_shutdown=end), append=True)
    return adapter


def get_ros_node(context: LaunchContext) -> Any:
    """Return the node of the launch."""
    return get_ros_adapter(context).ros_node
