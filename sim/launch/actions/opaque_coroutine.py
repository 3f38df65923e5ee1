"""OpaqueCoroutine, in the module where launch of ROS 2 has it."""

from launch.actions.opaque_function import OpaqueCoroutine as OpaqueCoroutine
