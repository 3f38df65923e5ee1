"""Event handlers for RegisterEventHandler."""

from gz_course.sim.ros.launch.event_handlers.event_named import event_named
from gz_course.sim.ros.launch.event_handlers.on_action_event_base import OnActionEventBase
from gz_course.sim.ros.launch.event_handlers.on_execution_complete import OnExecutionComplete
from gz_course.sim.ros.launch.event_handlers.on_include_launch_description import OnIncludeLaunchDescription
from gz_course.sim.ros.launch.event_handlers.on_process_exit import OnProcessExit
from gz_course.sim.ros.launch.event_handlers.on_process_io import OnProcessIO
from gz_course.sim.ros.launch.event_handlers.on_process_start import OnProcessStart
from gz_course.sim.ros.launch.event_handlers.on_shutdown import OnShutdown

__all__ = [
    "OnActionEventBase",
    "OnExecutionComplete",
    "OnIncludeLaunchDescription",
    "OnProcessExit",
    "OnProcessIO",
    "OnProcessStart",
    "OnShutdown",
    "event_named",
]
