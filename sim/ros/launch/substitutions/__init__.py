"""Texts that are known only when the launch file runs: values of arguments, paths, results of commands."""

from gz_course.sim.ros.launch.substitutions.anon_name import AnonName
from gz_course.sim.ros.launch.substitutions.boolean_substitution import (
    AllSubstitution,
    AndSubstitution,
    AnySubstitution,
    NotSubstitution,
    OrSubstitution,
)
from gz_course.sim.ros.launch.substitutions.command import Command
from gz_course.sim.ros.launch.substitutions.environment_variable import EnvironmentVariable
from gz_course.sim.ros.launch.substitutions.equals_substitution import EqualsSubstitution
from gz_course.sim.ros.launch.substitutions.file_content import FileContent
from gz_course.sim.ros.launch.substitutions.find_executable import FindExecutable
from gz_course.sim.ros.launch.substitutions.if_else_substitution import IfElseSubstitution
from gz_course.sim.ros.launch.substitutions.launch_configuration import LaunchConfiguration
from gz_course.sim.ros.launch.substitutions.launch_log_dir import LaunchLogDir
from gz_course.sim.ros.launch.substitutions.local_substitution import LocalSubstitution
from gz_course.sim.ros.launch.substitutions.not_equals_substitution import NotEqualsSubstitution
from gz_course.sim.ros.launch.substitutions.path_join_substitution import PathJoinSubstitution
from gz_course.sim.ros.launch.substitutions.path_substitution import PathSubstitution
from gz_course.sim.ros.launch.substitutions.python_expression import PythonExpression
from gz_course.sim.ros.launch.substitutions.substitution_failure import SubstitutionFailure
from gz_course.sim.ros.launch.substitutions.text_substitution import TextSubstitution
from gz_course.sim.ros.launch.substitutions.this_launch_file import ThisLaunchFile
from gz_course.sim.ros.launch.substitutions.this_launch_file_dir import ThisLaunchFileDir

__all__ = [
    "AllSubstitution",
    "AndSubstitution",
    "AnonName",
    "AnySubstitution",
    "Command",
    "EnvironmentVariable",
    "EqualsSubstitution",
    "FileContent",
    "FindExecutable",
    "IfElseSubstitution",
    "LaunchConfiguration",
    "LaunchLogDir",
    "LocalSubstitution",
    "NotEqualsSubstitution",
    "NotSubstitution",
    "OrSubstitution",
    "PathJoinSubstitution",
    "PathSubstitution",
    "PythonExpression",
    "SubstitutionFailure",
    "TextSubstitution",
    "ThisLaunchFile",
    "ThisLaunchFileDir",
]
