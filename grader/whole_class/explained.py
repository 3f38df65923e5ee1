"""What a search by trial found for each of a class (`grader/explain`), and the groups that one change would help.

Each student's folder keeps its own in `explanation.json`, so that a run that was ended goes on where it stopped. It is
gone with the folder when the submission is graded again.
"""

from __future__ import annotations

import hashlib
import json
from collections import Counter
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from gz_course.grader.errors import InfrastructureError, UsageError
from gz_course.grader.exercise import Exercise
from gz_course.grader.exercise.bundle import bundle, digest
from gz_course.grader.explain import BUDGET
from gz_course.grader.explain.explanation import Explanation, explain_files
from gz_course.grader.explain.sentence import group
from gz_course.grader.explain.trials import Trials
from gz_course.grader.process.whole_file import write_whole
from gz_course.grader.submission.intake import Selection
from gz_course.grader.submission.untouched import untouched
from gz_course.grader.whole_class.attempts import is_earlier
from gz_course.grader.whole_class.found import Found
from gz_course.grader.whole_class.grading import gradings_end_here
from gz_course.grader.whole_class.versions import versions

EXPLANATION = "explanation.json"
NO_CHANGE = "no single change that was tried"

Result = dict[str, Any]


@dataclass(frozen=True)
class Explained:
    """What a student's folder keeps of a search: its sentences, and the group of the change that helps."""

    sentences: tuple[str, ...]
    group: str


def explain_class(
    exercise: Exercise,
    out: Path,
    results: Iterable[Result],
    found: Iterable[Found],
    trials: str,
    sandbox: str,
    told: Callable[[str, str], None],
) -> None:
    """Search for each of a class without full marks, one after the other; each search uses all cores.

    `trials` and `sandbox` are those of the gradings; `told(student, sentence)` is called after each. Ctrl-C ends it,
    and what was found is kept. Raises InfrastructureError if an explanation cannot be written.
    """
    same = digest(bundle(exercise, trials)[0]) + repr((versions(), BUDGET, trials))
    submissions = {each.student: each for each in found}
    with gradings_end_here():
        for result in results:
            score = result.get("machine_score", result["score"])
            if score is None or score >= exercise.max_score or result["outcome"] == "tamper" or not result["sha256"]:
                continue
            if is_earlier(result):
                continue
            key = hashlib.sha256(f"{same} {result['sha256']}".encode()).hexdigest()
            file = out / result["folder"] / EXPLANATION
            if _read(file).get("key") == key:
                continue
            try:
                chosen = submissions[result["student"]].read()
                if untouched(exercise, chosen.main, chosen.files):
                    continue
                explanation = _explain(exercise, chosen, sandbox, trials)
            except (UsageError, InfrastructureError) as error:
                told(result["student"], str(error))
                continue
            if explanation.interrupted:
                raise KeyboardInterrupt
            content = {"key": key, "sentences": explanation.sentences, "group": _group(explanation)}
            try:
                write_whole(file, (json.dumps(content, indent=2) + "\n").encode())
            except OSError as error:
                raise InfrastructureError(
                    f"{file} cannot be written: {error.strerror}; the same command goes on"
                ) from None
            told(result["student"], explanation.sentences[0])


def _explain(exercise: Exercise, chosen: Selection, sandbox: str, trials: str) -> Explanation:
    made = Trials(exercise, chosen.main, BUDGET, sandbox, None, trials)
    return explain_files(exercise, chosen.files, chosen.main, made, lambda text, spent: None)


def _group(explanation: Explanation) -> str:
    found = explanation.found
    return group(found, explanation.files) if found is not None and found.changes else NO_CHANGE


def read_explanations(out: Path, results: Iterable[Result]) -> dict[str, Explained]:
    """Return what was found for each student, by name; those without a search are left out."""
    kept = {each["student"]: _read(out / each["folder"] / EXPLANATION) for each in results}
    return {name: Explained(tuple(each["sentences"]), each["group"]) for name, each in kept.items() if each}


def groups(explanations: Iterable[Explained]) -> Sequence[tuple[str, int]]:
    """Return the groups and how many are in each, the largest first."""
    counts = Counter(each.group for each in explanations)
    return sorted(counts.items(), key=lambda each: (each[0] == NO_CHANGE, -each[1], each[0]))


def _read(file: Path) -> dict[str, Any]:
    """Return what a file keeps; nothing if there is none, or it is no explanation."""
    try:
        content = json.loads(file.read_bytes())
        if all(isinstance(each, str) for each in (content["key"], content["group"], *content["sentences"])):
            return dict(content)
    except (OSError, ValueError, KeyError, TypeError):
        pass
    return {}
