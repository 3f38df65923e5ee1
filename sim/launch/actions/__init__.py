"""What a launch file can do: start processes, include other launch files, set things, wait for events."""

from gz_course.sim.launch.actions.declare_launch_argument import DeclareLaunchArgument
from gz_course.sim.launch.actions.emit_event import EmitEvent, RegisterEventHandler, Shutdown, UnregisterEventHandler
from gz_course.sim.launch.actions.execute_local import ExecuteLocal
from gz_course.sim.launch.actions.execute_process import ExecuteProcess
from gz_course.sim.launch.actions.group_action import GroupAction
from gz_course.sim.launch.actions.include_launch_description import IncludeLaunchDescription
from gz_course.sim.launch.actions.log_info import LogInfo
from gz_course.sim.launch.actions.opaque_function import OpaqueCoroutine, OpaqueFunction
from gz_course.sim.launch.actions.set_environment_variable import (
    AppendEnvironmentVariable,
    PopEnvironment,
    PushEnvironment,
    ResetEnvironment,
    SetEnvironmentVariable,
    UnsetEnvironmentVariable,
)
from gz_course.sim.launch.actions.set_launch_configuration import (
    PopLaunchConfigurations,
    PushLaunchConfigurations,
    ResetLaunchConfigurations,
    SetLaunchConfiguration,
    UnsetLaunchConfiguration,
)
from gz_course.sim.launch.actions.timer_action import TimerAction

__all__ = [
    "AppendEnvironmentVariable",
    "DeclareLaunchArgument",
    "EmitEvent",
    "ExecuteLocal",
    "ExecuteProcess",
    "GroupAction",
    "IncludeLaunchDescription",
    "LogInfo",
    "OpaqueCoroutine",
    "OpaqueFunction",
    "PopEnvironment",
    "PopLaunchConfigurations",
    "PushEnvironment",
    "PushLaunchConfigurations",
    "RegisterEventHandler",
    "ResetEnvironment",
    "ResetLaunchConfigurations",
    "SetEnvironmentVariable",
    "SetLaunchConfiguration",
    "Shutdown",
    "TimerAction",
    "UnregisterEventHandler",
    "UnsetEnvironmentVariable",
    "UnsetLaunchConfiguration",
]
