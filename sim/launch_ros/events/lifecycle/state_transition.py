"""StateTransition, in the module where launch_ros of ROS 2 has it."""

from gz_course.sim.launch_ros.events.lifecycle import StateTransition as StateTransition
