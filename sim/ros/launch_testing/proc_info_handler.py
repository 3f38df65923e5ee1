"""Start and end of the processes of a launch test: `proc_info`."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterator
from typing import Any

from gz_course.sim.ros.launch.actions.execute_local import ExecuteLocal
from gz_course.sim.ros.launch.events.process import ProcessExited
from gz_course.sim.ros.launch_testing.util.proc_lookup import NoMatchingProcessException, Target, resolveProcesses


class ProcInfoHandler:
    """Holds the last event of each process: ProcessStarted, then ProcessExited with its exit code."""

    def __init__(self) -> None:
        self._by_action: dict[Any, Any] = {}

    def append(self, process_info: Any) -> None:
        self._by_action[process_info.action] = process_info

    def __iter__(self) -> Iterator[Any]:
        return iter(list(self._by_action.values()))

    def processes(self) -> list[Any]:
        return list(self._by_action)

    def process_names(self) -> list[str]:
        return [action.process_details["name"] for action in self._by_action]

    def __getitem__(self, key: str | ExecuteLocal) -> Any:
        """Return the last event of a process, given as action or by a part of its name."""
        if not isinstance(key, str):
            return self._by_action[key]
        for action, event in self._by_action.items():
            if key in action.process_details["name"]:
                return event
        raise KeyError(key)


class ActiveProcInfoHandler(ProcInfoHandler):
    """Holds the last event of each process, for tests beside them, which may wait for a start or an end."""

    def __init__(self) -> None:
        self.proc_event = threading.Condition(threading.RLock())
        self._proc_info_handler = ProcInfoHandler()

    def append(self, process_info: Any) -> None:
        with self.proc_event:
            self._proc_info_handler.append(process_info)
            self.proc_event.notify_all()

    def __iter__(self) -> Iterator[Any]:
        with self.proc_event:
            return iter(self._proc_info_handler)

    def processes(self) -> list[Any]:
        with self.proc_event:
            return self._proc_info_handler.processes()

    def process_names(self) -> list[str]:
        with self.proc_event:
            return self._proc_info_handler.process_names()

    def __getitem__(self, key: str | ExecuteLocal) -> Any:
        with self.proc_event:
            return self._proc_info_handler[key]

    def assertWaitForShutdown(self, process: Target, cmd_args: Any = None, *, timeout: float = 10) -> None:
        """Assert that a process ends within `timeout` [s]."""
        ended = self._wait_for(lambda event: isinstance(event, ProcessExited), process, cmd_args, timeout)
        assert ended, f"Timed out waiting for process '{process}' to finish"

    def assertWaitForStartup(self, process: Target, cmd_args: Any = None, *, timeout: float = 10) -> None:
        """Assert that a process starts within `timeout` [s], or has started before."""
        started = self._wait_for(lambda event: True, process, cmd_args, timeout)
        assert started, f"Timed out waiting for process '{process}' to start"

    def _wait_for(self, fits: Callable[[Any], bool], process: Target, cmd_args: Any, timeout: float) -> bool:
        def has_come() -> bool:
            try:
                action = resolveProcesses(self._proc_info_handler, process=process, cmd_args=cmd_args)[0]
            except NoMatchingProcessException:
                return False
            return fits(self._proc_info_handler[action])

        with self.proc_event:
            return self.proc_event.wait_for(has_come, timeout=timeout)
