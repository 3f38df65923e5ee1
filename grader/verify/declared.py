"""What the private half of an exercise declares: its variants, what they must lose, which mutants are equivalent.

The private half is the exercise's twin in `solutions/`: the solved file, `accepted/STYLE/`, `rejected/FAULT/`,
`trials.toml` (hidden parameters, see `grader/exercise/trial.py`) and `expect.toml`:

    [rejected.never_stops]
    fails = ["five_seconds", "stops"]        # exactly these checks
    words = ["Twist of zeros"]               # must occur in its first line of feedback
    trial = "from_the_north"                 # optional: full marks in public, fails in this hidden trial only

    [rejected.misspells_import]
    fails = ["five_seconds", "stops", "..."]
    words = ["ModuleNotFoundError"]
    nothing_runs = "it ends with an error"   # optional: why it may cost more than 40 % of the points

    [mutants]
    equivalent = ["24: 0.1 -> 0.2"]          # a survivor of `course verify` that is a correct solution

Every folder must be declared, and every declaration must have its folder. Where a submission has several files, the
folder of a variant holds only those that differ from the solution's.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from gz_course.grader.errors import ManifestError
from gz_course.grader.exercise import Exercise
from gz_course.grader.exercise.bundle import write
from gz_course.grader.exercise.toml_table import Table
from gz_course.grader.exercise.trial import chosen_trials
from gz_course.sim.did_you_mean import did_you_mean

FEWEST_ACCEPTED = 2
FEWEST_REJECTED = 6
EXPECT = "expect.toml"


@dataclass(frozen=True)
class Variant:
    """A submission, the checks it must fail (the starter: all), and words required in its first line of feedback.

    `folder` holds its files, or those that differ from the solution's. `trial` names the hidden trial in which alone it
    fails. `nothing_runs` says why it may lose more than a misconception costs (`grader/score/consequences.py`).
    """

    name: str
    folder: Path
    fails: frozenset[str]
    words: tuple[str, ...] = ()
    trial: str | None = None
    nothing_runs: str = ""


def variants(exercise: Exercise) -> list[Variant]:
    """Return the variants in `expect.toml` and the folders. Raises ManifestError if they do not agree."""
    folder = exercise.twin
    path, expect = _expectations(exercise)
    expected = expect.table("rejected")
    every = frozenset(check.id for check in exercise.checks)
    found = [
        Variant("starter", exercise.folder, every),
        Variant("solution", folder, frozenset()),
    ]
    found += [Variant(f"accepted/{p.name}", p, frozenset()) for p in _folders(folder / "accepted")]
    rejected = {p.name: p for p in _folders(folder / "rejected")}
    declared = expected.names()
    for name in declared:
        if name not in rejected:
            raise ManifestError(f"{path}: no folder rejected/{name}{did_you_mean(name, rejected, listing='known')}")
    for name, variant in rejected.items():
        if name not in declared:
            raise ManifestError(f"{variant} is not declared in {EXPECT}{did_you_mean(name, declared, listing='known')}")
        entry = expected.table(name)
        entry.where = f"{path}: rejected.{name}"
        loses, words = frozenset(entry.texts("fails")), tuple(entry.texts("words"))
        trial = _hidden_trial(exercise, entry) if entry.has("trial") else None
        nothing_runs = entry.text("nothing_runs", "")
        entry.end()
        for check in sorted(loses - every):
            hint = did_you_mean(check, every, listing="known")
            raise ManifestError(f"{entry.where} names no check of {exercise.name}: {check}{hint}")
        found.append(Variant(f"rejected/{name}", variant, loses, words, trial, nothing_runs))
    for each in found:
        if not any((each.folder / name).is_file() for name in exercise.parts):
            names = [p.name for p in each.folder.iterdir()] if each.folder.is_dir() else []
            hint = did_you_mean(exercise.file, names, listing="known")
            raise ManifestError(f"{each.folder} has no {exercise.file}{hint}")
    return found


def completed(exercise: Exercise, own: dict[str, bytes], folder: Path) -> Path:
    """Write the files `own` and the rest of the solution's to a folder; return the file that is started."""
    rest = {name: (exercise.twin / name).read_bytes() for name in exercise.parts if name not in own}
    write(rest | own, folder)
    return folder / exercise.file


def equivalent_mutants(exercise: Exercise) -> tuple[str, ...]:
    """Return the mutants that the author declares to be correct solutions, such as `24: 0.1 -> 0.2`."""
    _, expect = _expectations(exercise)
    return tuple(expect.table("mutants").texts("equivalent")) if expect.has("mutants") else ()


def _expectations(exercise: Exercise) -> tuple[Path, Table]:
    """Read `expect.toml`. Raises ManifestError for anything it must not contain."""
    path = exercise.twin / EXPECT
    if not path.is_file():
        raise ManifestError(f"{exercise.twin} has no {EXPECT}, which says what each rejected variant must lose")
    expect = Table.load(path)
    expect.table("rejected")
    if expect.has("mutants"):
        mutants = expect.table("mutants")
        mutants.texts("equivalent")
        mutants.end()
    expect.end()
    return path, expect


def _hidden_trial(exercise: Exercise, entry: Table) -> str:
    hidden = [trial.name for trial in chosen_trials(exercise, "all") if trial not in exercise.trials]
    return entry.choice("trial", hidden)


def orphans(root: Path, names: list[str]) -> list[Path]:
    """Return the folders of `solutions/` without an exercise of the same name."""
    return [path for path in _folders(root / "solutions") if path.name not in names]


def _folders(path: Path) -> list[Path]:
    return sorted(p for p in path.iterdir() if p.is_dir()) if path.is_dir() else []
