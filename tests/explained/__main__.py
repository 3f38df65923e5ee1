"""Searches for each rejected variant what would help it (`course explain`), and compares with what is known of it.

    python -m gz_course.tests.explained [--budget SECONDS] [EXERCISE ...]

A variant differs from the nearest right program (solution or accepted variant) in known lines. The table says, by
exercise: mended by one change, by two, helped, or not; how many of the changes lie at a line that differs, or next to
one; how many reports name a line that does not; and the processor seconds. Each search is noted in a file below
`build/explained/`; a second call with the same code goes on where the first one ended.
"""

import argparse
import difflib
import hashlib
import json
from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from gz_course.grader.exercise import Exercise, exercise_names, find_exercise
from gz_course.grader.exercise.bundle import bundle, digest
from gz_course.grader.explain import BUDGET
from gz_course.grader.explain.explanation import explain_files
from gz_course.grader.explain.order import named_lines
from gz_course.grader.explain.trials import Files, Trials
from gz_course.grader.submission.intake import read_submission
from gz_course.grader.verify import variants
from gz_course.grader.whole_class.grading import gradings_end_here
from gz_course.grader.whole_class.versions import versions

ROOT = Path(__file__).parents[2]
NOTED = ROOT / "build/explained"
NEXT_TO = 2  # lines


def different(exercise: Exercise, files: Files) -> dict[str, set[int]]:
    """Return the lines of each file that differ from the nearest right program."""
    right = [each.folder for each in variants(exercise) if each.name == "solution" or each.name.startswith("accepted/")]
    return {
        name: min((_lines(content, _file(exercise, folder, name)) for folder in right), key=len)
        for name, content in files.items()
        if name in exercise.parts
    }


def _file(exercise: Exercise, folder: Path, name: str) -> bytes:
    path = folder / name
    return path.read_bytes() if path.is_file() else (exercise.twin / name).read_bytes()


def _lines(content: bytes, right: bytes) -> set[int]:
    """Return the lines of `content` that are not in `right`; where lines are missing, the one before and after."""
    own, other = content.splitlines(), right.splitlines()
    found = set[int]()
    for kind, begin, end, _, _ in difflib.SequenceMatcher(None, own, other, autojunk=False).get_opcodes():
        if kind != "equal":
            found.update(range(begin + 1, end + 1) if end > begin else (begin, begin + 1))
    return found


def near(places: list[tuple[str, int]], known: dict[str, set[int]]) -> bool:
    """Tell whether one of the places lies at a line that is known to differ, or next to one."""
    return any(abs(line - each) <= NEXT_TO for file, line in places for each in known.get(file, ()))


def searched(exercise: Exercise, folder: Path, budget: float) -> dict[str, Any]:
    """Return what a search came to, as plain data; noted before, or made now."""
    files = {name: _file(exercise, folder, name) for name in exercise.parts}
    if not (folder / exercise.file).is_file() or len(list(folder.rglob("*"))) > len(exercise.parts):
        files |= read_submission(exercise, folder)[2]
    same = repr((exercise.name, digest(bundle(exercise)[0]), digest(files), versions(), budget))
    note = NOTED / f"{hashlib.sha256(same.encode()).hexdigest()}.json"
    if note.is_file():
        return dict(json.loads(note.read_text()))
    with gradings_end_here():
        trials = Trials(exercise, exercise.file, budget, "auto", None)
        made = explain_files(exercise, files, exercise.file, trials, lambda text, spent: None)
    if made.interrupted:
        raise KeyboardInterrupt
    found = made.found
    assert found is not None
    known = different(exercise, files)
    named = sorted(named_lines(found.before.said, files))
    places = [(file or exercise.file, line) for file, line in named]
    result = {
        "mended": len(found.changes[0].edits) if found.full_marks and found.changes else 0,
        "helped": bool(found.changes),
        "right_place": bool(found.changes) and near(found.changes[0].lines, known),
        "accused": bool(places) and not near(places, known),
        "seconds": round(made.spent, 1),
        "trials": found.trials,
        "said": made.sentences[0],
        "report": found.before.said,
        "passes": not found.before.failed,
    }
    NOTED.mkdir(parents=True, exist_ok=True)
    note.write_text(json.dumps(result))
    return result


def rows(exercise: Exercise, budget: float) -> Iterator[tuple[str, dict[str, Any]]]:
    """Yield each rejected variant that fails in the public trials, and what the search came to."""
    for each in variants(exercise):
        if each.name.startswith("rejected/") and each.trial is None:
            yield each.name.removeprefix("rejected/"), searched(exercise, each.folder, budget)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("exercises", nargs="*", default=exercise_names(ROOT))
    parser.add_argument("--budget", type=float, default=BUDGET)
    arguments = parser.parse_args()
    table = []
    for name in arguments.exercises:
        exercise = find_exercise(name, ROOT)
        count: Counter[str] = Counter()
        for variant, row in rows(exercise, arguments.budget):
            print(f"{exercise.name} {variant} ({row['trials']} trials, {row['seconds']} s): {row['said']}", flush=True)
            if row["accused"]:
                print(f"    names another line: {row['report']}", flush=True)
            count["variants"] += 1
            count["one"] += row["mended"] == 1
            count["two"] += row["mended"] == 2
            count["helped"] += row["helped"] and not row["mended"]
            count["not"] += not row["helped"]
            count["right place"] += row["right_place"]
            count["accused"] += row["accused"]
            count["seconds"] += round(row["seconds"])
        table.append((exercise.name, count))
    columns = ("variants", "one", "two", "helped", "not", "right place", "accused", "seconds")
    print(f"\n{'':20}" + "".join(f"{each:>13}" for each in columns))
    total = sum((count for _, count in table), Counter())
    for name, count in [*table, ("all", total)]:
        print(f"{name:20}" + "".join(f"{count[each]:>13}" for each in columns))


if __name__ == "__main__":
    main()
