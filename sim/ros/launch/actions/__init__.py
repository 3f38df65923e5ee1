"""The actions of a launch file: start processes, include other launch files, set values, wait for events."""

from gz_course.sim.ros.launch.actions.append_environment_variable import AppendEnvironmentVariable
from gz_course.sim.ros.launch.actions.declare_launch_argument import DeclareLaunchArgument
from gz_course.sim.ros.launch.actions.emit_event import EmitEvent
from gz_course.sim.ros.launch.actions.execute_local import ExecuteLocal
from gz_course.sim.ros.launch.actions.execute_process import ExecuteProcess
from gz_course.sim.ros.launch.actions.group_action import GroupAction
from gz_course.sim.ros.launch.actions.include_launch_description import IncludeLaunchDescription
from gz_course.sim.ros.launch.actions.log_info import LogInfo
from gz_course.sim.ros.launch.actions.opaque_coroutine import OpaqueCoroutine
from gz_course.sim.ros.launch.actions.opaque_function import OpaqueFunction
from gz_course.sim.ros.launch.actions.pop_environment import PopEnvironment
from gz_course.sim.ros.launch.actions.pop_launch_configurations import PopLaunchConfigurations
from gz_course.sim.ros.launch.actions.push_environment import PushEnvironment
from gz_course.sim.ros.launch.actions.push_launch_configurations import PushLaunchConfigurations
from gz_course.sim.ros.launch.actions.register_event_handler import RegisterEventHandler
from gz_course.sim.ros.launch.actions.reset_environment import ResetEnvironment
from gz_course.sim.ros.launch.actions.reset_launch_configurations import ResetLaunchConfigurations
from gz_course.sim.ros.launch.actions.set_environment_variable import SetEnvironmentVariable
from gz_course.sim.ros.launch.actions.set_launch_configuration import SetLaunchConfiguration
from gz_course.sim.ros.launch.actions.shutdown_action import Shutdown
from gz_course.sim.ros.launch.actions.timer_action import TimerAction
from gz_course.sim.ros.launch.actions.unregister_event_handler import UnregisterEventHandler
from gz_course.sim.ros.launch.actions.unset_environment_variable import UnsetEnvironmentVariable
from gz_course.sim.ros.launch.actions.unset_launch_configuration import UnsetLaunchConfiguration

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
