"""The check that the agent's patches fit the installed libraries, done once at the beginning of a run.

The submission's processes run the same Python with the same libraries, so the check can run outside the sandbox, where
no submission can forge its result.
"""

from __future__ import annotations

import platform
from importlib.metadata import version

from gz_course.grader.errors import InfrastructureError
from gz_course.grader.run.agent.course_agent import python_3, python_3_threads, rclpy_7_1, rclpy_7_1_actions
from gz_course.grader.run.agent.course_agent.self_check import misfits

RCLPY = "ros-jazzy-rclpy"


def check_compatibility() -> None:
    """Raise InfrastructureError naming the first item of rclpy or Python that is not as the patches expect it."""
    if missing := misfits(python_3.SUBPROCESS | python_3.ASYNCIO | python_3_threads.THREADS):
        raise InfrastructureError(
            f"nodes cannot be kept in step with this Python {platform.python_version()}: {missing[0]}; "
            "use a Python with which the course was tried: the README names them"
        )
    installed = version(RCLPY)
    found = misfits(rclpy_7_1.RELIED_UPON | rclpy_7_1_actions.RELIED_UPON)
    if not found and not installed.startswith(f"{rclpy_7_1.VERSION}."):
        found = [f"rclpy has the version {installed}, and {rclpy_7_1.VERSION} is expected"]
    if found:
        raise InfrastructureError(
            f"nodes cannot be kept in step with this rclpy {installed}: {found[0]}; "
            "install the versions in constraints.txt"
        )
