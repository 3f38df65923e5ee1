"""The zip from which Gradescope builds an autograder: the course's programs, one exercise, its hidden trials.

The programs are those of the checkout; where the course is installed from a wheel, they are that wheel. `setup.sh`
installs the course when the autograder is built, `run_autograder` grades one submission and always writes
`results.json`. Both expect their files below `/autograder`, or below AUTOGRADER_ROOT. The zip holds no solutions. Used
by `course package`.

Source: Gradescope, "Autograder Specifications", https://gradescope-autograders.readthedocs.io/en/latest/specs/
"""

from __future__ import annotations

import shlex
from pathlib import Path

from gz_course.grader.exercise import Exercise
from gz_course.grader.exercise.bundle import bundle
from gz_course.grader.package.installed_wheel import installed_versions, installed_wheel
from gz_course.grader.package.question import all_trials, filled, seconds_for, write_zip
from gz_course.grader.run.sandbox import OFFICIAL, level_module
from gz_course.grader.submission.intake import is_junk

HERE = Path(__file__).parent
CHECKOUT = Path(__file__).parents[2]
CODE = ("sim", "grader", "public")
FILES = ("pyproject.toml", "constraints.txt", "LICENSE")
TRACES = (".pyc", ".rrd", ".part", ".orig", ".bak", "~")
PROGRAMS = ("setup.sh", "run_autograder")


def package(exercise: Exercise, target: Path, trials: str | None = None, demand: str = OFFICIAL) -> list[str]:
    """Write the zip; return the names in it. `trials` is as for `course grade`; None: all, including hidden ones.

    Raises UsageError if the zip cannot be written, if there are no such trials, or if the course is neither
    a checkout nor installed from a wheel.
    """
    level_module(demand)
    trials = all_trials(exercise) if trials is None else trials
    seconds = seconds_for(exercise, trials)
    files, choice = bundle(exercise, trials)
    options = ["--trials", choice, "--demand", demand]
    values = {
        "DEADLINE": f"{seconds:.0f}",
        "DEMAND": demand,
        "EXERCISE": shlex.quote(exercise.name),
        "OPTIONS": shlex.join(options),
    }
    contents = {f"course/{name}": data for name, data in (_programs() | files).items()}
    contents["course/README.md"] = f"Autograder of {exercise.name}: {exercise.title}\n".encode()
    for name in PROGRAMS:
        contents[name] = filled(HERE / name, values)
    write_zip(target, contents)
    return sorted(contents)


def _programs() -> dict[str, bytes]:
    if not all((CHECKOUT / name).exists() for name in (*CODE, *FILES)):
        name, wheel = installed_wheel()
        return {name: wheel, "constraints.txt": installed_versions()}
    found = {name: (CHECKOUT / name).read_bytes() for name in FILES}
    for top in CODE:
        for path in sorted((CHECKOUT / top).rglob("*")):
            inside = path.relative_to(CHECKOUT)
            if path.is_file() and not any(map(is_junk, inside.parts)) and not path.name.endswith(TRACES):
                found[inside.as_posix()] = path.read_bytes()
    return found
