"""OnProcessIO, in the module where launch of ROS 2 has it."""

from gz_course.sim.launch.event_handlers.on_action_event_base import OnProcessIO as OnProcessIO
