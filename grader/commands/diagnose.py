"""`course diagnose`: find configuration errors in the live ROS and Gazebo graphs and explain them.

For a running system.
"""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING, Annotated

import typer
from rich.console import Console
from rich.markup import escape

from gz_course.grader.console import GuardedConsole
from gz_course.grader.printable import shown

if TYPE_CHECKING:
    from gz_course.grader.tools.diagnose.live import Diagnosis

LONGEST = 60.0  # [s]


def command(
    seconds: Annotated[
        float, typer.Option(min=0.1, max=LONGEST, help="How long to listen to topics, after both graphs are known.")
    ] = 2.0,
    json: Annotated[bool, typer.Option("--json", help="Print the findings as JSON.")] = False,
) -> None:
    """Find errors in the running system of this ROS domain and Gazebo partition; it only listens.

    Exit code 0: nothing wrong, 1: errors found, 2: a usage error, 3: ROS or Gazebo's transport cannot be used.
    """
    from gz_course.grader.tools.diagnose.live import diagnose

    diagnosis = diagnose(seconds)
    if json:
        sys.stdout.write(diagnosis.as_json())
    else:
        print_diagnosis(diagnosis, GuardedConsole())
    raise typer.Exit(1 if diagnosis.wrong else 0)


def print_diagnosis(diagnosis: Diagnosis, console: Console) -> None:
    """Print what was observed, then each finding: sentence, evidence, fix."""

    def line(text: str, before: str = "") -> None:
        console.print(before + escape(shown(text)), highlight=False, soft_wrap=True)

    colours = {"ERROR": "red", "WARNING": "yellow", "NOTE": "cyan"}
    ros, gz = diagnosis.system.ros, diagnosis.system.gz
    worlds = ", ".join(world.name for world in gz.worlds) or "none"
    bridges = ", ".join(f"{bridge.node} ({len(bridge.entries)})" for bridge in ros.bridges) or "none"
    line(
        f"ROS domain {ros.domain}: {_count(len(ros.nodes), 'node')}, bridges: {bridges}. "
        f"Gazebo partition {gz.partition!r}: worlds: {worlds}."
    )
    for finding in diagnosis.findings:
        word = finding.severity.name
        line(finding.sentence, f"\n[{colours[word]}]{word}[/]  ")
        for seen in finding.evidence:
            line(seen, "  seen: ")
        line(finding.fix, "  fix:  ")
    if not diagnosis.wrong:
        console.print("\nNothing is wrong." if not diagnosis.findings else "\nNothing is wrong; see the notes above.")


def _count(number: int, noun: str) -> str:
    return f"{number} {noun}{'' if number == 1 else 's'}"
