"""`course hint EXERCISE`: the next hint on what the last grading found."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Annotated, Any

import typer

from gz_course.grader.errors import UsageError
from gz_course.grader.exercise import find_exercise
from gz_course.grader.exercise.exercise import CheckSpec
from gz_course.grader.process.whole_file import write_whole
from gz_course.grader.report.best import runs_folder
from gz_course.sim.did_you_mean import did_you_mean

SHOWN = "hints_shown.json"  # check -> how many of its hints have been shown
IN_REPORT = 1


def command(
    exercise: Annotated[str, typer.Argument(help="Exercise, such as 03_teleop or 03.")],
    check: Annotated[
        str | None, typer.Option(help="Id of a failed check. Default: the one that the report begins with.")
    ] = None,
) -> None:
    """Show the next hint on the first failed check of the last grading: where to look, which idea, another case."""
    from gz_course.grader.grade import grade_again

    chosen = find_exercise(exercise)
    folder = runs_folder() / chosen.name
    recordings = sorted(folder.glob("*.rrd"))
    if not recordings:
        raise UsageError(f"nothing is graded yet; run `course grade {chosen.name}`, which shows the first hint")
    report = grade_again(recordings)
    failed = {each.spec.id: each.spec for each in report.score.checks if not each.finding.passed}
    if not failed:
        print("Full marks: there is nothing to hint at.")
        return
    if report.untouched or not report.measured:
        print(report.score.diagnosis)
        return
    if check is not None and check not in failed:
        raise UsageError(f"no failed check is called {check!r}{did_you_mean(check, failed, listing='failed')}")
    spec = failed[check] if check is not None else _first(report.first_failed)
    _show(spec, chosen.hints_shown, folder / SHOWN)


def _first(result: Any) -> CheckSpec:
    spec: CheckSpec = result.spec
    return spec


def _show(spec: CheckSpec, most: int, file: Path) -> None:
    """Print the next hint of a check, and keep that it was shown."""
    shown = _read(file)
    before = shown.get(spec.id, IN_REPORT)
    hints = spec.hints[:most]
    number = min(before + 1, len(hints))
    print(f"{spec.title}, hint {number} of {len(hints)}: {hints[number - 1]}")
    if before >= len(hints):
        print("There is no further hint: look at the run on the page, or ask somebody, and show them this one.")
        return
    shown[spec.id] = number
    try:
        write_whole(file, (json.dumps(shown, indent=1) + "\n").encode())
    except OSError as error:
        raise UsageError(f"cannot write {file}: {error.strerror}") from None


def _read(file: Path) -> dict[str, int]:
    """Return how many hints of each check were shown; what cannot be read counts as none."""
    try:
        found = json.loads(file.read_bytes())
    except (OSError, ValueError):
        return {}
    if not isinstance(found, dict):
        return {}
    return {name: count for name, count in found.items() if type(count) is int and count >= IN_REPORT}
