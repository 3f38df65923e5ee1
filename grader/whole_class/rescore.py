"""Scores the recordings of a class again, after a check was changed; no submission is run.

A result that is scored again counts as one of the exercise as it is now, so that `course grade-all` has nothing to do.
What cannot be scored again is told and left as it is: recordings that were not kept, or of other conditions (world,
duration, script, trials).
"""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path
from typing import Any

from gz_course.grader.errors import UsageError
from gz_course.grader.exercise import Exercise
from gz_course.grader.exercise.bundle import bundle
from gz_course.grader.exercise.conditions import conditions_sha256
from gz_course.grader.exercise.trial import chosen_trials
from gz_course.grader.grade import grade_again
from gz_course.grader.printable import shown
from gz_course.grader.process.whole_file import write_whole
from gz_course.grader.record.reading import Recording
from gz_course.grader.report.format import formats
from gz_course.grader.whole_class.attempts import earlier_attempts, is_earlier
from gz_course.grader.whole_class.gradebook import read_gradebook
from gz_course.grader.whole_class.grading import OF_REPORT, REPORT
from gz_course.grader.whole_class.identity import key_of, made_alike
from gz_course.grader.whole_class.journal import JOURNAL, Journal
from gz_course.grader.whole_class.kept import RECORDING
from gz_course.grader.whole_class.overview import write_overview
from gz_course.sim.did_you_mean import did_you_mean

Result = dict[str, Any]


@dataclass
class Rescored:
    """What became of a class: whose points changed and how, in words, and who was left, and why."""

    same: int = 0
    changed: dict[str, str] = field(default_factory=dict)
    left: dict[str, str] = field(default_factory=dict)


def rescore(
    exercise: Exercise,
    out: Path,
    student: str | None = None,
    check: str | None = None,
    told: Callable[[str], None] = lambda student: None,
) -> Rescored:
    """Score the class in the folder `out` again, or one student, and write gradebook, reports and page.

    With `check`, results in which any other check changes are left as they are. `told` hears each student's name.
    Raises UsageError if there is no such class, student or check; then nothing is written.
    """
    if not (out / JOURNAL).is_file():
        raise UsageError(f"{out} has no {JOURNAL}: give the folder that course grade-all wrote (--out)")
    ids = [each.id for each in exercise.checks]
    if check is not None and check not in ids:
        raise UsageError(
            f"{exercise.name} has no check {shown(check, 60)!r}{did_you_mean(check, ids, listing='known')}"
        )
    order = [row.student for row in read_gradebook(out)]
    with Journal(out) as journal:
        current = {result["student"]: result for result in journal.all() if not is_earlier(result)}
        results = [current[name] for name in order if name in current]
        names = [result["student"] for result in results]
        if student is not None and student not in names:
            raise UsageError(
                f"{out} has no student {shown(student, 60)!r}{did_you_mean(student, names, listing='known')}"
            )
        done = Rescored()
        files = cache(lambda trials: bundle(exercise, trials)[0])  # read once for all
        for place, result in enumerate(results):
            if student in (None, result["student"]) and result["outcome"] != "infra":
                told(result["student"])
                results[place] = _rescored(exercise, out, result, check, journal, files, done)
        for name, attempts in earlier_attempts(journal).items():
            for result in attempts if student in (None, name) else ():
                _rescored(exercise, out, result, check, journal, files, done)
        reports = [
            name for name, each in formats().items() if any((out / r["folder"] / each.file).is_file() for r in results)
        ]
        write_overview(out, exercise, results, reports, earlier_attempts(journal))
    return done


def _rescored(
    exercise: Exercise,
    out: Path,
    result: Result,
    check: str | None,
    journal: Journal,
    files: Callable[[str], dict[str, bytes]],
    done: Rescored,
) -> Result:
    """Return the result as it is now, and note in `done` what became of it."""
    folder = out / result["folder"]
    name = f"{result['student']} (an earlier attempt)" if is_earlier(result) else result["student"]
    recordings = sorted(folder.glob(f"*{RECORDING}"))
    if not recordings:
        if result["outcome"] not in ("student_error", "protocol"):  # nothing of these was run
            done.left[name] = "its recordings were not kept"
            return result
        none = result | {"points": {each.id: 0 for each in exercise.checks}}
        journal.add(_key(exercise, result, files), none)
        done.same += 1
        return none
    if why := _other_conditions(exercise, recordings, result):
        done.left[name] = why
        return result
    report = grade_again(recordings, exercise.folder.parents[1])
    made = report.as_dict()
    points = {each["id"]: each["points"] for each in made["checks"]}
    changes = {
        id: f"{id} {result['points'].get(id, 0):g} -> {value:g}"
        for id, value in points.items()
        if value != result["points"].get(id)
    }
    if check is not None and (others := changes.keys() - {check}):
        done.left[name] = f"other checks change, too: {', '.join(sorted(others))}"
        return result
    made["notes"] = list(dict.fromkeys([*result.get("notes", ()), *made["notes"]]))
    new = result | {each: made[each] for each in OF_REPORT} | {"points": points}
    new["leaderboard"] = made.get("leaderboard", [])
    _write_reports(folder, report, made)
    journal.add(_key(exercise, result, files), new)
    if changes or new["score"] != result["score"]:
        done.changed[name] = f"{result['score']:g} -> {new['score']:g} ({', '.join(changes.values())})"
    else:
        done.same += 1
    return new


def _other_conditions(exercise: Exercise, recordings: list[Path], result: Result) -> str:
    """Return why recordings are not of the exercise as it is now; empty if they are."""
    choice = result.get("made_with", {}).get("trials", "all")
    trials = {trial.name: trial for trial in chosen_trials(exercise, choice)}
    seen = set()
    for path in recordings:
        recording = Recording(path)
        run = recording.properties("run")
        name = run.get("trial", "public")
        seen.add(name)
        if recording.facts().get("fault"):  # it was not run
            continue
        if run.get("exercise") != exercise.name:
            return f"{path.name} is of {shown(str(run.get('exercise')), 60)}"
        if name not in trials:
            return f"the trial {name} is none of the exercise's any more"
        now = conditions_sha256(trials[name].applied_to(exercise), trials[name])
        if run.get("conditions_sha256", now) != now:
            return f"the trial {name} has changed (world, duration, script or parameters): it must be run again"
    if "made_with" in result and (missing := trials.keys() - seen):
        return f"the trial {min(missing)} is new: it must be run"
    return ""


def _key(exercise: Exercise, result: Result, files: Callable[[str], dict[str, bytes]]) -> str:
    """Return the key of a result of the exercise as it is now; `files` are its files with a choice of trials."""
    if "made_with" not in result:  # of an older journal
        return f"scored again: {result['folder']} {result['sha256']}"
    made = result["made_with"]
    return key_of(result["made_of"], made_alike(exercise.name, files(made["trials"]), made["options"], made["reports"]))


def _write_reports(folder: Path, report: Any, made: Result) -> None:
    """Write the reports that a student's folder has; facts of the machine stay those of the run."""
    old = json.loads((folder / REPORT).read_bytes())
    kept = {name: old[name] for name, value in made.items() if value is None and name in old}
    made |= kept | {"submission": old["submission"], "recording": old["recording"], "trials": _trials(old, made)}
    for each in formats().values():
        if each.file != REPORT and (folder / each.file).is_file():
            text = each.as_text(report)
            write_whole(folder / each.file, text if isinstance(text, bytes) else text.encode(errors="replace"))
    write_whole(folder / REPORT, (json.dumps(made, indent=2) + "\n").encode())


def _trials(old: Result, made: Result) -> list[Result]:
    """Return the trials of a report, with the names of recordings that they had."""
    names = {each["name"]: each["recording"] for each in old["trials"]}
    return [each | {"recording": names.get(each["name"], each["recording"])} for each in made["trials"]]
