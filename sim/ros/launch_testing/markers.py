"""Decorators of launch descriptions and test cases."""

from __future__ import annotations

import functools
import inspect
import threading
from collections.abc import Callable
from typing import Any, TypeVar

Decorated = TypeVar("Decorated", bound=Callable[..., Any])


def post_shutdown_test() -> Callable[[type], type]:
    """Run the tests of a class after the processes have ended, not beside them."""

    def decorate(test_case: type) -> type:
        if not isinstance(test_case, type):
            raise TypeError("post_shutdown_test() decorates a class of tests, no single test")
        test_case.__post_shutdown_test__ = True  # type: ignore[attr-defined]
        return test_case

    return decorate


def keep_alive(test_description: Decorated) -> Decorated:
    """Let the launch of a test description go on when all its processes have ended."""
    markers = getattr(test_description, "__markers__", {})
    test_description.__markers__ = {**markers, "keep_alive": True}  # type: ignore[attr-defined]
    return test_description


def ready_to_test_action_timeout(timeout: float) -> Callable[[Decorated], Decorated]:
    """Wait at most `timeout` [s] for ReadyToTest of a test description; without this it is 15 s."""

    def decorate(test_description: Decorated) -> Decorated:
        test_description.__ready_to_test_action_timeout__ = timeout  # type: ignore[attr-defined]
        return test_description

    return decorate


def retry_on_failure(*, times: int, delay: float | None = None) -> Callable[[Decorated], Decorated]:
    """Run a test method again, up to `times` in all and `delay` [s] apart, until no assertion fails."""
    if times < 1:
        raise ValueError(f"times is {times}; 1 or more is expected")

    def decorate(method: Decorated) -> Decorated:
        if next(iter(inspect.signature(method).parameters), None) != "self":
            raise TypeError("retry_on_failure() decorates a method of a test case")

        @functools.wraps(method)
        def repeated(self: Any, *args: Any, **kwargs: Any) -> Any:
            for _ in range(times - 1):
                try:
                    return method(self, *args, **kwargs)
                except AssertionError:
                    if delay:
                        threading.Event().wait(delay)
            return method(self, *args, **kwargs)

        return repeated  # type: ignore[return-value]

    return decorate
