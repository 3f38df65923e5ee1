"""Events of processes, and their matchers."""

from gz_course.sim.ros.launch.events.process.process_exited import ProcessExited
from gz_course.sim.ros.launch.events.process.process_io import ProcessIO
from gz_course.sim.ros.launch.events.process.process_matchers import matches_executable, matches_name, matches_pid
from gz_course.sim.ros.launch.events.process.process_started import ProcessStarted
from gz_course.sim.ros.launch.events.process.process_stderr import ProcessStderr
from gz_course.sim.ros.launch.events.process.process_stdin import ProcessStdin
from gz_course.sim.ros.launch.events.process.process_stdout import ProcessStdout
from gz_course.sim.ros.launch.events.process.process_targeted_event import ProcessTargetedEvent
from gz_course.sim.ros.launch.events.process.running_process_event import RunningProcessEvent
from gz_course.sim.ros.launch.events.process.shutdown_process import ShutdownProcess
from gz_course.sim.ros.launch.events.process.signal_process import SignalProcess

__all__ = [
    "ProcessExited",
    "ProcessIO",
    "ProcessStarted",
    "ProcessStderr",
    "ProcessStdin",
    "ProcessStdout",
    "ProcessTargetedEvent",
    "RunningProcessEvent",
    "ShutdownProcess",
    "SignalProcess",
    "matches_executable",
    "matches_name",
    "matches_pid",
]
