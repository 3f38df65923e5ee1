"""Makes test runs of a module with `generate_test_description` and test cases of unittest."""

from __future__ import annotations

import functools
import inspect
import unittest
from collections.abc import Callable, Iterable, Iterator, Mapping
from types import ModuleType
from typing import Any

from gz_course.sim.ros.launch.launch_description import LaunchDescription
from gz_course.sim.ros.launch_testing.actions.ready import ReadyToTest

READY_TIMEOUT = 15.0  # [s]


class TestRun:
    """One launch with its tests: those beside the processes and those after their end."""

    __test__ = False

    def __init__(
        self,
        name: str,
        test_description_function: Callable[..., Any],
        param_args: Mapping[str, Any],
        pre_shutdown_tests: unittest.TestSuite,
        post_shutdown_tests: unittest.TestSuite,
    ) -> None:
        self.name = name
        self.description_function = test_description_function
        self.param_args = dict(param_args)
        self.pre_shutdown_tests = pre_shutdown_tests
        self.post_shutdown_tests = post_shutdown_tests
        self.markers: dict[str, Any] = getattr(test_description_function, "__markers__", {})
        self.timeout: float = getattr(test_description_function, "__ready_to_test_action_timeout__", READY_TIMEOUT)
        if self.param_args:
            for case in self.all_cases():
                method = getattr(case, case._testMethodName)
                case._testMethodName += self._parameters()
                setattr(case, case._testMethodName, method)
        for suite in (*_suites(pre_shutdown_tests), *_suites(post_shutdown_tests)):
            suite._cleanup = False  # the cases are asked for their names afterwards

    def describe(self, ready_fn: Callable[[], object]) -> tuple[LaunchDescription, dict[str, Any]]:
        """Return the launch description and what `generate_test_description` gives the tests; ReadyToTest calls
        `ready_fn`. Raises ValueError if there is no ReadyToTest.
        """
        description = self.description_function
        old_style = "ready_fn" in inspect.signature(description).parameters
        result = description(ready_fn=ready_fn) if old_style else description()
        launch_description, context = result if isinstance(result, tuple) else (result, {})
        if not old_style:
            ready = next(ready_actions(launch_description.entities), None)
            if ready is None:
                raise ValueError(
                    "generate_test_description functions must return "
                    "a LaunchDescription containing a ReadyToTest action"
                )
            ready._add_callback(ready_fn)
        return launch_description, context

    def get_launch_description(self) -> LaunchDescription:
        """Return the launch description, to look at."""
        return self.describe(lambda: None)[0]

    def bind(self, tests: unittest.TestSuite, attributes: Mapping[str, Any], arguments: Mapping[str, Any]) -> None:
        """Give attributes to the test cases, and arguments to their methods that have parameters of these names."""
        for kind in {type(case) for case in _cases(tests)}:
            for name, value in attributes.items():
                setattr(kind, name, value)
            for method in ("setUpClass", "tearDownClass"):
                setattr(kind, method, _with_arguments(getattr(kind, method), arguments))
        for case in _cases(tests):
            for method in ("setUp", "tearDown", case._testMethodName):
                setattr(case, method, _with_arguments(getattr(case, method), arguments))

    def all_cases(self) -> Iterator[Any]:
        yield from _cases(self.pre_shutdown_tests)
        yield from _cases(self.post_shutdown_tests)

    def __str__(self) -> str:
        return self.name + self._parameters()

    def _parameters(self) -> str:
        return f"[{', '.join(map(str, self.param_args.values()))}]" if self.param_args else ""


def LoadTestsFromPythonModule(module: ModuleType, *, name: str = "launch_tests") -> list[TestRun]:
    """Return the test runs of a module: one, or one for each argument of `parametrize`."""
    description = module.generate_test_description
    parametrized = getattr(description, "__parametrized__", False)
    return [
        TestRun(name, function, arguments, _loaded(module, after=False), _loaded(module, after=True))
        for function, arguments in (description() if parametrized else [(description, {})])
    ]


def _loaded(module: ModuleType, *, after: bool) -> unittest.TestSuite:
    """Return the test cases of a module that run after the shutdown, or those that run before."""
    return _Loader(after).loadTestsFromModule(module)


class _Loader(unittest.TestLoader):
    """Loads the test cases for before or after the shutdown, each launch its own classes."""

    def __init__(self, after: bool) -> None:
        super().__init__()
        self._after = after

    def loadTestsFromTestCase(self, testCaseClass: type[unittest.TestCase]) -> unittest.TestSuite:
        if getattr(testCaseClass, "__post_shutdown_test__", False) != self._after:
            return unittest.TestSuite()
        own = type(testCaseClass.__name__, (testCaseClass,), {"__module__": testCaseClass.__module__})
        return super().loadTestsFromTestCase(own)


def ready_actions(entities: Iterable[Any]) -> Iterator[ReadyToTest]:
    """Yield all ReadyToTest that are known before the launch runs."""
    for entity in entities:
        if isinstance(entity, ReadyToTest):
            yield entity
        yield from ready_actions(entity.describe_sub_entities())
        for _, conditional in entity.describe_conditional_sub_entities():
            yield from ready_actions(conditional)


def _with_arguments(function: Callable[..., Any], arguments: Mapping[str, Any]) -> Callable[..., Any]:
    taken = inspect.signature(function).parameters
    return functools.partial(function, **{name: value for name, value in arguments.items() if name in taken})


def _suites(tests: Any) -> Iterator[Any]:
    if isinstance(tests, unittest.TestSuite):
        yield tests
        for each in tests:
            yield from _suites(each)


def _cases(tests: Any) -> Iterator[Any]:
    if isinstance(tests, unittest.TestSuite):
        for each in tests:
            yield from _cases(each)
    else:
        yield tests
