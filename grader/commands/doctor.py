"""`course doctor`: check whether everything the course needs works on this machine, and name the remedies."""

from __future__ import annotations

import time
from json import dumps
from typing import TYPE_CHECKING, Annotated

import typer
from rich.markup import escape

from gz_course.grader.console import GuardedConsole
from gz_course.grader.errors import UsageError

if TYPE_CHECKING:
    from gz_course.grader.tools.doctor.checkup import Finding

STARTED = time.monotonic()


def command(
    json: Annotated[bool, typer.Option("--json", help="Print the findings as JSON, for programs.")] = False,
    deadline: Annotated[float, typer.Option(help="Seconds for all of it, waiting for a processor not counted.")] = 8.0,
) -> None:
    """Test everything the course needs. Exit code 0: all works, 1: something does not, 2: usage."""
    from gz_course.grader.tools.doctor.checkup import examine

    if not 0 < deadline <= 3600:
        raise UsageError(f"--deadline must be a number of seconds above 0 and up to 3600, not {deadline:g}")
    findings = examine(deadline)
    works = not any(finding.verdict.status == "failed" for finding in findings)
    print_json(findings, works) if json else print_findings(findings)
    raise typer.Exit(0 if works else 1)


def print_json(findings: list[Finding], works: bool) -> None:
    """Print one JSON object: works, findings[] {check, title, status, seen, fix}, wall_seconds."""
    found = [finding.as_dict() for finding in findings]
    print(dumps({"works": works, "findings": found, "wall_seconds": round(time.monotonic() - STARTED, 2)}, indent=2))


def print_findings(findings: list[Finding]) -> None:
    """Print a line for each finding, with the remedy below if there is one, and a summary at the end."""
    console = GuardedConsole(highlight=False, soft_wrap=True)
    colours = {"ok": "green", "warning": "yellow", "failed": "red"}
    for finding in findings:
        verdict = finding.verdict
        mark = f"[{colours[verdict.status]}]{verdict.status:8}[/]"
        console.print(f"{mark} {escape(finding.title)}: {escape(verdict.seen)}")
        if verdict.fix:
            console.print(f"         -> {escape(verdict.fix)}")
    counts = {status: sum(f.verdict.status == status for f in findings) for status in colours}
    console.print(f"{counts['ok']} ok, {counts['warning']} warnings, {counts['failed']} failed")
