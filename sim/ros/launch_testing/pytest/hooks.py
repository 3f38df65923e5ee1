"""The plug-in of pytest: a file whose `generate_test_description` is marked is one test, which is a launch test.

The mark is `pytest.mark.launch_test`, or `pytest.mark.rostest` for tests with ROS nodes. Every run of pytest loads this
file, so it imports little, and it looks into a file only if the name of the function stands there.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

import pytest

_ENTRY_POINT = "generate_test_description"
_RUNNERS = {  # mark -> module with its LaunchTestRunner
    "launch_test": "gz_course.sim.ros.launch_testing.test_runner",
    "rostest": "gz_course.sim.ros.launch_testing_ros.test_runner",
}


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption(
        "--launch-args", action="append", nargs="*", default=[], help="One or more launch test arguments, name:=value"
    )


def pytest_configure(config: pytest.Config) -> None:
    for mark, kind in (("launch_test", "launch test"), ("rostest", "ROS launch test")):
        config.addinivalue_line("markers", f"{mark}: mark a generate_test_description function as a {kind} entrypoint")


@pytest.hookimpl(tryfirst=True)
def pytest_pycollect_makemodule(module_path: Path, parent: pytest.Collector) -> pytest.Collector | None:
    if _ENTRY_POINT.encode() not in module_path.read_bytes():
        return None
    module = pytest.Module.from_parent(parent, path=module_path)
    try:
        entry_point = getattr(module.obj, _ENTRY_POINT, None)
    except (Exception, pytest.skip.Exception, pytest.fail.Exception):
        return module  # told when it is collected
    runner = next((_RUNNERS[mark.name] for mark in _marks(entry_point) if mark.name in _RUNNERS), None)
    return (
        module
        if runner is None
        else LaunchTestModule.from_parent(parent, path=module_path, module=module, runner=runner)
    )


def _marks(function: Any) -> Iterable[Any]:
    marks = getattr(function, "pytestmark", [])
    return marks if isinstance(marks, list) else [marks]


class LaunchTestModule(pytest.File):
    """A file of which all test cases are one launch test."""

    def __init__(self, *args: Any, module: pytest.Module, runner: str, **kwargs: Any) -> None:
        super().__init__(*args, **kwargs)
        self._module = module
        self._runner = runner

    def collect(self) -> Iterable[pytest.Item]:
        name = self._module.obj.__name__.rpartition(".")[2]
        yield LaunchTestItem.from_parent(self, name=name, module=self._module.obj, runner=self._runner)


class LaunchTestItem(pytest.Item):
    """All launches of a file with their tests."""

    def __init__(self, *args: Any, module: Any, runner: str, **kwargs: Any) -> None:
        super().__init__(*args, **kwargs)
        self._test_module = module
        self._runner = runner
        for mark in _marks(module.generate_test_description):
            self.add_marker(getattr(pytest.mark, mark.name)(*mark.args, **mark.kwargs))

    def runtest(self) -> None:
        import importlib

        from gz_course.sim.ros.launch_testing.loader import LoadTestsFromPythonModule

        arguments = [argument for group in self.config.getoption("--launch-args") for argument in group]
        runs = LoadTestsFromPythonModule(self._test_module, name=self._test_module.__name__)
        runner = importlib.import_module(self._runner).LaunchTestRunner(
            runs, arguments, self.config.get_verbosity() > 1
        )
        runner.validate()
        results = runner.run()
        if not all(result.wasSuccessful() for result in results.values()):
            raise LaunchTestFailure(results)

    def repr_failure(self, excinfo: pytest.ExceptionInfo[BaseException], style: Any = None) -> Any:
        if isinstance(excinfo.value, LaunchTestFailure):
            return str(excinfo.value)
        return super().repr_failure(excinfo, style)

    def reportinfo(self) -> tuple[Path, int | None, str]:
        return self.path, 0, f"launch tests: {self.name}"


class LaunchTestFailure(Exception):
    """Test cases of a launch test have failed; the text is their tracebacks."""

    def __init__(self, results: Mapping[Any, Any]) -> None:
        failed = [entry for result in results.values() for entry in (*result.errors, *result.failures)]
        super().__init__("\n\n".join(f"FAIL: {_name(case)}\n{text}" for case, text in failed))


def _name(case: Any) -> str:
    method = getattr(case, "_testMethodName", case)
    return f"{type(case).__name__}.{method}" if hasattr(case, "id") else str(method)
