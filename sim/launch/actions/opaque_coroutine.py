"""OpaqueCoroutine, in the module where launch of ROS 2 has it."""

from gz_course.sim.launch.actions.opaque_function import OpaqueCoroutine as OpaqueCoroutine
