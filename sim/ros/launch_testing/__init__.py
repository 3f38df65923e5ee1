"""Tests of a running launch: processes are launched, tests run beside them, others after their end.

A test file defines `generate_test_description()`, whose launch description holds `ReadyToTest()`, and test cases of
`unittest`. `launch_test FILE` runs it, and so does pytest if the function is marked `pytest.mark.launch_test`.

Source: https://github.com/ros2/launch, launch_testing/README.md
"""

from __future__ import annotations

import importlib
from typing import Any

from gz_course.sim.ros.launch_testing.markers import post_shutdown_test
from gz_course.sim.ros.launch_testing.parametrize import parametrize
from gz_course.sim.ros.launch_testing.ready_to_test_action_timeout import ready_to_test_action_timeout

# The plug-in of pytest lies in this package and is loaded by every pytest run: what needs `launch` is imported later.
_FOUND_IN = {
    "ActiveIoHandler": "io_handler",
    "ActiveProcInfoHandler": "proc_info_handler",
    "IoHandler": "io_handler",
    "ProcInfoHandler": "proc_info_handler",
    "ReadyAggregator": "ready_aggregator",
}
_SUBPACKAGES = ("actions", "asserts", "event_handlers", "tools", "util")

__all__ = [
    "ActiveIoHandler",
    "ActiveProcInfoHandler",
    "IoHandler",
    "ProcInfoHandler",
    "ReadyAggregator",
    "actions",
    "asserts",
    "event_handlers",
    "parametrize",
    "post_shutdown_test",
    "ready_to_test_action_timeout",
    "tools",
    "util",
]


def __getattr__(name: str) -> Any:
    if name in _SUBPACKAGES:
        return importlib.import_module(f"{__name__}.{name}")
    if name not in _FOUND_IN:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    value = getattr(importlib.import_module(f"{__name__}.{_FOUND_IN[name]}"), name)
    globals()[name] = value
    return value
