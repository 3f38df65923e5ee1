"""The gradebook of a class as CSV: one line per student, points for each check, the first sentence of feedback.

Made from the journal's results alone, without times and paths of this machine: the same submissions give the same
bytes. Names and sentences are foreign text: a cell that a spreadsheet would take for a formula begins with an
apostrophe. It begins with a byte order mark, by which Excel reads it as UTF-8.

Source: RFC 4180, "Common Format and MIME Type for Comma-Separated Values (CSV) Files".
"""

from __future__ import annotations

import csv
import io
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from gz_course.grader.errors import UsageError
from gz_course.grader.exercise import Exercise
from gz_course.grader.printable import shown
from gz_course.grader.process.whole_file import write_whole

GRADEBOOK = "gradebook.csv"
FORMULA = ("=", "+", "-", "@", "\t", "\r", "\n", "\N{FULLWIDTH EQUALS SIGN}", "\N{FULLWIDTH PLUS SIGN}",
           "\N{FULLWIDTH HYPHEN-MINUS}", "\N{FULLWIDTH COMMERCIAL AT}")  # fmt: skip
LONGEST_CELL = 2_000  # [characters]


@dataclass(frozen=True)
class Row:
    """A line of a gradebook, as it is read back. `score` is None for who could not be graded."""

    student: str
    id: str
    submission: str
    score: float | None
    max_score: float
    outcome: str
    diagnosis: str
    platform: str = ""  # that has named the submission
    folder: str = ""  # with the reports
    changes: str = ""
    notes: str = ""


def as_csv(exercise: Exercise, results: Iterable[dict[str, Any]]) -> str:
    """Return the gradebook. A result without a score (`infra`) has empty cells for points."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    ids = [check.id for check in exercise.checks]
    head = ["student", "id", "submission", "score", "max_score", "outcome", *ids]
    last = ["diagnosis", "submission_sha256", "truth_sha256", "folder", "platform", "machine_score", "changes", "notes"]
    writer.writerow([cell(name) for name in [*head, *last]])
    for result in results:
        points = result["points"]
        row = [result["student"], result["id"], result["submission"], result["score"], exercise.max_score]
        row += [result["outcome"], *(points.get(id) for id in ids), result["diagnosis"]]
        row += [result["sha256"], result["truth_sha256"], result["folder"], result.get("platform", "")]
        row += [result.get("machine_score", result["score"]), "; ".join(result.get("changes", ()))]
        row += [" ".join(result.get("notes", ()))]
        writer.writerow([cell(each) for each in row])
    return text.getvalue()


def cell(value: object) -> str:
    """Return a value as a cell that no spreadsheet takes for a formula: numbers unchanged, None empty, text guarded.

    Source: OWASP, "CSV Injection".
    """
    if value is None:
        return ""
    if isinstance(value, int | float) and not isinstance(value, bool):
        return f"{value:.10g}"
    text = shown(str(value), LONGEST_CELL)
    return f"'{text}" if str(value).startswith(FORMULA) or text.lstrip().startswith(FORMULA) else text


def read_gradebook(folder: Path) -> list[Row]:
    """Read the gradebook of a class. Raises UsageError if there is none, or it is not as it was written."""
    path = folder / GRADEBOOK
    try:
        with path.open(encoding="utf-8-sig", newline="") as stream:
            lines = csv.DictReader(stream)
            return [_row({name: _unguarded(value) for name, value in line.items()}) for line in lines]
    except OSError as error:
        raise UsageError(
            f"{path} cannot be read: {error.strerror}; give the folder that course grade-all wrote (--out)"
        ) from None
    except (csv.Error, ValueError, KeyError, TypeError, AttributeError) as error:
        raise UsageError(
            f"{path} is not as course grade-all wrote it ({shown(str(error), 80)}); the same command writes it again"
        ) from None


def _row(line: dict[str, str]) -> Row:
    score = float(line["score"]) if line["score"] else None
    most, outcome, told = float(line["max_score"]), line["outcome"], line["diagnosis"]
    more = (line.get(name) or "" for name in ("platform", "folder", "changes", "notes"))
    return Row(line["student"], line["id"], line["submission"], score, most, outcome, told, *more)


def _unguarded(text: str) -> str:
    """Return the text of a cell without the apostrophe that `cell` put before it."""
    return text[1:] if text.startswith("'") and text[1:].lstrip().startswith(FORMULA) else text


def write_gradebook(folder: Path, text: str) -> Path:
    """Write the gradebook atomically: a reader sees the old one or the new one, never a part."""
    path = folder / GRADEBOOK
    write_whole(path, text.encode("utf-8-sig"), sole_writer=True)
    return path
