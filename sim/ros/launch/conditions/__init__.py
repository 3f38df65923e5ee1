"""Conditions for `condition=` of an action."""

from gz_course.sim.ros.launch.conditions.evaluate_condition_expression_impl import (
    InvalidConditionExpressionError,
    evaluate_condition_expression,
)
from gz_course.sim.ros.launch.conditions.if_condition import IfCondition
from gz_course.sim.ros.launch.conditions.launch_configuration_equals import LaunchConfigurationEquals
from gz_course.sim.ros.launch.conditions.launch_configuration_not_equals import LaunchConfigurationNotEquals
from gz_course.sim.ros.launch.conditions.unless_condition import UnlessCondition

__all__ = [
    "IfCondition",
    "InvalidConditionExpressionError",
    "LaunchConfigurationEquals",
    "LaunchConfigurationNotEquals",
    "UnlessCondition",
    "evaluate_condition_expression",
]
