"""The students' copy of the course: everything students work with, nothing that reveals a solution.

Only listed folders and files are copied, so neither `solutions/` nor `tests/` (which hold solved exercises), recordings
or caches can get into it. A starter that somebody has solved in place is refused. What grades the exercises is in the
hidden folder `.grading`, where the package `gz_course` finds it.
"""

from __future__ import annotations

import contextlib
import json
import shutil
import tempfile
from pathlib import Path

from gz_course.grader.course_folder.layout import RELEASED, Changes, record, update_from
from gz_course.grader.course_folder.material import PARTS, material_files, plain_files
from gz_course.grader.course_folder.readme import FROM_A_COPY, readme
from gz_course.grader.errors import ManifestError, UsageError
from gz_course.grader.exercise import Exercise, exercise_names, find_exercise
from gz_course.grader.exercise.grading import GRADING, README
from gz_course.grader.exercise.pristine import STARTERS
from gz_course.grader.release.choice import chosen

CHECKOUT = Path(__file__).parents[2]
CODE = ("sim", "grader", "public")
NAMESPACE = "public/gz_course"  # its links are for editors in a checkout; Python does without them
APART = ".grading"  # folder of what grades the exercises, as `public/gz_course/__init__.py` names it
FILES = (
    "pyproject.toml",
    "constraints.txt",
    "LICENSE",
    ".gitignore",
    "docs/windows_and_mac.md",
    "Dockerfile",
    ".dockerignore",
    *(f".devcontainer/{name}" for name in ("devcontainer.json", "create.sh", "attach.sh")),
    *(f".binder/{name}" for name in ("runtime.txt", "postBuild")),
)
# For authors only. The scaffold of an exercise holds its solution.
AUTHORS_ONLY = (
    "grader/exercise/scaffold",
    "grader/release",
    "grader/package",
    "grader/commands/new.py",
    "grader/commands/package.py",
    "grader/commands/release.py",
)


def release(root: Path, target: Path, only: str = "") -> tuple[list[str], Changes | None]:
    """Write the students' copy of the course at `root` to `target`; return the names of its exercises.

    Drafts are left out, and all but `only`. An earlier copy in `target` keeps its exercises and is brought up to date:
    then the second value says what has changed. An incomplete copy is removed. Raises UsageError if `target` cannot be
    used, ManifestError if a file would reveal a solution.
    """
    code = root if all((root / name).exists() for name in (*CODE, *FILES[:1])) else CHECKOUT
    missing = [name for name in (*CODE, *FILES) if not (code / name).exists()]
    if missing:
        raise UsageError(f"{code} lacks {missing[0]}; release from a checkout of the course, not from an installation")
    every = [find_exercise(name, root) for name in exercise_names(root)]
    names = chosen(only, every) if only else [exercise.name for exercise in every if not exercise.draft]
    before = exercise_names(target) if (target / RELEASED).is_file() else []
    exercises = [exercise for exercise in every if exercise.name in names or exercise.name in before]
    if not exercises:
        raise UsageError(f"there are no exercises in {root / 'exercises'}, so there is nothing to release")
    target = _usable(target, [*(root / name for name in PARTS), *(code / name for name in CODE)])
    copy = None
    try:
        target.parent.mkdir(parents=True, exist_ok=True)
        copy = Path(tempfile.mkdtemp(prefix=f".{target.name}-", dir=target.parent))
        copy.chmod(0o755)
        _fill(copy, root, code, exercises, [each.name for each in every if each not in exercises])
        files = {path.relative_to(copy).as_posix(): path for path in sorted(copy.rglob("*")) if path.is_file()}
        record(copy, {name: path.read_bytes() for name, path in files.items()}, RELEASED)
        if (target / RELEASED).is_file():
            return [exercise.name for exercise in exercises], update_from(target, copy)
        if target.exists():
            target.rmdir()  # remove the empty target folder
        copy.rename(target)
    except (OSError, shutil.Error) as error:
        told = getattr(error, "strerror", None) or str(error)
        raise UsageError(f"{target} cannot be written: {told}") from None
    finally:
        if copy is not None:
            shutil.rmtree(copy, ignore_errors=True)
    return [exercise.name for exercise in exercises], None


def _usable(target: Path, sources: list[Path]) -> Path:
    """Return the full path of the target.

    Raises UsageError unless it is new, empty or an earlier copy, outside of what is copied.
    """
    full = target.resolve()
    for source in sources:
        if full.is_relative_to(source.resolve()):
            raise UsageError(f"{target} lies inside {source}, which is to be copied; choose a folder elsewhere")
    try:
        if full.exists() and not full.is_dir():
            raise UsageError(f"{target} is a file; give a folder that is new or empty")
        if full.is_dir() and any(full.iterdir()) and not (full / RELEASED).is_file():
            raise UsageError(f"{target} is not empty; give a folder that is new or empty")
    except OSError as error:
        raise UsageError(f"{target} cannot be used: {error.strerror}") from None
    return full


def _fill(copy: Path, root: Path, code: Path, exercises: list[Exercise], without: list[str]) -> None:
    private = [lines for exercise in exercises for lines in _private(exercise)]
    together = {
        Path("exercises", e.name, name): [e.folder / part for part in e.parts] for e in exercises for name in e.parts
    }
    for inside, path in material_files(root):
        if inside.parts[1] in without:
            continue
        _refuse_a_solution(together.get(inside, [path]), inside, private)
        _copy(path, copy / inside)
    for name in CODE:
        for path in plain_files(code / name, without_links_of=code / NAMESPACE):
            inside = path.relative_to(code)
            if not any(inside.is_relative_to(each) for each in AUTHORS_ONLY):
                _copy(path, copy / inside)
    for name in FILES:
        _copy(code / name, copy / name)
    for exercise in exercises:
        for name in exercise.parts:
            _copy(exercise.folder / name, copy / STARTERS / exercise.name / name)
        home = copy / APART / "exercises" / exercise.name
        _copy(exercise.grading.parent / README, home / README)
        for path in plain_files(exercise.grading):
            _refuse_a_solution([path], path.relative_to(root), private)
            _copy(path, home / GRADING / path.relative_to(exercise.grading))
    notebooks = [path.relative_to(copy).as_posix() for path in sorted(copy.glob("chapters/*/*.ipynb"))]
    (copy / "README.md").write_text(readme(exercises, FROM_A_COPY, notebooks), encoding="utf-8")


def _copy(source: Path, target: Path) -> None:
    target.parent.mkdir(parents=True, exist_ok=True)
    shutil.copy(source, target)


def _private(exercise: Exercise) -> list[tuple[Path, frozenset[str]]]:
    """Return the solution and the accepted variants of an exercise, each with the lines of all its files."""
    folder = exercise.twin
    found = []
    for variant in (folder, *sorted(path for path in folder.glob("accepted/*") if path.is_dir())):
        paths = [next((at / n for at in (variant, folder) if (at / n).is_file()), None) for n in exercise.parts]
        lines = frozenset[str]().union(*(_lines(path) for path in paths if path is not None))
        if lines:
            found.append((variant / exercise.file, lines))
    return found


def _refuse_a_solution(paths: list[Path], inside: Path, private: list[tuple[Path, frozenset[str]]]) -> None:
    """Raise ManifestError if files that belong together hold all lines of a solution."""
    there = frozenset[str]().union(*map(_lines, paths))
    for solution, lines in private:
        if lines <= there:
            given = "/".join(solution.parts[-3:])
            raise ManifestError(f"{inside} holds all of the solution {given}; put the starter back before you release")


def _lines(path: Path) -> frozenset[str]:
    """Return the lines of a text or of a notebook's cells, without indentation, comments and empty lines."""
    text = path.read_text(encoding="utf-8", errors="replace")
    if path.suffix == ".ipynb":
        with contextlib.suppress(ValueError, TypeError, AttributeError, KeyError):  # not a notebook, but a text
            text = "\n".join("".join(cell["source"]) for cell in json.loads(text)["cells"])
    lines = (line.strip() for line in text.splitlines())
    return frozenset(line for line in lines if line and not line.startswith(("#", '"""')))
