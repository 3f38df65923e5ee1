"""ShutdownProcess, in the module where launch of ROS 2 has it."""

from launch.events.process.signal_process import ShutdownProcess as ShutdownProcess
