"""The report as JUnit XML for continuous integration: a suite for the exercise, a case for each check.

A check that failed is a `failure`; if nothing could be run, every check is an `error`. Checks share one run, so only
the suite has a duration; it is left out when a recording is scored again.

Source: "JUnit XML file format", https://github.com/testmoapp/junitxml
"""

from __future__ import annotations

from typing import TYPE_CHECKING
from xml.etree import ElementTree as XML

from gz_course.grader.printable import storable
from gz_course.grader.report.format import Format
from gz_course.grader.report.node_log import log_of
from gz_course.grader.report.report import Report, points

if TYPE_CHECKING:
    from gz_course.grader.score.consequences import CheckResult


def as_junit(report: Report) -> str:
    """Return the report as JUnit XML text. Raises UsageError if a recording is unreadable."""
    failed = sum(not check.finding.passed for check in report.score.checks)
    ran = bool(report.sim_seconds)
    counts = {
        "tests": str(len(report.score.checks)),
        "failures": str(failed if ran else 0),
        "errors": str(0 if ran else failed),
        "skipped": "0",
        "time": f"{report.host.wall_seconds if report.host else 0.0:.3f}",
    }
    root = XML.Element("testsuites", {"name": "course grade", **counts})
    suite = XML.SubElement(root, "testsuite", {"name": storable(report.exercise), **counts})
    properties = XML.SubElement(suite, "properties")
    for name, value in _properties(report).items():
        XML.SubElement(properties, "property", {"name": name, "value": storable(value)})
    for check in report.score.checks:
        suite.append(_case(check, report, ran))
    said = log_of(report).as_text()
    XML.SubElement(suite, "system-out").text = storable(said)
    XML.indent(root)
    return '<?xml version="1.0" encoding="utf-8"?>\n' + XML.tostring(root, encoding="unicode") + "\n"


def _case(check: CheckResult, report: Report, ran: bool) -> XML.Element:
    names = {"classname": storable(report.exercise), "name": storable(check.spec.title), "time": "0.000"}
    case = XML.Element("testcase", names)
    if not check.finding.passed:
        message = check.finding.measured if ran else report.score.diagnosis
        kind = check.spec.kind if ran else report.score.outcome
        fault = XML.SubElement(
            case, "failure" if ran else "error", {"message": storable(message), "type": storable(kind)}
        )
        fault.text = storable("\n".join(f"{name}: {value}" for name, value in report.told(check)))
    return case


def _properties(report: Report) -> dict[str, str]:
    facts = {
        "score": points(report.score.points),
        "max_score": points(report.max_score),
        "outcome": report.score.outcome,
        "diagnosis": report.score.diagnosis,
        "truth_sha256": report.score.truth_sha256,
        "sim_seconds": f"{report.sim_seconds:g}",
    }
    facts |= {
        f"trial.{trial.name}": f"seed {trial.seed}, {points(trial.score.points)} points" for trial in report.trials
    }
    facts |= {f"note.{number}": note for number, note in enumerate(report.notes, start=1)}
    facts |= {f"version.{name}": str(version) for name, version in sorted(report.versions.items())}
    if report.host is not None:
        facts |= {"sandbox": report.host.sandbox, "pace": report.host.pace}
    return {name: value for name, value in facts.items() if value}


FORMAT = Format(
    as_text=as_junit,
    file="junit.xml",
    help="Write the report as JUnit XML.",
    class_help="Also write each report as JUnit XML.",
)
