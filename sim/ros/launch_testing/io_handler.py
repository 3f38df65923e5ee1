"""The output of the processes of a launch test: `proc_output`."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterator
from typing import Any

from gz_course.sim.ros.launch.actions.execute_local import ExecuteLocal
from gz_course.sim.ros.launch.events.process import ProcessIO
from gz_course.sim.ros.launch_testing.asserts.assert_output import assertInStream
from gz_course.sim.ros.launch_testing.util.proc_lookup import NoMatchingProcessException, Target, resolveProcesses


class IoHandler:
    """Holds what the processes have printed: events in the order of time, also by process."""

    def __init__(self) -> None:
        self._events: list[ProcessIO] = []
        self._by_action: dict[Any, list[ProcessIO]] = {}

    def track(self, action: ExecuteLocal) -> None:
        """Know a process that may print nothing."""
        self._by_action.setdefault(action, [])

    def append(self, process_io: ProcessIO) -> None:
        self._events.append(process_io)
        self._by_action.setdefault(process_io.action, []).append(process_io)

    def __iter__(self) -> Iterator[ProcessIO]:
        return iter(self._events)

    def processes(self) -> list[Any]:
        return list(self._by_action)

    def process_names(self) -> list[str]:
        return [action.process_details["name"] for action in self._by_action]

    def __getitem__(self, key: str | ExecuteLocal) -> list[ProcessIO]:
        """Return the output of a process, given as action or by its whole name."""
        if not isinstance(key, str):
            return list(self._by_action[key])
        for action, events in self._by_action.items():
            if action.process_details["name"] == key:
                return list(events)
        raise KeyError(key)


class ActiveIoHandler(IoHandler):
    """Holds what running processes print, for tests beside them, which may wait for it."""

    def __init__(self) -> None:
        self.io_event = threading.Condition(threading.RLock())
        self._io_handler = IoHandler()

    def track(self, action: ExecuteLocal) -> None:
        with self.io_event:
            self._io_handler.track(action)
            self.io_event.notify_all()

    def append(self, process_io: ProcessIO) -> None:
        with self.io_event:
            self._io_handler.append(process_io)
            self.io_event.notify_all()

    def __iter__(self) -> Iterator[ProcessIO]:
        with self.io_event:
            return iter(list(self._io_handler))

    def processes(self) -> list[Any]:
        with self.io_event:
            return self._io_handler.processes()

    def process_names(self) -> list[str]:
        with self.io_event:
            return self._io_handler.process_names()

    def __getitem__(self, key: str | ExecuteLocal) -> list[ProcessIO]:
        with self.io_event:
            return self._io_handler[key]

    def assertWaitFor(self, *args: Any, **kwargs: Any) -> None:
        """Assert that `waitFor` with these arguments finds the output."""
        assert self.waitFor(*args, **kwargs), "Waiting for output timed out"

    def waitFor(
        self,
        expected_output: Any,
        process: Target = None,
        cmd_args: Any = None,
        *,
        strict_proc_matching: bool = True,
        output_filter: Callable[[str], str] | None = None,
        timeout: float = 10,
        strip_ansi_escape_sequences: bool = True,
        stream: str = "stderr",
    ) -> bool:
        """Wait for output on `stream`, at most `timeout` [s]; return whether it came. Arguments as of `assertInStream`.

        Raises NoMatchingProcessException if no process with this name or arguments has come meanwhile.
        """

        def has_come() -> bool:
            try:
                assertInStream(
                    self._io_handler,
                    expected_output,
                    process,
                    cmd_args,
                    output_filter=output_filter,
                    strict_proc_matching=strict_proc_matching,
                    strip_ansi_escape_sequences=strip_ansi_escape_sequences,
                    stream=stream,
                )
            except (AssertionError, NoMatchingProcessException):
                return False
            return True

        with self.io_event:
            if self.io_event.wait_for(has_come, timeout=timeout):
                return True
            resolveProcesses(self._io_handler, process=process, cmd_args=cmd_args, strict_proc_matching=False)
            return False
