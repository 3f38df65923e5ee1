"""`course new NN_name`: create both halves of a new exercise that already passes `course verify`.

For instructors.
"""

from __future__ import annotations

from typing import Annotated

import typer

from gz_course.grader.exercise import course_root
from gz_course.grader.exercise.scaffold.exercise import scaffold


def command(
    name: Annotated[str, typer.Argument(help="Two digits and words, such as 20_wall_follower.")],
) -> None:
    """Create an exercise: write both halves of a working one, to be edited."""
    root = course_root()
    for path in scaffold(name, root):
        print(path.relative_to(root))
    print(
        f"\nin {root}. It works as it is: `course verify {name}`. Begin with exercises/{name}/README.md and "
        f"grading/exercise.toml."
    )
