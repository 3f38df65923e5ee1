"""The assertion about exit codes."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from gz_course.sim.ros.launch_testing.util.proc_lookup import Target, resolveProcesses

EXIT_OK = 0
EXIT_SIGINT = 130
EXIT_SIGQUIT = 131
EXIT_SIGKILL = 137
EXIT_SIGSEGV = 139


def assertExitCodes(
    proc_info: Any,
    allowable_exit_codes: Iterable[int] = (EXIT_OK,),
    process: Target = None,
    cmd_args: Any = None,
    *,
    strict_proc_matching: bool = True,
) -> None:
    """Assert that the processes, by default all, have ended with one of these exit codes; signal n ends with -n."""
    allowed = list(allowable_exit_codes)
    for code in allowed:
        assert isinstance(code, int), f"Provided exit code {code} is not an int"
    for action in resolveProcesses(
        proc_info, process=process, cmd_args=cmd_args, strict_proc_matching=strict_proc_matching
    ):
        event = proc_info[action]
        name, ended = event.process_name, getattr(event, "returncode", None)
        assert ended is not None, f"Proc {name} has not exited"
        assert ended in allowed, f"Proc {name} exited with code {ended}"
