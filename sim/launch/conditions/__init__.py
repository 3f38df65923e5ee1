"""Conditions for `condition=` of an action."""

from gz_course.sim.launch.conditions.evaluate_condition_expression_impl import (
    InvalidConditionExpressionError,
    evaluate_condition_expression,
)
from gz_course.sim.launch.conditions.if_condition import IfCondition, UnlessCondition
from gz_course.sim.launch.conditions.launch_configuration_equals import (
    LaunchConfigurationEquals,
    LaunchConfigurationNotEquals,
)

__all__ = [
    "IfCondition",
    "InvalidConditionExpressionError",
    "LaunchConfigurationEquals",
    "LaunchConfigurationNotEquals",
    "UnlessCondition",
    "evaluate_condition_expression",
]
