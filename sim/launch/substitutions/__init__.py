"""Text that is known only when the launch file runs: values of arguments, paths, results of commands."""

from gz_course.sim.launch.substitutions.boolean_substitution import (
    AllSubstitution,
    AndSubstitution,
    AnySubstitution,
    EqualsSubstitution,
    IfElseSubstitution,
    NotEqualsSubstitution,
    NotSubstitution,
    OrSubstitution,
)
from gz_course.sim.launch.substitutions.command import Command
from gz_course.sim.launch.substitutions.environment_variable import EnvironmentVariable
from gz_course.sim.launch.substitutions.launch_configuration import LaunchConfiguration
from gz_course.sim.launch.substitutions.paths import (
    FileContent,
    FindExecutable,
    LaunchLogDir,
    PathJoinSubstitution,
    PathSubstitution,
)
from gz_course.sim.launch.substitutions.python_expression import PythonExpression
from gz_course.sim.launch.substitutions.substitution_failure import SubstitutionFailure
from gz_course.sim.launch.substitutions.text_substitution import TextSubstitution
from gz_course.sim.launch.substitutions.this_launch_file import (
    AnonName,
    LocalSubstitution,
    ThisLaunchFile,
    ThisLaunchFileDir,
)

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
