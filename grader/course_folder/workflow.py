"""The workflow file that grades a repository on GitHub Actions, with pip alone.

Source: GitHub, "Workflow syntax for GitHub Actions",
https://docs.github.com/en/actions/reference/workflows-and-actions/workflow-syntax.
"""

from __future__ import annotations

from importlib.metadata import version
from pathlib import Path

from gz_course.grader.course_folder.layout import DISTRIBUTION, RECORD
from gz_course.grader.errors import UsageError
from gz_course.grader.exercise import Exercise, exercise_names, find_exercise
from gz_course.grader.exercise.pristine import pristine

PLACE = Path(".github/workflows/course.yml")
MARK = "# Written by `course ci`"
TEMPLATE = Path(__file__).with_name("workflow.yml.template")


def begun(root: Path) -> list[str]:
    """Return the names of the exercises whose files are no longer the starter's."""
    return [name for name in exercise_names(root) if _is_begun(find_exercise(name, root))]


def _is_begun(exercise: Exercise) -> bool:
    there = {name: path.read_bytes() for name in exercise.parts if (path := exercise.folder / name).is_file()}
    if not there:
        return False
    starter = pristine(exercise)
    return any(content != starter[name] for name, content in there.items())


def install_command(root: Path, wheel: str | None) -> str:
    """Return how the machine of GitHub gets the course: from a wheel in the repository, the copy there, or by version.

    Raises UsageError if `wheel` is no file of the repository.
    """
    if wheel is not None:
        path = Path(wheel)
        inside = (root / path).resolve()
        if not inside.is_file() or not inside.is_relative_to(root.resolve()) or path.suffix != ".whl":
            raise UsageError(f"{wheel} is no wheel in {root}; copy the file there and name it, such as wheels/NAME.whl")
        return f"pip install './{inside.relative_to(root.resolve()).as_posix()}'"
    if (root / RECORD).is_file():
        return f"pip install '{DISTRIBUTION}=={version(DISTRIBUTION)}'"
    if (root / "pyproject.toml").is_file() and (root / "constraints.txt").is_file():
        return "pip install --constraint constraints.txt --editable ."
    raise UsageError(f"{root} holds no course; run `course ci` in a folder of `course init`, or in a clone")


def workflow(exercises: list[str], install: str) -> str:
    """Return the text of the workflow: a job for each exercise, red unless it earns full marks."""
    text = TEMPLATE.read_text(encoding="utf-8").replace("@EXERCISES@", ", ".join(exercises))
    return text.replace("@INSTALL@", install)


def write_workflow(root: Path, exercises: list[str], wheel: str | None) -> Path:
    """Write the workflow of a repository; return its path.

    Raises UsageError if no exercise is begun, or if another workflow has that name.
    """
    if not exercises:
        raise UsageError("no exercise is begun yet; name one, such as `course ci 03_teleop`")
    path = root / PLACE
    text = workflow(exercises, install_command(root, wheel))
    try:
        if path.exists() and not path.read_text(encoding="utf-8").startswith(MARK):
            raise UsageError(f"{path} was not written by `course ci`; rename it first")
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        raise UsageError(f"{path} cannot be written: {getattr(error, 'strerror', None) or error}") from None
    return path
