"""Processes and their output, for tests that start programs themselves."""

from gz_course.sim.ros.launch_testing.tools.output import (
    basic_output_filter,
    expect_output,
    expected_output_from_file,
)
from gz_course.sim.ros.launch_testing.tools.process import ProcessProxy, launch_process

__all__ = ["ProcessProxy", "basic_output_filter", "expect_output", "expected_output_from_file", "launch_process"]
