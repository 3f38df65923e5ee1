"""A process that does nothing, so that a launch whose other processes have ended goes on."""

from __future__ import annotations

from gz_course.sim.ros.launch.actions import ExecuteProcess


def KeepAliveProc() -> ExecuteProcess:
    """Return the action; the process ends with the launch."""
    return ExecuteProcess(cmd=["sleep", "infinity"])
