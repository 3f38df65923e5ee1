"""An exercise as its folder describes it: files, world, bridge, observed topics, script, checks, points, hints.

`exercises/NN_name/grading/exercise.toml` is the only place that defines them; the title and the task are those of the
`README.md` that the student reads. A folder with a manifest is an exercise and gives it its name. A student's folder
has no `grading/`: the installed course's counts (`grading.py`).
"""

from __future__ import annotations

import hashlib
import os
import re
from dataclasses import dataclass, field
from pathlib import Path, PurePosixPath
from typing import Any

from gz_course.grader.course_folder.material import material
from gz_course.grader.errors import ManifestError, UsageError
from gz_course.grader.exercise.grading import GRADING, MANIFEST, README, grading_files, grading_folder
from gz_course.grader.exercise.leaderboard import Ranked, read_leaderboard
from gz_course.grader.exercise.toml_table import Table
from gz_course.grader.exercise.trial import (
    PUBLIC,
    Entry,
    Trial,
    read_script,
    read_trials,
    refuse_unknown_checks,
)
from gz_course.grader.exercise.visibility import ALWAYS, read_visibility
from gz_course.grader.kinds.kind import find_kind, kind_names
from gz_course.sim.did_you_mean import did_you_mean

MOST_HINTS = 3  # where to look, which idea, the idea in another case
TASK = re.compile(r"# (?P<title>[^\n]*\S)\n+(?P<summary>(?!## )\S.*?)\s*(?:^## .*)?", re.DOTALL | re.MULTILINE)


@dataclass(frozen=True)
class CheckSpec:
    """One line of the rubric: a kind of check with its parameters, worth `points`."""

    id: str
    title: str
    points: float
    kind: str
    hints: tuple[str, ...]  # from where to look, over the idea, to the idea in another case
    parameters: dict[str, Any] = field(default_factory=dict)
    consequence_of: tuple[str, ...] = ()  # checks whose misconception may be why this one fails
    visibility: str = ALWAYS  # to students: `visibility.py`

    @property
    def hint(self) -> str:
        """The first hint, which the report shows."""
        return self.hints[0]


@dataclass(frozen=True)
class Exercise:
    """One exercise as read from its manifest."""

    name: str
    folder: Path  # what the student sees
    grading: Path  # what grades it
    title: str
    summary: str
    kind: str  # of submission: a folder in `kinds/`
    file: str  # the file that is started
    world: str  # a file of the folder, or a world's name
    robot: str
    duration: float  # [s] simulated
    tick: float  # [s] simulated time between two /clock messages
    real_time_factor: float  # [s] simulated time in a second of the clocks of the computer
    bridge: Path | None  # bridges between simulator and ROS; None if the submission brings them
    observe: dict[str, str]  # ROS topics the student is to publish on -> type
    script: tuple[Entry, ...]
    checks: tuple[CheckSpec, ...]
    files: tuple[str, ...] = ()  # further files that students edit, by their path beside `file`
    bridge_parameters: dict[str, str] = field(default_factory=dict)  # ROS parameters of the bridge
    hints_shown: int = MOST_HINTS  # of each check, at most
    shows_change: bool = False  # `course explain` shows the change that helps, not only its place
    other_ways: tuple[str, ...] = ()  # to full marks, in words
    further: str = ""  # what to try after full marks
    draft: bool = False  # not released yet
    leaderboard: tuple[Ranked, ...] = ()  # numbers by which a class is ranked
    trials: tuple[Trial, ...] = (PUBLIC,)  # the public ones; a single one without parameters if the manifest lists none

    @property
    def twin(self) -> Path:
        """The folder with its private half, which a students' copy lacks."""
        return self.folder.parents[1] / "solutions" / self.name

    @property
    def manifest_sha256(self) -> str:
        """SHA-256 of the manifest and of the Python files beside it; a recording keeps the value of its run."""
        paths = [self.manifest, *grading_files(self.grading)]
        return hashlib.sha256(b"".join(path.read_bytes() for path in paths)).hexdigest()

    @property
    def manifest(self) -> Path:
        return self.grading / MANIFEST

    @property
    def max_score(self) -> float:
        return sum(check.points for check in self.checks)

    @property
    def parts(self) -> tuple[str, ...]:
        """The files a submission consists of, that which is started first."""
        return (self.file, *self.files)

    @property
    def starter(self) -> Path:
        """The file students begin with and edit; the others of `parts` lie beside it."""
        return self.folder / self.file


def course_root() -> Path:
    """Return the folder that holds `exercises/`: COURSE_ROOT, the nearest from here upwards, or that of this code."""
    if given := os.environ.get("COURSE_ROOT"):
        return Path(given)
    here = Path.cwd()
    for folder in (here, *here.parents):
        if exercise_names(folder):
            return folder
    return material()


def exercise_names(root: Path) -> list[str]:
    """Return the names of the exercises of a course's folder, sorted."""
    return sorted(path.name for path in (root / "exercises").glob("*/") if grading_folder(path) is not None)


def find_exercise(name: str, root: Path | None = None) -> Exercise:
    """Return an exercise by its name, its number, or an unambiguous beginning of its name such as `03_tel`.

    Raises UsageError naming the nearest if there is none, ManifestError if its manifest is wrong.
    """
    root = root or course_root()
    names = exercise_names(root)
    if not names:
        raise UsageError(f"there are no exercises in {root / 'exercises'}; COURSE_ROOT must name a course's folder")
    begin = f"{int(name):02d}_" if name.isascii() and name.isdigit() and len(name) < 3 else name
    matches = [n for n in names if n == name] or [n for n in names if name and n.startswith(begin)]
    if len(matches) != 1:
        if meant := [part for part in Path(name).parts if part in names]:
            raise UsageError(
                f"{name!r} is a path: first comes an exercise's name; what is to be graded, if not the file in its "
                f"folder, is given with --submission; did you mean '{meant[-1]}'?"
            )
        reason = "several exercises begin with" if len(matches) > 1 else "no exercise is called"
        hint = did_you_mean(name, matches or names, listing="known")
        raise UsageError(f"{reason} {name!r}; `course list` shows them all{hint}")
    return load_exercise(root / "exercises" / matches[0])


def load_exercise(folder: Path) -> Exercise:
    """Read and check the manifest of the exercise in a folder. Raises ManifestError with the file and what is wrong."""
    grading = grading_folder(folder) or folder / GRADING
    path = grading / MANIFEST
    manifest = Table.load(path)
    title, summary = read_task(grading.parent / README)
    run, full_marks = manifest.table("run"), manifest.table("full_marks", {})
    kind = manifest.choice("kind", kind_names()) if manifest.has("kind") else "node"
    exercise = Exercise(
        name=folder.name,
        folder=folder,
        grading=grading,
        title=title,
        summary=summary,
        kind=kind,
        file=manifest.text("file"),
        files=tuple(manifest.texts("files")) if manifest.has("files") else (),
        world=_world(folder, run.text("world")),
        robot=run.text("robot"),
        duration=run.number("duration", above=0),
        tick=run.number("tick", 0.01, above=0),
        real_time_factor=run.number("real_time_factor", 1.0, above=0),
        bridge=None if find_kind(kind).brings_bridge else folder / run.text("bridge"),
        observe=_texts(run.table("observe", {})),
        script=read_script(manifest.tables("script", [])),
        checks=tuple(_check(path, check) for check in manifest.tables("check")),
        bridge_parameters=_texts(run.table("bridge_parameters", {})),
        hints_shown=_hints_shown(manifest),
        shows_change=manifest.flag("shows_change", False),
        draft=manifest.flag("draft", False),
        leaderboard=read_leaderboard(manifest.tables("leaderboard", [])),
        other_ways=tuple(full_marks.texts("other_ways")) if full_marks.has("other_ways") else (),
        further=full_marks.text("further", ""),
        trials=read_trials(manifest.tables("trial", []), path, folder) or (PUBLIC,),
    )
    if Path(exercise.file).name != exercise.file:
        manifest.refuse("file", "the name of a file, without folders")
    if any(not is_below(name) for name in exercise.files) or len(set(exercise.parts)) < len(exercise.parts):
        manifest.refuse("files", "paths of further files below the exercise's folder, each once")
    for table in (run, full_marks, manifest):
        table.end()
    refuse_unknown_checks(exercise.trials, exercise.checks)
    ids = [check.id for check in exercise.checks]
    if twice := {i for i in ids if ids.count(i) > 1}:
        raise ManifestError(f"{path}: check id {sorted(twice)[0]!r} is used twice")
    for ranked in exercise.leaderboard:
        if ranked.check not in ids:
            hint = did_you_mean(ranked.check, ids, listing="known")
            raise ManifestError(f"{path}: leaderboard {ranked.name!r} names no check: {ranked.check!r}{hint}")
    for check in exercise.checks:
        for id in sorted(set(check.consequence_of) - (set(ids) - {check.id})):
            hint = did_you_mean(id, ids, listing="known")
            raise ManifestError(f"{path}: check {check.id!r}: consequence_of names no other check: {id!r}{hint}")
    return exercise


def read_task(path: Path) -> tuple[str, str]:
    """Return the title and the task of a `README.md`: its first heading, and what is between that and the next.

    Raises ManifestError if it cannot be read or lacks one of them.
    """
    try:
        text = path.read_text(encoding="utf-8")
    except OSError as error:
        raise ManifestError(f"{path} cannot be read: {error.strerror}") from None
    except UnicodeDecodeError as error:
        raise ManifestError(f"{path}: {error}") from None
    if not (found := TASK.fullmatch(text)):
        raise ManifestError(f"{path} must begin with `# TITLE`, and then say what the student has to do")
    return found["title"], found["summary"]


def is_below(name: str) -> bool:
    """Return whether a name is that of a file below the folder it is relative to, in its one spelling."""
    path = PurePosixPath(name)
    return bool(path.parts) and not path.is_absolute() and ".." not in path.parts and str(path) == name


def _world(folder: Path, name: str) -> str:
    """Return the file of the exercise's folder, if there is one of that name, else the name."""
    return str(folder / name) if (folder / name).is_file() else name


def _texts(table: Table) -> dict[str, str]:
    return {key: table.text(key) for key in table.names()}


def _hints_shown(manifest: Table) -> int:
    """Return how many hints of a check students may see."""
    number = manifest.integer("hints_shown", MOST_HINTS)
    if not 1 <= number <= MOST_HINTS:
        manifest.refuse("hints_shown", f"a number from 1 to {MOST_HINTS}")
    return number


def _hints(table: Table) -> tuple[str, ...]:
    """Return the hints of a check: `hints`, a list of one to three, or a single `hint`."""
    if not table.has("hints"):
        return (table.text("hint"),)
    hints = tuple(table.texts("hints"))
    if not 1 <= len(hints) <= MOST_HINTS:
        raise ManifestError(f"{table.where}: hints has {len(hints)} texts; give one to {MOST_HINTS}")
    return hints


def _check(path: Path, table: Table) -> CheckSpec:
    id = table.text("id")
    table.where = f"{path}: check {id!r}"
    return CheckSpec(
        id=id,
        title=table.text("title"),
        points=table.number("points", above=0),
        kind=table.text("kind"),
        hints=_hints(table),
        consequence_of=tuple(table.texts("consequence_of")) if table.has("consequence_of") else (),
        visibility=read_visibility(table),
        parameters=table.rest(),
    )
