"""ProcessStdin, in the module where launch of ROS 2 has it."""

from gz_course.sim.launch.events.process.running_process_event import ProcessStdin as ProcessStdin
