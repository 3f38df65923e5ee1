"""ROS nodes in launch files: the interface of ROS 2's `launch_ros`, for machines without it.

It builds on the `launch` beside it. Where the real launch_ros is installed, it is the one that is imported.
"""

from pathlib import Path

from gz_course.sim import launch

_ours = Path(__file__).resolve().parents[1] / "launch"
if Path(launch.__file__ or "").resolve().parent != _ours:
    raise ImportError(
        f"launch comes from {Path(launch.__file__ or '').parent}, but no launch_ros stands beside it, and that of the "
        "course works with the course's launch only; install launch_ros there, too, or remove that launch"
    )

from gz_course.sim.launch_ros import actions, descriptions, parameter_descriptions, substitutions  # noqa: E402

__all__ = ["actions", "descriptions", "parameter_descriptions", "substitutions"]
