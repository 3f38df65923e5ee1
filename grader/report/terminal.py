"""The report in a terminal: the first sentence of the diagnosis, a hint, and a line for each check.

The page beside the recording has the rest; without one, and on request, it is all here.

Used by the commands that grade. The layout is the same for every width; every state is a word as well as a colour. A
student's text is printed without markup and control codes, and so that no build service takes a line for a command.
"""

from __future__ import annotations

import io
import re
import sys
from pathlib import Path
from typing import TextIO

from rich.console import Console, RenderableType
from rich.padding import Padding
from rich.table import Table
from rich.text import Text

from gz_course.grader.console import GuardedConsole
from gz_course.grader.printable import shown
from gz_course.grader.report.node_log import log_of
from gz_course.grader.report.report import Report, points
from gz_course.grader.score.consequences import CheckResult
from gz_course.sim.terminal_text import unguarded

NO_LIMIT = 1 << 20
MARKS = {True: ("pass", "green"), False: ("FAIL", "bold red")}
INDENT = 6  # columns before the further lines of a check: the width of its mark
NARROWEST = 24  # columns; narrower terminals are treated as this wide
LAST_LINES = 12  # of the log of a node that died

TRAILING = re.compile(r" +$", re.MULTILINE)

# GitHub Actions obeys lines that begin with "::", and "##[" anywhere in a line; Azure Pipelines obeys "##vso[". Source:
# GitHub, "Workflow commands for GitHub Actions"; Azure Pipelines, "Logging commands".
COMMANDS = re.compile(r"^([^\S\n]*(?:\x1b\[[0-9;]*m)*[^\S\n]*):(?=:)|#(?=#\[|#vso\[)", re.MULTILINE)


def print_report(
    report: Report,
    file: TextIO | None = None,
    width: int | None = None,
    *,
    page: Path | None = None,
    details: bool = False,
) -> None:
    """Print one report to the terminal, or to `file` with `width` columns, in colour where that is supported.

    `page` is the HTML report beside the recording, if there is one; without it, and with `details`, everything is
    printed.
    Raises UsageError if the recording of a node that died cannot be read.
    """
    target = file or unguarded(sys.stdout)
    printed = io.StringIO()
    told_to = GuardedConsole(file=target, width=width)
    console = GuardedConsole(
        file=printed,
        width=max(told_to.width, NARROWEST),
        force_terminal=told_to.is_terminal,
        color_system=told_to.color_system,
        no_color=told_to.no_color,
        highlight=False,
    )
    _print(report, console, page, brief=page is not None and not details)
    text = disarmed(TRAILING.sub("", printed.getvalue()))
    encoding = getattr(target, "encoding", None) or "utf-8"
    target.write(text.encode(encoding, "replace").decode(encoding))
    target.flush()


def disarmed(text: str) -> str:
    """Insert a space into every sequence that a build service would obey in a log."""
    return COMMANDS.sub(lambda match: f"{match[0]} ", text)


def _print(report: Report, console: Console, page: Path | None, *, brief: bool) -> None:
    score = report.score
    console.print(_text("\n", (report.exercise, "bold"), "  ", report.title))
    console.print(_text("submission: ", report.submission), soft_wrap=True)
    if score.diagnosis:
        console.print(_text("\n", (score.diagnosis, "bold")))
        if score.details and not brief:
            console.print(_text(score.details))
    if score.outcome in ("student_error", "memory"):
        _print_last_lines(report, console)
    if brief:
        _print_hint(report, console)
    console.print()
    for check in score.checks:
        _print_check(check, report, console, brief=brief)
    if len(report.trials) > 1:
        console.print(_text("\n", ("trials", "bold")))
        rows = Table.grid(padding=(0, 2, 0, 0))
        for trial in report.trials:
            earned = f"{points(trial.score.points)}/{points(report.max_score)}"
            rows.add_row(*map(_text, (trial.name, f"seed {trial.seed}", earned, trial.score.outcome)))
        console.print(Padding(rows, (0, 0, 0, 2)))
    if report.full_marks and report.after:
        console.print()
        for line in report.after:
            console.print(_text(line))
    verdict = f"score: {points(score.points)} of {points(report.max_score)}"
    console.print(_text("\n", (verdict, "bold"), f"  ({score.outcome})"))
    for note in report.notes:
        console.print(_text(("note:", "bold"), " ", note))
    if (host := report.host) and report.sim_seconds:
        factor = f", {report.sim_seconds / host.run_wall_seconds:.1f} x real time" if host.run_wall_seconds else ""
        console.print(
            _text(f"{report.sim_seconds:g} s simulated in {host.run_wall_seconds:.2f} s ({host.pace}{factor})")
        )
    for trial in report.trials:
        console.print(_text("recording: ", str(trial.recording)), soft_wrap=True)
    if page is not None:
        console.print(_text("page:      ", str(page)), soft_wrap=True)


def _print_hint(report: Report, console: Console) -> None:
    """Print the first hint of the check to begin with, unless another fault must be mended before."""
    first = report.first_failed
    if first is None or not report.measured or report.untouched:
        return
    console.print(_hanging(_text("hint:"), _text(first.spec.hint)))
    if len(first.spec.hints) > 1 and report.hints_shown > 1:
        console.print(_text(f"      course hint {report.exercise} shows the next one."))
    if not report.tried:
        console.print(_text(f"      course explain {report.exercise} tries which line decides."))


def _print_check(check: CheckResult, report: Report, console: Console, *, brief: bool) -> None:
    """Print one check. Without a measurement print no expectation: the diagnosis explains why."""
    finding = check.finding
    earned = f"{points(check.points)}/{points(check.spec.points)}"
    console.print(_hanging(_text(MARKS[finding.passed]), _text(check.spec.title, "  ", (earned, "bold"))))
    if brief or not report.measured:
        return
    if finding.passed:
        when = "" if finding.at_s is None else f", at {finding.at_s:.2f} s"
        line = _text((f"{finding.measured}{when}; expected: {finding.expected}", "dim"))
        console.print(Padding(line, (0, 0, 0, INDENT)))
        return
    for name, text in report.told(check):
        if name == "hint" and finding.gated:
            continue  # another check gives the reason, so this hint does not apply yet
        console.print(Padding(_hanging(_text(f"{name}:"), _text(text), 10), (0, 0, 0, INDENT)))


def _print_last_lines(report: Report, console: Console) -> None:
    said = log_of(report, 0, LAST_LINES)
    if said.last or said.first:
        console.print(_text("\n", f"What {said.who} said last:"))
    for _, _, text in said.first + said.last:
        console.print(Padding(_text(text), (0, 0, 0, 2)))


def _hanging(label: Text, text: Text, width: int = INDENT) -> RenderableType:
    """Return a text with its further lines aligned below its first, to the right of the label."""
    row = Table.grid()
    row.add_column(width=width, no_wrap=True)
    row.add_column(overflow="fold")
    row.add_row(label, text)
    return row


def _text(*parts: str | tuple[str, str]) -> Text:
    """Join texts, or (text, style) pairs, without interpreting markup and with control codes replaced."""
    line = Text(overflow="fold")
    for part in parts:
        text, style = part if isinstance(part, tuple) else (part, "")
        line.append(text if text == "\n" else shown(text, NO_LIMIT), style)
    return line
