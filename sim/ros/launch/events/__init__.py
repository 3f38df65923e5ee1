"""Events of a launch. Events of processes are in `launch.events.process`."""

from gz_course.sim.ros.launch.events import process as process
from gz_course.sim.ros.launch.events.execution_complete import ExecutionComplete
from gz_course.sim.ros.launch.events.include_launch_description import IncludeLaunchDescription
from gz_course.sim.ros.launch.events.matchers import matches_action
from gz_course.sim.ros.launch.events.shutdown import Shutdown
from gz_course.sim.ros.launch.events.timer_event import TimerEvent

__all__ = ["ExecutionComplete", "IncludeLaunchDescription", "Shutdown", "TimerEvent", "matches_action"]
