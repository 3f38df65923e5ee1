"""Actions of launch files: the bridge."""

from gz_course.sim.bridge.ros_gz_bridge.actions.ros_gz_bridge import RosGzBridge

__all__ = ["RosGzBridge"]
