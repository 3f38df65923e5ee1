"""ChangeState, in the module where launch_ros of ROS 2 has it."""

from launch_ros.events.lifecycle import ChangeState as ChangeState
