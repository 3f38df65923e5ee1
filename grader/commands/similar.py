"""`course similar EXERCISE DIR_OR_ZIP --out DIR`: which submissions of a class are similar, as a hint for a person.

For instructors.
"""

from __future__ import annotations

from contextlib import ExitStack
from pathlib import Path
from typing import Annotated

import typer

from gz_course.grader.errors import UsageError
from gz_course.grader.exercise import find_exercise


def command(
    exercise: Annotated[str, typer.Argument(help="Exercise, such as 03_teleop or 03.")],
    submissions: Annotated[Path, typer.Argument(metavar="DIR_OR_ZIP", help="The class, as course grade-all reads it.")],
    out: Annotated[Path, typer.Option(help="Folder for similarity.csv and similarity.html.")],
    threshold: Annotated[
        float, typer.Option(min=0.1, max=1.0, help="Least share of a text that another has, too, to be listed.")
    ] = 0.6,
    map_file: Annotated[
        Path | None, typer.Option("--map", metavar="FILE", help="Whose a GitHub login is, as for course grade-all.")
    ] = None,
) -> None:
    """Compare the submissions of a class. Starter code is left out; nothing of a submission is run.

    Exit code 0, whatever is found; 2: usage. No score depends on it.
    """
    from gz_course.grader.learning_platforms.login_map import read_login_map
    from gz_course.grader.similarity.class_texts import given_code, submitted_texts
    from gz_course.grader.similarity.pairs import find_similar
    from gz_course.grader.similarity.report import PAGE, write_report
    from gz_course.grader.whole_class.found import find_submissions

    chosen = find_exercise(exercise)
    if not submissions.exists():
        raise UsageError(f"there is no {submissions}; give a folder or a zip with the submissions")
    people = read_login_map(map_file) if map_file is not None else None
    with ExitStack() as stack:
        found, _ = find_submissions(submissions, chosen, stack, people)
        texts, unread = submitted_texts(found)
    similar = find_similar([each.text for each in texts], given_code(chosen), threshold)
    write_report(out, f"{chosen.name}: {chosen.title}", texts, similar, threshold)
    for student in unread:
        typer.echo(f"not compared, because it cannot be read: {student}", err=True)
    equal = sum(len(members) for members in similar.groups)
    typer.echo(
        f"{len(texts)} submissions compared: {equal} are equal to another but for names, "
        f"{len(similar.pairs)} pairs share {threshold:.0%} or more"
    )
    typer.echo(f"a hint to look, no proof: {out / PAGE}")
