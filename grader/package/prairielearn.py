"""The zip with a question for PrairieLearn: its page, its settings, and what its external grader needs.

The grader is a container of the course's image, without network. PrairieLearn puts the folder `tests` of the question
and the student's files below `/grade` (or PRAIRIELEARN_ROOT); `tests/run.sh` grades them and always writes
`results.json`. A submission that could not be graded is not gradable there and costs no attempt. The zip holds no
solutions. Used by `course package`.

Source: PrairieLearn, "External Grading", https://docs.prairielearn.com/externalGrading/, and "pl-file-upload element".
"""

from __future__ import annotations

import html
import json
import shlex
import uuid
from pathlib import Path

from gz_course.grader.exercise import Exercise
from gz_course.grader.exercise.bundle import bundle
from gz_course.grader.package.question import all_trials, filled, seconds_for, write_zip
from gz_course.grader.run.sandbox import OFFICIAL, level_module

RUN = "tests/run.sh"
PROGRAM = Path(__file__).parent / "run_prairielearn"
IMAGE = "gz-ros2-course-root"  # the image of the repository's Dockerfile, as root: docs/learning_platforms.md
LONGEST = 600  # [s] that PrairieLearn gives a grading
SPARE = 20  # [s] for the end of a grading that takes too long, and for its results


def package(
    exercise: Exercise, target: Path, trials: str | None = None, demand: str = OFFICIAL, image: str = IMAGE
) -> list[str]:
    """Write the zip; return the names in it. `trials` is as for `course grade`; None: all, including hidden ones.

    Raises UsageError if the zip cannot be written or if there are no such trials.
    """
    level_module(demand)
    trials = all_trials(exercise) if trials is None else trials
    seconds = min(round(seconds_for(exercise, trials)) + SPARE, LONGEST)
    files, choice = bundle(exercise, trials)
    values = {
        "DEADLINE": str(seconds - SPARE),
        "EXERCISE": shlex.quote(exercise.name),
        "OPTIONS": shlex.join(["--trials", choice, "--demand", demand]),
    }
    contents = {f"tests/course/{name}": data for name, data in files.items()}
    contents |= {RUN: filled(PROGRAM, values), "info.json": _info(exercise, image, seconds)}
    contents["question.html"] = _page(exercise)
    contents |= {f"clientFilesQuestion/{_flat(name)}": (exercise.folder / name).read_bytes() for name in exercise.parts}
    contents = {f"{exercise.name}/{name}": data for name, data in contents.items()}
    write_zip(target, contents)
    return sorted(contents)


def _info(exercise: Exercise, image: str, seconds: int) -> bytes:
    """Return info.json. The same exercise has the same uuid, so that a new package replaces the question."""
    options = {
        "enabled": True,
        "image": image,
        "entrypoint": f"/grade/{RUN}",
        "timeout": seconds,
        "enableNetworking": False,
    }
    info = {
        "uuid": str(uuid.uuid5(uuid.NAMESPACE_URL, f"gz-ros2-course/{exercise.name}")),
        "title": exercise.title,
        "topic": "Gazebo and ROS 2",
        "type": "v3",
        "singleVariant": True,
        "gradingMethod": "External",
        "externalGradingOptions": options,
    }
    return (json.dumps(info, indent=2, ensure_ascii=False) + "\n").encode()


def _page(exercise: Exercise) -> bytes:
    """Return question.html. Uploads have no folders, so an exercise with folders asks for one zip of its files."""
    flat = not any("/" in name for name in exercise.parts)
    wanted = ", ".join(name.replace(",", "\\,") for name in exercise.parts) if flat else f"{exercise.name}.zip"
    given = "".join(
        f"  <li><pl-file-download file-name={_quoted(_flat(name))}></pl-file-download>{_place(name)}</li>\n"
        for name in exercise.parts
    )
    lines = "".join(f"  <p>{html.escape(part)}</p>\n" for part in exercise.summary.strip().split("\n\n"))
    how = "" if flat else f"  <p>Hand in {html.escape(wanted)}, a zip of these files in their folders.</p>\n"
    text = (
        f"<pl-question-panel>\n{lines}  <ul>\n{given}  </ul>\n{how}</pl-question-panel>\n"
        f"<pl-file-upload file-names={_quoted(wanted)}></pl-file-upload>\n"
        "<pl-submission-panel>\n  <pl-external-grader-results></pl-external-grader-results>\n"
        "  <pl-file-preview></pl-file-preview>\n</pl-submission-panel>\n"
    )
    return text.encode()


def _flat(name: str) -> str:
    return name.replace("/", "__")


def _place(name: str) -> str:
    """Return where a file belongs in the zip of the submission, if that is another name."""
    return "" if _flat(name) == name else f" ({html.escape(name)})"


def _quoted(text: str) -> str:
    return f'"{html.escape(text)}"'
