"""A process that a test starts within a running launch, and asks for its state and output."""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING, Any

from gz_course.sim.ros.launch.actions import ExecuteProcess
from gz_course.sim.ros.launch.events import IncludeLaunchDescription, matches_action
from gz_course.sim.ros.launch.events.process import ProcessExited, ProcessStarted, ShutdownProcess
from gz_course.sim.ros.launch.launch_description import LaunchDescription
from gz_course.sim.ros.launch.launch_service import LaunchService

if TYPE_CHECKING:  # output is compared with the help of this package
    from gz_course.sim.ros.launch_testing.io_handler import ActiveIoHandler
    from gz_course.sim.ros.launch_testing.proc_info_handler import ActiveProcInfoHandler


class ProcessProxy:
    """State and output of a process of the launch; `output_filter(text)` changes the output."""

    def __init__(
        self,
        process_action: ExecuteProcess,
        proc_info: ActiveProcInfoHandler,
        proc_output: ActiveIoHandler,
        *,
        output_filter: Callable[[str], str] | None = None,
    ) -> None:
        if output_filter is not None and not callable(output_filter):
            raise TypeError(f"Expected 'output_filter' to be callable but got '{output_filter!r}'")
        self._action = process_action
        self._proc_info = proc_info
        self._proc_output = proc_output
        self._filter = output_filter

    def wait_for_shutdown(self, timeout: float | None = None) -> bool:
        """Wait for the end of the process, for `timeout` [s] or as long as it takes; return whether it has ended."""
        changed = self._proc_info.proc_event
        with changed:
            return changed.wait_for(lambda: self.terminated, timeout=timeout)

    def wait_for_output(self, condition: Callable[[str], object] | None = None, timeout: float | None = None) -> bool:
        """Wait until the process runs and `condition(output)` is true, by default for any output."""
        fits = condition or bool
        if not callable(fits):
            raise TypeError(f"Expected 'condition' to be callable but got '{condition!r}'")
        changed = self._proc_output.io_event
        with changed:
            return bool(changed.wait_for(lambda: self.running and fits(self.output), timeout=timeout))

    @property
    def target_process_action(self) -> ExecuteProcess:
        return self._action

    @property
    def stdout(self) -> str:
        return self._text(lambda event: event.from_stdout)

    @property
    def stderr(self) -> str:
        return self._text(lambda event: event.from_stderr)

    @property
    def output(self) -> str:
        return self._text(lambda event: True)

    @property
    def running(self) -> bool:
        return isinstance(self._event(), ProcessStarted)

    @property
    def terminated(self) -> bool:
        return isinstance(self._event(), ProcessExited)

    @property
    def exit_code(self) -> int | None:
        """Return the exit code, or None before the end."""
        return getattr(self._event(), "returncode", None)

    def _event(self) -> Any:
        return self._proc_info[self._action] if self._action in self._proc_info.processes() else None

    def _text(self, wanted: Callable[[Any], bool]) -> str:
        if self._action not in self._proc_output.processes():
            return ""
        printed = b"".join(event.text for event in self._proc_output[self._action] if wanted(event))
        text = printed.decode(errors="replace")
        return text if self._filter is None else self._filter(text)


@contextlib.contextmanager
def launch_process(
    launch_service: LaunchService,
    process_action: ExecuteProcess,
    proc_info: ActiveProcInfoHandler,
    proc_output: ActiveIoHandler,
    **kwargs: Any,
) -> Iterator[ProcessProxy]:
    """Start a process in a running launch and return its proxy; at the end of the block the process is ended."""
    launch_service.emit_event(IncludeLaunchDescription(LaunchDescription([process_action])))
    proxy = ProcessProxy(process_action, proc_info, proc_output, **kwargs)
    try:
        yield proxy
    finally:
        if not proxy.terminated:
            launch_service.emit_event(ShutdownProcess(process_matcher=matches_action(process_action)))
