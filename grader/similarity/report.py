"""Similar submissions as `similarity.csv` and `similarity.html`: who, how similar, and on which lines."""

from __future__ import annotations

import csv
import io
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from jinja2 import Environment, FileSystemLoader, StrictUndefined
from markupsafe import Markup

from gz_course.grader.errors import UsageError
from gz_course.grader.printable import shown, storable
from gz_course.grader.process.whole_file import write_whole
from gz_course.grader.similarity.pairs import Pair, Similar
from gz_course.grader.similarity.tokens import Text
from gz_course.grader.whole_class.gradebook import cell

CSV, PAGE = "similarity.csv", "similarity.html"
FOLDER = Path(__file__).parent
STYLE = FOLDER.parent / "report" / "html" / "page.css"
MOST_PAIRS, WITH_TEXT = 1_000, 100  # pairs of a report; those whose lines are shown
MOST_LINES, LONGEST_LINE = 80, 160  # of a text that is shown


@dataclass(frozen=True)
class Submitted:
    """A submission that was compared: the student, the files, and their tokens."""

    student: str
    files: dict[str, bytes]
    text: Text


def write_report(out: Path, title: str, submitted: Sequence[Submitted], similar: Similar, threshold: float) -> None:
    """Write both files. Raises UsageError if they cannot be written."""
    try:
        out.mkdir(parents=True, exist_ok=True)
        for name, text in (
            (CSV, as_csv(submitted, similar)),
            (PAGE, as_page(title, submitted, similar, threshold)),
        ):
            write_whole(out / name, text.encode(), sole_writer=True)
    except OSError as error:
        raise UsageError(f"{out} cannot be written: {error.strerror}") from None


def as_csv(submitted: Sequence[Submitted], similar: Similar) -> str:
    """Return a line for each pair. Of submissions that are equal but for names each is paired with the first."""
    stream = io.StringIO()
    writer = csv.writer(stream, lineterminator="\n")
    writer.writerow(["similarity", "student_a", "student_b", "tokens", "lines_a", "lines_b"])
    for members in similar.groups:
        first = submitted[members[0]]
        for number in members[1:]:
            row = ["1", first.student, submitted[number].student, str(len(first.text.symbols)), "all", "all"]
            writer.writerow([cell(each) for each in row])
    for pair in similar.pairs[:MOST_PAIRS]:
        one, other = submitted[pair.one], submitted[pair.other]
        row = [f"{pair.similarity:.2f}", one.student, other.student, str(pair.tokens)]
        row += [_ranges(each.text, lines) for each, lines in zip((one, other), pair.lines, strict=True)]
        writer.writerow([cell(each) for each in row])
    return stream.getvalue()


def as_page(title: str, submitted: Sequence[Submitted], similar: Similar, threshold: float) -> str:
    """Return the report as a page without scripts; names and texts are foreign, and escaped."""
    environment = Environment(loader=FileSystemLoader(FOLDER), autoescape=True, undefined=StrictUndefined)
    left_out = [(each.student, shown("; ".join(each.text.left_out))) for each in submitted if each.text.left_out]
    return environment.get_template("similarity.html.jinja").render(
        title=title,
        count=len(submitted),
        threshold=f"{threshold:.0%}",
        style=Markup(STYLE.read_text(encoding="utf-8")),
        groups=[[submitted[each].student for each in members] for members in similar.groups],
        pairs=[
            _shown_pair(submitted, pair, number < WITH_TEXT) for number, pair in enumerate(similar.pairs[:MOST_PAIRS])
        ],
        more=max(0, len(similar.pairs) - MOST_PAIRS),
        short=[submitted[each].student for each in similar.too_short],
        left_out=left_out,
    )


def _shown_pair(submitted: Sequence[Submitted], pair: Pair, with_text: bool) -> dict[str, object]:
    sides = []
    for number, lines in zip((pair.one, pair.other), pair.lines, strict=True):
        each = submitted[number]
        text = _matching_text(each, lines) if with_text else []
        sides.append({"student": each.student, "lines": _ranges(each.text, lines), "text": text})
    return {"similarity": f"{pair.similarity:.0%}", "tokens": pair.tokens, "sides": sides}


def _matching_text(each: Submitted, lines: frozenset[tuple[int, int]]) -> list[str]:
    found: list[str] = []
    for file in sorted({file for file, _ in lines}):
        content = each.files[each.text.names[file]].decode("utf-8", "replace").split("\n")
        for line in sorted(number for where, number in lines if where == file)[: MOST_LINES - len(found)]:
            text = storable(content[line - 1].rstrip("\r")) if line <= len(content) else ""
            found.append(f"{line:4}  {text[:LONGEST_LINE]}")
    return found


def _ranges(text: Text, lines: frozenset[tuple[int, int]]) -> str:
    """Return lines as people write them: `7-12, 15`, with the file's name if there are several."""
    told = []
    for file in sorted({file for file, _ in lines}):
        found: list[list[int]] = []
        for line in sorted(number for where, number in lines if where == file):
            if found and line <= found[-1][1] + 1:
                found[-1][1] = line
            else:
                found.append([line, line])
        ranges = ", ".join(f"{a}-{b}" if b > a else f"{a}" for a, b in found)
        told.append(f"{shown(text.names[file], 60)}: {ranges}" if len(text.names) > 1 else ranges)
    return shown("; ".join(told), 300)
