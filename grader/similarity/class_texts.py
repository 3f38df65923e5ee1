"""What is compared: the files of each submission, and the code that all students were given."""

from __future__ import annotations

from collections.abc import Iterable

from gz_course.grader.errors import UsageError
from gz_course.grader.exercise import Exercise
from gz_course.grader.similarity.report import Submitted
from gz_course.grader.similarity.tokens import LEXERS, Text, read_text
from gz_course.grader.submission.intake import LARGEST, folder_tree, without_grading
from gz_course.grader.whole_class.found import Found


def submitted_texts(found: Iterable[Found]) -> tuple[list[Submitted], list[str]]:
    """Return the texts of all submissions that can be read, and the students of the others."""
    texts: list[Submitted] = []
    unread: list[str] = []
    seen: dict[tuple[tuple[str, bytes], ...], Text] = {}
    for each in found:
        try:
            chosen = each.read()
        except Exception:  # whatever is wrong with it is told by `course grade-all`
            unread.append(each.student)
            continue
        key = tuple(sorted(chosen.files.items()))
        if key not in seen:
            seen[key] = read_text(chosen.files, chosen.main)
        texts.append(Submitted(each.student, chosen.files, seen[key]))
    return texts, unread


def given_code(exercise: Exercise) -> list[Text]:
    """Return the starter and everything else in the exercise's public half that has a lexer."""
    try:
        tree = without_grading(folder_tree(exercise.folder))
        files = {name: member.read(LARGEST) for name, member in tree.items() if name.endswith(tuple(LEXERS))}
    except UsageError:
        return []
    return [read_text({name: data}, exercise.file) for name, data in files.items()]
