"""The report for programs; README.md, "The JSON report", documents its keys."""

from gz_course.grader.report.format import Format
from gz_course.grader.report.report import Report

FORMAT = Format(
    as_text=Report.as_json,
    file="report.json",
    help="Write the report as JSON to this file.",
    before=("html",),
)
