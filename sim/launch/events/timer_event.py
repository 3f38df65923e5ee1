"""TimerEvent, in the module where launch of ROS 2 has it."""

from launch.events.execution_complete import TimerEvent as TimerEvent
