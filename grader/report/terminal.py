"""The report a person reads in a terminal: the diagnosis first, then a line for each check, hints where it failed."""

from __future__ import annotations

from rich.console import Console
from rich.markup import escape
from rich.table import Table

from grader.printable import shown
from grader.report.report import Report

NO_LIMIT = 1 << 20
MARKS = {True: "[green]pass[/green]", False: "[red]FAIL[/red]"}


def print_report(report: Report, console: Console) -> None:
    """Print one report. Readable without colour: every state is also a word."""
    score = report.score
    console.print(f"\n[bold]{_plain(report.exercise)}[/bold]  {_plain(report.title)}")
    console.print(f"submission: {_plain(report.submission)}", soft_wrap=True)
    if score.diagnosis:
        console.print(f"\n[bold]{_plain(score.diagnosis)}[/bold]")
    table = Table(show_edge=False, pad_edge=False, box=None, padding=(0, 2, 0, 0))
    for heading in ("", "check", "points", "measured"):
        table.add_column(heading, overflow="fold")
    for check in score.checks:
        points = f"{check.points:g}/{check.spec.points:g}"
        passed = check.finding.passed
        table.add_row(MARKS[passed], _plain(check.spec.title), points, _plain(check.finding.measured))
    console.print()
    console.print(table)
    for check in score.checks:
        if not check.finding.passed and report.sim_seconds:
            console.print(f"\n[bold]{_plain(check.spec.title)}[/bold]")
            console.print(f"  expected: {_plain(check.finding.expected)}")
            console.print(f"  measured: {_plain(check.finding.measured)}")
            console.print(f"  hint:     {_plain(check.spec.hint)}")
    console.print(f"\n[bold]score: {score.points:g} of {report.max_score:g}[/bold]  ({score.outcome})")
    if (host := report.host) and report.sim_seconds:
        factor = f", {report.sim_seconds / host.run_wall_seconds:.1f} x real time" if host.run_wall_seconds else ""
        console.print(f"{report.sim_seconds:g} s simulated in {host.run_wall_seconds:.2f} s ({host.pace}{factor})")
    console.print(f"recording: {_plain(str(report.recording))}", soft_wrap=True)


def _plain(text: str) -> str:
    """Foreign text: neither markup nor control codes."""
    return escape(shown(text, NO_LIMIT))
