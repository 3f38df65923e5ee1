"""OnStateTransition, in the module where launch_ros of ROS 2 has it."""

from gz_course.sim.launch_ros.event_handlers import OnStateTransition as OnStateTransition
