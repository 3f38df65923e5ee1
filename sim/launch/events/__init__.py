"""What happens while a launch file runs. Events of processes are in `launch.events.process`."""

from launch.events import process as process
from launch.events.execution_complete import (
    ExecutionComplete,
    IncludeLaunchDescription,
    Shutdown,
    TimerEvent,
    matches_action,
)

__all__ = ["ExecutionComplete", "IncludeLaunchDescription", "Shutdown", "TimerEvent", "matches_action"]
