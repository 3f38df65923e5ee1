"""ProcessTargetedEvent, in the module where launch of ROS 2 has it."""

from gz_course.sim.launch.events.process.signal_process import ProcessTargetedEvent as ProcessTargetedEvent
