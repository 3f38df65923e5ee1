"""What happens while a launch file runs. Events of processes are in `launch.events.process`."""

from gz_course.sim.launch.events import process as process
from gz_course.sim.launch.events.execution_complete import (
    ExecutionComplete,
    IncludeLaunchDescription,
    Shutdown,
    TimerEvent,
    matches_action,
)

__all__ = ["ExecutionComplete", "IncludeLaunchDescription", "Shutdown", "TimerEvent", "matches_action"]
