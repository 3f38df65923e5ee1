"""ProcessIO, in the module where launch of ROS 2 has it."""

from launch.events.process.running_process_event import ProcessIO as ProcessIO
