"""UnlessCondition, in the module where launch of ROS 2 has it."""

from gz_course.sim.launch.conditions.if_condition import UnlessCondition as UnlessCondition
