"""The report as one page; see `grader/report/html/`."""

from gz_course.grader.report.format import Format
from gz_course.grader.report.report import Report


def as_html(report: Report) -> str:
    """Return the report as an HTML page. Raises UsageError if a recording is unreadable."""
    from gz_course.grader.report.html.page import as_html

    return as_html(report)


def prepare() -> None:
    from gz_course.grader.report.html.page import compiled

    compiled("page.html.jinja")


FORMAT = Format(
    as_text=as_html,
    file="report.html",
    help="Write the report as one HTML page, with plots.",
    class_help="Also write each report as a page.",
    before=("gradescope",),
    prepare=prepare,
)
