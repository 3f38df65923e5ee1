"""Covariances that are all zero: data fusion takes such data for exact, or refuses it."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from gz_course.grader.tools.diagnose.finding import Finding, Severity
from gz_course.grader.tools.diagnose.system import System, names

BEFORE = ("imu_yaw", "real_time_factor")


def look(system: System) -> Iterator[Finding]:
    """Find topics whose messages have only zeros in all their covariances."""
    for topic, heard in sorted(system.ros.heard.items()):
        if not heard.messages:
            continue
        found = dict(_covariances(heard.messages[-1].message))
        zero = [name for name, values in found.items() if not any(values)]
        if zero and len(zero) == len(found):
            yield Finding(
                Severity.NOTE,
                f"Messages on {topic} ({heard.type}) have covariances that are all zero: {names(zero)}.",
                "Fill in what is known before robot_localization uses it; Gazebo's Odometry carries none "
                "(OdometryPublisher's odometry_with_covariance does).",
            )


def _covariances(message: Any) -> Iterator[tuple[str, Any]]:
    for name in message.get_fields_and_field_types():
        value = getattr(message, name)
        if name.endswith("covariance") and hasattr(value, "__len__"):
            yield name, [float(each) for each in value]
        elif name in ("pose", "twist") and hasattr(value, "covariance"):
            yield f"{name}.covariance", [float(each) for each in value.covariance]
