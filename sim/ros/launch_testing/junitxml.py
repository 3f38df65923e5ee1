"""Results of launch tests as a report in JUnit's XML."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from collections.abc import Mapping
from typing import Any


def unittestResultsToXml(*, name: str = "launch_test", test_results: Mapping[Any, Any]) -> ET.ElementTree:
    """Return a document with one `<testsuite>` for each launch."""
    results = list(test_results.values())
    root = ET.Element("testsuites", {"name": name, **_counts(results)})
    for run, result in test_results.items():
        suite = ET.SubElement(root, "testsuite", {"name": str(run), **_counts([result])})
        suite.set("skipped", str(len(result.skipped)))
        suite.set("time", f"{sum(result.testTimes.values()):.3f}")
        for case in result.testCases:
            _add_case(suite, result, case)
    return ET.ElementTree(root)


def _counts(results: list[Any]) -> dict[str, str]:
    return {
        "tests": str(sum(result.testsRun for result in results)),
        "failures": str(sum(len(result.failures) for result in results)),
        "errors": str(sum(len(result.errors) for result in results)),
    }


def _add_case(suite: ET.Element, result: Any, case: Any) -> None:
    element = ET.SubElement(suite, "testcase", classname=type(case).__name__, name=case._testMethodName)
    element.set("time", f"{result.testTimes.get(case, 0.0):.3f}")
    for tag, entries in (("failure", result.failures), ("error", result.errors), ("skipped", result.skipped)):
        for failed, message in entries:
            if failed is case:
                ET.SubElement(element, tag, message=message)
