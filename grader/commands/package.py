"""`course package EXERCISE --out FILE.zip`: an autograder for Gradescope, or a question for PrairieLearn.

For instructors.
"""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from gz_course.grader.errors import UsageError
from gz_course.grader.exercise import find_exercise
from gz_course.grader.package import gradescope, prairielearn
from gz_course.grader.printable import shown
from gz_course.grader.run.sandbox import OFFICIAL
from gz_course.sim.did_you_mean import did_you_mean

PLATFORMS = {
    "gradescope": "Upload it as the autograder of a programming assignment.",
    "prairielearn": "Unpack it in the folder questions/ of your course.",
}


def command(
    exercise: Annotated[str, typer.Argument(help="Exercise, such as 03_teleop or 03.")],
    out: Annotated[Path, typer.Option(help="The zip to write.")],
    trials: Annotated[
        str | None, typer.Option(help="As for course grade: public, hidden, all, or a file. Default: all there are.")
    ] = None,
    demand: Annotated[
        str, typer.Option(help="The least sandbox level. C where the platform cannot do B (docs/instructors.md).")
    ] = OFFICIAL,
    platform: Annotated[str, typer.Option(help="gradescope or prairielearn.")] = "gradescope",
    image: Annotated[
        str | None, typer.Option(help=f"The image of PrairieLearn's grader. Default: {prairielearn.IMAGE}.")
    ] = None,
) -> None:
    """Package an exercise, hidden trials included: an autograder for Gradescope or a question for PrairieLearn."""
    if platform not in PLATFORMS:
        nearest = did_you_mean(platform, PLATFORMS, listing="there are")
        raise UsageError(f"there is no package for {shown(platform, 60)!r}{nearest}")
    if image is not None and platform != "prairielearn":
        raise UsageError("--image is for --platform prairielearn; Gradescope builds its own image")
    chosen = find_exercise(exercise)
    if platform == "gradescope":
        names = gradescope.package(chosen, out, trials, demand)
    else:
        names = prairielearn.package(chosen, out, trials, demand, image or prairielearn.IMAGE)
    size = out.stat().st_size
    print(f"{out}: {len(names)} files, {size / 1e6:.1f} MB. {PLATFORMS[platform]}")
