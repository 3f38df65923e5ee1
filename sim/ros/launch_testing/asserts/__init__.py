"""Assertions about output and exit codes of the processes under test."""

from gz_course.sim.ros.launch_testing.asserts.assert_exit_codes import (
    EXIT_OK,
    EXIT_SIGINT,
    EXIT_SIGKILL,
    EXIT_SIGQUIT,
    EXIT_SIGSEGV,
    assertExitCodes,
)
from gz_course.sim.ros.launch_testing.asserts.assert_output import assertInStderr, assertInStdout, assertInStream
from gz_course.sim.ros.launch_testing.asserts.assert_sequential_output import (
    SequentialTextChecker,
    assertSequentialStdout,
)
from gz_course.sim.ros.launch_testing.util.proc_lookup import NO_CMD_ARGS

__all__ = [
    "EXIT_OK",
    "EXIT_SIGINT",
    "EXIT_SIGKILL",
    "EXIT_SIGQUIT",
    "EXIT_SIGSEGV",
    "NO_CMD_ARGS",
    "SequentialTextChecker",
    "assertExitCodes",
    "assertInStderr",
    "assertInStdout",
    "assertInStream",
    "assertSequentialStdout",
]
