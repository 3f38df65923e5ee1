"""Runs launch tests: launches the processes, runs tests beside them, ends them, and runs the tests for afterwards.

The launch runs in the calling thread, because only the main thread gets signals; the active tests run in another one.
"""

from __future__ import annotations

import inspect
import threading
import unittest
from collections.abc import Sequence
from typing import Any

from gz_course.sim.ros.launch.actions import IncludeLaunchDescription, RegisterEventHandler
from gz_course.sim.ros.launch.event_handlers import OnProcessExit, OnProcessIO, OnProcessStart
from gz_course.sim.ros.launch.launch_description import LaunchDescription
from gz_course.sim.ros.launch.launch_description_source import LaunchDescriptionSource
from gz_course.sim.ros.launch.launch_service import LaunchService
from gz_course.sim.ros.launch_testing.io_handler import ActiveIoHandler
from gz_course.sim.ros.launch_testing.loader import TestRun
from gz_course.sim.ros.launch_testing.proc_info_handler import ActiveProcInfoHandler
from gz_course.sim.ros.launch_testing.test_result import FailResult, SkipResult, TestResult


class LaunchTestRunner:
    """Runs the launches of a file one after the other; `launch_file_arguments` are `name:=value`."""

    def __init__(
        self, test_runs: Sequence[TestRun], launch_file_arguments: Sequence[str] = (), debug: bool = False
    ) -> None:
        self._test_runs = list(test_runs)
        self._arguments = [_parsed(argument) for argument in launch_file_arguments]
        self._debug = debug

    def generate_preamble(self) -> list[Any]:
        """Return actions that are visited before the test description."""
        return []

    def validate(self) -> None:
        """Raise TypeError if a test description takes arguments that nobody gives, or lacks one of `parametrize`."""
        for run in self._test_runs:
            taken = set(inspect.signature(inspect.unwrap(run.description_function)).parameters) - {"ready_fn"}
            for name in run.param_args:
                if name not in taken:
                    raise TypeError(
                        "Could not find an argument in generate_test_description matching "
                        f"parametrized argument '{name}'"
                    )
            for name in sorted(taken - set(run.param_args)):
                raise TypeError(f"generate_test_description has unexpected extra argument '{name}'")

    def run(self) -> dict[TestRun, Any]:
        """Return the results of each launch; after one that ended too early the others are left out."""
        results: dict[TestRun, Any] = {}
        for run in self._test_runs:
            if len(self._test_runs) > 1:
                print(f"\nStarting test run {run}", flush=True)
            try:
                results[run] = _Launch(run, self.generate_preamble(), self._arguments, self._debug).run()
            except unittest.SkipTest as skip:
                print(f"{run} is skipped: {skip}", flush=True)
                results[run] = SkipResult(run, str(skip))
            except _LaunchDied as died:
                results[run] = FailResult(run, str(died))
                break
        return results


class _LaunchDied(Exception):
    """The launch ended before the active tests."""


class _Launch:
    """One launch and its tests."""

    def __init__(
        self, test_run: TestRun, preamble: Sequence[Any], arguments: Sequence[tuple[str, str]], debug: bool
    ) -> None:
        self._run = test_run
        self._preamble = preamble
        self._arguments = arguments
        self._service = LaunchService(debug=debug)
        self._ready = threading.Event()
        self._results: TestResult | None = None

    def run(self) -> TestResult:
        description, context = self._run.describe(self._ready.set)
        info, output = ActiveProcInfoHandler(), ActiveIoHandler()
        given = {"test_args": dict(self._arguments)}
        now = {**given, "launch_service": self._service, "proc_info": info, "proc_output": output}
        later = {**given, "proc_info": info._proc_info_handler, "proc_output": output._io_handler}
        arguments = {**context, **self._run.param_args}
        self._run.bind(self._run.pre_shutdown_tests, now, {**arguments, **now})
        self._run.bind(self._run.post_shutdown_tests, later, {**arguments, **later})
        self._service.include_launch_description(
            LaunchDescription(
                [
                    *self._preamble,
                    RegisterEventHandler(OnProcessStart(on_start=lambda event, _: info.append(event))),
                    RegisterEventHandler(OnProcessStart(on_start=lambda event, _: output.track(event.action))),
                    RegisterEventHandler(OnProcessExit(on_exit=lambda event, _: info.append(event))),
                    RegisterEventHandler(OnProcessIO(on_stdout=output.append, on_stderr=output.append)),
                    IncludeLaunchDescription(
                        LaunchDescriptionSource(description), launch_arguments=list(self._arguments)
                    ),
                ]
            )
        )
        # A daemon: a test that hangs after the end of the launch must not keep the process.
        threading.Thread(target=self._run_active_tests, name="launch_test", daemon=True).start()
        self._service.run(shutdown_when_idle=not self._run.markers.get("keep_alive", False))
        if self._results is None:
            print("Processes under test stopped before tests completed")
            _print_failed(info, output)
            raise _LaunchDied("Launch stopped before the active tests finished.")
        self._results.append(_run_tests(self._run.post_shutdown_tests))
        return self._results

    def _run_active_tests(self) -> None:
        try:
            if self._ready.wait(self._run.timeout):
                self._results = _run_tests(self._run.pre_shutdown_tests)
            else:
                print("Timed out waiting for processes to start up", flush=True)
        finally:
            self._service.shutdown()


def _run_tests(tests: unittest.TestSuite) -> TestResult:
    result = unittest.TextTestRunner(verbosity=2, resultclass=TestResult).run(tests)
    assert isinstance(result, TestResult)
    return result


def _print_failed(info: ActiveProcInfoHandler, output: ActiveIoHandler) -> None:
    """Print exit code and output of each process that has failed."""
    for event in info:
        code = getattr(event, "returncode", None)
        if not code:
            continue
        title = f"##### '{event.process_name}' output #####"
        print(f"Process '{event.process_name}' exited with {code}\n{title}")
        printed = b"".join(piece.text for piece in output[event.action]) if event.action in output.processes() else b""
        print(printed.decode(errors="replace"))
        print("#" * len(title), flush=True)


def _parsed(argument: str) -> tuple[str, str]:
    """Return name and value of `name:=value`. Raises ValueError for another text."""
    name, separator, value = argument.partition(":=")
    if not (name and separator):
        raise ValueError(f"malformed launch argument '{argument}', expected format '<name>:=<value>'")
    return name, value
