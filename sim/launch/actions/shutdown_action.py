"""Shutdown, in the module where launch of ROS 2 has it."""

from launch.actions.emit_event import Shutdown as Shutdown
