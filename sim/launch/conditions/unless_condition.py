"""UnlessCondition, in the module where launch of ROS 2 has it."""

from launch.conditions.if_condition import UnlessCondition as UnlessCondition
