"""The folder of a clone in which its student works: chapters and exercises, without solutions and grader.

`make chapters` lays it out and opens it, `make update` brings newer files to it. It has no README: that of the clone
says how to work. What a student has written into the clone's own exercises is taken along when the folder is made.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from gz_course.grader.course_folder.layout import RECORD, Changes, bring, handed_out, write_new
from gz_course.grader.course_folder.material import material
from gz_course.grader.errors import UsageError
from gz_course.grader.exercise import exercise_names, find_exercise
from gz_course.grader.exercise.bundle import write
from gz_course.grader.exercise.pristine import STARTERS, pristine
from gz_course.sim.terminal_text import printable


def refresh(folder: Path) -> Changes:
    """Lay out the folder if it is new, else bring what is newer; return the changes to a folder that was there.

    Raises UsageError if it was not made here, or cannot be written.
    """
    files, begun = handed_out(), dict[str, bytes]()
    del files["README.md"]
    for place, starter in _starters().items():
        if files[place] != starter:
            begun[place] = files[place]
        files |= {place: starter, place.replace("exercises", STARTERS, 1): starter}
    if (folder / RECORD).is_file():
        return bring(folder, files)
    if folder.is_dir() and any(folder.iterdir()):
        raise UsageError(f"{folder} was not made by `make chapters`; give it another name first")
    try:
        write_new(folder, files)
        write(begun, folder)
    except OSError as error:
        raise UsageError(f"{folder} cannot be written: {error.strerror}") from None
    return Changes()


def _starters() -> dict[str, bytes]:
    """Return the starters as git has them, by their path; those that it does not know are left out."""
    root = material()
    found: dict[str, bytes] = {}
    for name in exercise_names(root):
        try:
            starter = pristine(find_exercise(name, root))
        except UsageError:
            continue
        found |= {f"exercises/{name}/{part}": content for part, content in starter.items()}
    return found


def main() -> int:
    """Refresh the folder that is named; print what has changed."""
    parser = argparse.ArgumentParser(description=main.__doc__)
    parser.add_argument("folder", type=Path)
    folder = parser.parse_args().folder
    if folder.resolve() == material().resolve():
        return 0  # an author works on the course itself
    try:
        changes = refresh(folder)
    except UsageError as error:
        print(printable(str(error)), file=sys.stderr)
        return 2
    for line in changes.lines:
        print(line)
    return 0


if __name__ == "__main__":
    sys.exit(main())
