"""The feedback for one student in words: as text, as comments of a Python file, and as a page without scripts."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from markupsafe import escape

from gz_course.grader.printable import shown
from gz_course.grader.report.report import points
from gz_course.grader.report.seen import Seen
from gz_course.grader.whole_class.gradebook import Row

PAGE = """<!doctype html>
<html lang="en">
<head><meta charset="utf-8"><title>{title}</title>
<style>body {{ font: 1rem/1.5 sans-serif; max-width: 50rem; margin: 2rem auto; padding: 0 1rem; }}
dt {{ font-weight: 600; }} dd {{ margin: 0 0 .3rem 1rem; }} li {{ margin-bottom: 1rem; }}</style></head>
<body>
<h1>{title}</h1>
{body}
</body>
</html>
"""


def as_text(title: str, row: Row, told: Seen) -> str:
    """Return the feedback as lines of text."""
    lines = [title, *_before(row, told), ""]
    for check in told.checks:
        lines.append(f"{_word(check)}  {_points(check)}  {shown(check['title'])}")
        lines += [f"    {name}: {text}" for name, text in _lines(check)]
    return "\n".join([*lines, *(["", told.summary] if told.summary else [])]).rstrip() + "\n"


def commented(text: str) -> str:
    """Return a text as comments of a Python file, which is what a student's own file name promises."""
    return "".join(f"# {line}".rstrip() + "\n" for line in text.splitlines())


def as_page(title: str, row: Row, told: Seen) -> str:
    """Return the feedback as a page."""
    parts = [f"<p>{escape(line)}</p>" for line in _before(row, told)]
    parts.append("<ul>")
    for check in told.checks:
        lines = "".join(f"<dt>{escape(name)}</dt><dd>{escape(text)}</dd>" for name, text in _lines(check))
        head = f"<strong>{_word(check)}</strong> {escape(shown(check['title']))} ({_points(check)})"
        parts.append(f"<li>{head}{f'<dl>{lines}</dl>' if lines else ''}</li>")
    parts.append("</ul>")
    if told.summary:
        parts.append(f"<p>{escape(told.summary)}</p>")
    return PAGE.format(title=escape(title), body="\n".join(parts))


def _before(row: Row, told: Seen) -> Iterator[str]:
    """Yield the grade, what was changed and noted, and the diagnosis."""
    grade = "no grade" if row.score is None else f"{points(row.score)} of {points(row.max_score)} points"
    yield f"Your grade: {grade}."
    if row.changes:
        yield f"Changed: {row.changes}."
    if row.notes:
        yield row.notes
    if told.diagnosis:
        yield shown(told.diagnosis, 2_000)


def _lines(check: dict[str, Any]) -> Iterator[tuple[str, str]]:
    """Yield what there is to say on a failed check."""
    if check["status"] == "passed":
        return
    for name in ("expected", "measured"):
        if check[name]:
            yield name, shown(str(check[name]))
    if check["at_s"] is not None:
        yield "when", f"{check['at_s']:.2f} s of simulated time"
    if check.get("hint"):
        yield "hint", shown(check["hint"])


def _word(check: dict[str, Any]) -> str:
    return "passed" if check["status"] == "passed" else "failed"


def _points(check: dict[str, Any]) -> str:
    return f"{points(check['points'])} of {points(check['max_points'])}"
