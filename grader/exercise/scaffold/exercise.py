"""The two halves of a new exercise: a working one, to be changed by its author.

`template/` holds the public half, the solution and two accepted variants. Each rejected variant is the solution with
one planted defect.
"""

from __future__ import annotations

import re
import shutil
from pathlib import Path

from gz_course.grader.errors import UsageError
from gz_course.grader.exercise import exercise_names
from gz_course.grader.exercise.grading import GRADING, MANIFEST

TEMPLATE = Path(__file__).with_name("template")
NAME = re.compile(r"[0-9]{2}_[a-z][a-z0-9]*(_[a-z0-9]+)*")
LONGEST_NAME = 60
PUBLIC = {"README.md": "README.md", f"{GRADING}/{MANIFEST}": MANIFEST, "bridge.yaml": "bridge.yaml"}  # -> template
ACCEPTED = ("own_style", "odometry")
# A student's mistake -> the words of the solution it replaces, and their replacement.
DEFECTS = {
    "never_stops": ("            self.publisher.publish(Twist())\n", "            self.timer.cancel()\n"),
    "drives_backwards": ("command.linear.x = 0.25", "command.linear.x = -0.25"),
    "too_slow": ("command.linear.x = 0.25", "command.linear.x = 0.1"),
    "drives_too_long": ("Duration(seconds=2.0)", "Duration(seconds=2.7)"),
    "wall_clock": ("now = self.get_clock().now()", "now = rclpy.clock.Clock().now()"),
    "wrong_topic": ('"/cmd_vel"', '"/model/robot/cmd_vel"'),
}


def check_name(name: str, root: Path) -> None:
    """Raise UsageError if no new exercise can have this name: malformed, or taken in either half."""
    if not NAME.fullmatch(name) or len(name) > LONGEST_NAME:
        raise UsageError(
            f"{name!r} is no name for an exercise: two digits, then lower-case words joined by _, such as "
            f"{_free_number(root):02}_wall_follower"
        )
    for half in ("exercises", "solutions"):
        if (root / half / name).exists():
            raise UsageError(f"there is already {half}/{name}; choose another name, or remove it first")
    if taken := [other for other in exercise_names(root) if other[:2] == name[:2]]:
        raise UsageError(f"number {name[:2]} is that of {taken[0]}; the next free one is {_free_number(root):02}")


def _free_number(root: Path) -> int:
    return 1 + max((int(name[:2]) for name in exercise_names(root) if name[:2].isdigit()), default=0)


def scaffold(name: str, root: Path) -> list[Path]:
    """Write both halves of the exercise `name` into the course at `root`; return the files, in order.

    Raises UsageError, and leaves nothing behind, if the name cannot be used or a file cannot be written.
    """
    if not root.is_dir():
        raise UsageError(f"there is no folder {root}; COURSE_ROOT must name a course's folder")
    check_name(name, root)
    halves = [root / "exercises" / name, root / "solutions" / name]
    files = contents(name)
    written = []
    try:
        for half, texts in zip(halves, files, strict=True):
            for inside, text in texts.items():
                path = half / inside
                path.parent.mkdir(parents=True, exist_ok=True)
                path.write_text(text, encoding="utf-8")
                written.append(path)
    except OSError as error:
        for half in halves:
            shutil.rmtree(half, ignore_errors=True)
        raise UsageError(f"cannot write {error.filename}: {error.strerror}") from None
    return written


def contents(name: str) -> tuple[dict[str, str], dict[str, str]]:
    """Return the files of the public and of the private half: path inside the half -> text."""
    words = name[3:].replace("_", " ")
    file = f"{name[3:]}_node.py"

    def filled(template: str) -> str:
        text = (TEMPLATE / f"{template}.template").read_text(encoding="utf-8")
        values = {"@NAME@": name, "@TITLE@": words.capitalize(), "@FILE@": file, "@NODE@": name[3:]}
        for mark, value in values.items():
            text = text.replace(mark, value)
        return text

    public = {inside: filled(template) for inside, template in PUBLIC.items()} | {file: filled("starter.py")}
    solution = filled("solution.py")
    private = {file: solution, "expect.toml": filled("expect.toml")}
    private |= {f"accepted/{style}/{file}": filled(f"{style}.py") for style in ACCEPTED}
    private |= {f"rejected/{fault}/{file}": planted(solution, *defect) for fault, defect in DEFECTS.items()}
    return public, private


def planted(solution: str, right: str, wrong: str) -> str:
    """Return the solution with one defect: `right`, which must occur once, replaced by `wrong`."""
    if solution.count(right) != 1:
        raise ValueError(f"{right!r} must stand in the template of the solution exactly once")
    return solution.replace(right, wrong)
