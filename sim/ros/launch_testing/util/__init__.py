"""The processes of a launch test, by action or name, and one that keeps a launch alive."""

from gz_course.sim.ros.launch_testing.util.keep_alive_proc import KeepAliveProc
from gz_course.sim.ros.launch_testing.util.proc_lookup import (
    NO_CMD_ARGS,
    NoMatchingProcessException,
    resolveProcesses,
)

__all__ = ["NO_CMD_ARGS", "KeepAliveProc", "NoMatchingProcessException", "resolveProcesses"]
