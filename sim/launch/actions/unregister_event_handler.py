"""UnregisterEventHandler, in the module where launch of ROS 2 has it."""

from gz_course.sim.launch.actions.emit_event import UnregisterEventHandler as UnregisterEventHandler
