"""Results of the tests of one launch."""

from __future__ import annotations

import time
import unittest
from types import SimpleNamespace
from typing import Any


class TestResult(unittest.TextTestResult):
    """Results of tests, with all tests and their times [s]."""

    __test__ = False

    def __init__(self, *args: Any, **kwargs: Any) -> None:
        self._begun: dict[Any, float] = {}
        self.testTimes: dict[Any, float] = {}
        super().__init__(*args, **kwargs)

    @property
    def testCases(self) -> list[Any]:
        return list(self.testTimes)

    def startTest(self, test: Any) -> None:
        self._begun[test] = time.monotonic()
        self.testTimes[test] = 0.0
        super().startTest(test)

    def stopTest(self, test: Any) -> None:
        self.testTimes[test] = time.monotonic() - self._begun[test]
        super().stopTest(test)

    def append(self, results: TestResult) -> None:
        """Add the results of the tests after the shutdown."""
        self.testTimes |= results.testTimes
        for kind in ("failures", "errors", "skipped", "expectedFailures", "unexpectedSuccesses"):
            getattr(self, kind).extend(getattr(results, kind))
        self.testsRun += results.testsRun


class _OneCase(unittest.TestResult):
    """A result that stands for a whole launch."""

    def __init__(self, name: str) -> None:
        super().__init__()
        self.case = SimpleNamespace(_testMethodName=name)
        self.testTimes: dict[Any, float] = {}
        self.testsRun = 1

    @property
    def testCases(self) -> list[Any]:
        return [self.case]


class FailResult(_OneCase):
    """The launch ended before the active tests did."""

    def __init__(self, test_run: Any = None, message: str = "") -> None:
        super().__init__(f"{test_run}_launch" if test_run is not None else "launch")
        self.failures.append((self.case, message))  # type: ignore[arg-type]

    def wasSuccessful(self) -> bool:
        return False


class SkipResult(_OneCase):
    """The test description asked to be skipped."""

    def __init__(self, test_run: Any = None, skip_reason: str = "") -> None:
        super().__init__(f"{test_run}_launch" if test_run is not None else "skipped_launch")
        self.skipped.append((self.case, skip_reason))  # type: ignore[arg-type]

    def wasSuccessful(self) -> bool:
        return True
