"""What a student sees of a report: without checks and trials that are not for students (`exercise/visibility.py`).

A report of several trials tells of the first in which a check failed, and may so give away a hidden one. Here its
sentences are those of the trials that are shown. Points stay what they are.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any

from gz_course.grader.errors import CourseError
from gz_course.grader.exercise import Exercise
from gz_course.grader.exercise.trial import chosen_trials
from gz_course.grader.exercise.visibility import AFTER, ALWAYS, NEVER

if TYPE_CHECKING:
    from gz_course.grader.report.report import Report, TrialReport
    from gz_course.grader.score.consequences import CheckResult

SUMMARY, NONE, ALL = "summary", "none", "all"
HIDDEN = (SUMMARY, NONE, ALL)  # what is said about trials that are not shown

Data = dict[str, Any]


@dataclass(frozen=True)
class Rules:
    """The visibility of checks by id, and of trials by name; a trial that is not listed is never shown.

    `hidden` is what is said about trials that are not shown; with `all`, every trial and check is. `due` is whether the
    deadline has passed.
    """

    checks: Mapping[str, str] = field(default_factory=dict)
    trials: Mapping[str, str] = field(default_factory=dict)
    hidden: str = SUMMARY
    due: bool = False

    def shows(self, visibility: str) -> bool:
        return self.hidden == ALL or visibility == ALWAYS or (visibility == AFTER and self.due)

    def shows_trial(self, name: str) -> bool:
        return self.shows(self.trials.get(name, NEVER))

    def shows_check(self, id: str) -> bool:
        return self.shows(self.checks.get(id, ALWAYS))


def rules_of(exercise: Exercise, hidden: str = SUMMARY, due: bool = False) -> Rules:
    """Return the rules that manifest and `trials.toml` give."""
    try:
        trials = chosen_trials(exercise, "all")
    except CourseError:  # no readable `trials.toml`: what it names is not shown
        trials = exercise.trials
    checks = {check.id: check.visibility for check in exercise.checks}
    return Rules(checks, {trial.name: trial.visibility for trial in trials}, hidden, due)


@dataclass(frozen=True)
class Seen:
    """A report for its student: `checks` and `trials` as in the JSON report. `whole`: nothing was left out."""

    diagnosis: str
    checks: tuple[Data, ...]
    trials: tuple[str, ...]
    summary: str
    whole: bool

    def lines(self, report: Report, check: CheckResult) -> list[tuple[str, str]]:
        """Return (name, text) pairs on a check, as `Report.told` does, of what is seen."""
        told = next((each for each in self.checks if each["id"] == check.spec.id), None)
        if self.whole or told is None:
            return report.told(check)
        finding = replace(check.finding, expected=told["expected"], measured=told["measured"], at_s=told["at_s"])
        return [(name, text) for name, text in report.told(replace(check, finding=finding)) if text]

    def trial(self, report: Report) -> TrialReport | None:
        """Return the trial to show: the first that is shown and lost points, else the first; None if none is shown."""
        shown = [trial for trial in report.trials if trial.name in self.trials]
        return next((each for each in shown if each.score.points < report.max_score), shown[0] if shown else None)


def seen(report: Data, rules: Rules) -> Seen:
    """Return what the student sees of a JSON report."""
    shown = [trial for trial in report["trials"] if rules.shows_trial(trial["name"])]
    checks = [check for check in report["checks"] if rules.shows_check(check["id"])]
    names = tuple(trial["name"] for trial in shown)
    if len(shown) == len(report["trials"]) and len(checks) == len(report["checks"]):
        return Seen(report["diagnosis"], tuple(checks), names, "", True)
    if not report.get("sim_seconds"):  # nothing was run: it is the same in every trial
        return Seen(report["diagnosis"], tuple(checks), names, "", False)
    unseen = [trial for trial in report["trials"] if trial not in shown]
    lost = sum(trial["score"] < report["max_score"] for trial in unseen)
    summary = f"{lost} of {len(unseen)} runs that are not shown lost points." if unseen else ""
    return Seen(
        _diagnosis(report, shown, rules),
        tuple(_told(check, shown, rules) for check in checks),
        names,
        summary if rules.hidden == SUMMARY else "",
        False,
    )


def seen_of(report: Report) -> Seen:
    """Return what the student sees of a report before the deadline, with the checks that are not shown."""
    data, trials = report.as_dict(), {trial.name: trial.visibility for trial in report.trials}
    checks = {check.spec.id: check.spec.visibility for check in report.score.checks}
    return replace(seen(data, Rules({}, trials)), diagnosis=seen(data, Rules(checks, trials)).diagnosis)


def _diagnosis(report: Data, shown: Sequence[Data], rules: Rules) -> str:
    """Return the sentences of the first trial that lost points, unless they may be about a check that is not shown."""
    for trial in shown:
        failed = [check["id"] for check in trial.get("checks", ()) if check["status"] == "failed"]
        if trial.get("diagnosis") and all(map(rules.shows_check, failed)):
            where = f"In the trial {trial['name']}: " if len(report["trials"]) > 1 else ""
            return where + str(trial["diagnosis"])
    return ""


def _told(check: Data, shown: Sequence[Data], rules: Rules) -> Data:
    """Return a check with what the trials that are shown found."""
    found = [(trial["name"], each) for trial in shown for each in trial.get("checks", ()) if each["id"] == check["id"]]
    failed = [(name, each) for name, each in found if each["status"] == "failed"]
    if check["status"] == "failed" and failed:
        name, first = failed[0]
        where = f"in the trial {name}: " if len(failed) < len(found) or len(found) < len(shown) else ""
        return check | {"measured": where + first["measured"], "expected": first["expected"], "at_s": first["at_s"]}
    expected = found[0][1]["expected"] if found else ""
    if check["status"] == "failed":
        told = "it failed in a run that is not shown" if rules.hidden == SUMMARY else ""
        return check | {"measured": told, "expected": expected, "at_s": None}
    first = found[0][1] if found else {"measured": "", "at_s": None}
    return check | {"measured": first["measured"], "expected": expected, "at_s": first["at_s"]}
